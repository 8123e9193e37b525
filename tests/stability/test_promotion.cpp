// Worlds that gain and lose materials while they run: the same bits as one that could hold all from the start, and no more
// passes and memory than what they hold calls for.
#include "engine/settings/data/method_presets.hpp"
#include "tests/stability/quality.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

Edit disc(EditLayer layer, double x, double y, double radius, double amount) { return brush(layer, x, y, radius, amount, 0.7); }

// A valley with a side that water and sand leave through.
Scene dry_valley(bool open) {
    auto scene = mixed_scene(28, 24);
    scene.fields.sand.clear();
    scene.fields.water.clear();
    for (int n = 0; n < 28 * 24; ++n) scene.settings.roughness.push_back(0.002F * static_cast<float>(n % 28)); // waits for water
    if (open) scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
    return scene;
}

std::size_t passes(const World& world) {
    return world.plan().water_passes.size() +
           world.plan().substep_passes.size() * static_cast<std::size_t>(world.plan().substeps);
}

} // namespace

TEST_CASE("by the paper's method: sand beside a level side, and a saved world goes on to the same bits") {
    auto scene = dry_valley(false);
    scene.settings.roughness.clear();
    scene.fields.water.assign(28 * 24, 0.4F);
    choose_method(scene.settings, "published");
    scene.settings.sides[SIDE_EAST].kind = SideKind::level;
    scene.settings.sides[SIDE_EAST].value.samples = {{0, 2}};
    auto first = make_world(scene), second = make_world(scene);
    const auto sand = [&](World& world) {
        auto edit = disc(EditLayer::sand, 27 * scene.settings.grid.dx, 12 * scene.settings.grid.dx, 0.5, 0.6);
        edit.step = world.steps();
        edit_world(world, {edit});
    };
    test::step(*first, 3);
    sand(*first); // what faces there were lay where diffused heights lie now
    test::step(*first, 2);
    std::vector<std::byte> bytes(first->snapshots().bytes());
    REQUIRE(first->snapshots().save(bytes));
    REQUIRE(second->snapshots().load(bytes));
    for (World* world : {first.get(), second.get()}) {
        sand(*world);
        test::step(*world, 3);
    }
    CHECK(hash_of(*first) == hash_of(*second));
}

TEST_CASE("terrain, then water, then sand: the bits of a world that had every effect from the start") {
    for (const auto& backend : available_backends()) {
        for (const bool open : {false, true}) {
            for (const bool sand_first : {false, true}) {
                auto scene = dry_valley(open);
                auto all = scene;
                all.settings.effects = {{"water", Force::on}, {"sand", Force::on}};
                const Target target = {.backend = backend, .shared_device = true};
                auto grown = make_world(scene, target), full = make_world(all, target);
                const auto first = sand_first ? EditLayer::sand : EditLayer::water,
                           second = sand_first ? EditLayer::water : EditLayer::sand;
                const std::uint32_t bare = grown->plan().effects;
                std::uint32_t one = 0;
                for (int n = 0; n < 25; ++n) {
                    for (auto* world : {grown.get(), full.get()}) {
                        if (n == 2) edit_world(*world, {disc(EditLayer::terrain, 2, 2, 1, 0.3)});
                        if (n == 5 || n == 8) edit_world(*world, {disc(first, 3, 2, 1.3, 0.6)});
                        if (n == 14) edit_world(*world, {disc(second, 3.5, 2.4, 1, 0.5)});
                        if (n == 9) {
                            Edit body = disc(EditLayer::terrain, 3, 2, 1, 0);
                            body.kind = EditKind::push;
                            body.strength = 0.5;
                            body.velocity_x = 2;
                            edit_world(*world, {body});
                        }
                        step(*world, 1);
                    }
                    if (n == 10) one = grown->plan().effects;
                }
                CHECK((bare & (EFFECT_WATER | EFFECT_SAND)) == 0);
                CHECK(((one & EFFECT_SAND) != 0) == sand_first);
                CHECK(grown->plan().effects == full->plan().effects);
                const auto a = state_of(*grown), b = state_of(*full);
                for (const auto& [name, values] : b) {
                    const auto same = std::find_if(a.begin(), a.end(), [&](const auto& f) { return f.first == name; });
                    REQUIRE(same != a.end());
                    CHECK_MESSAGE(same->second == values,
                                  name << " on " << backend << (open ? ", open" : "") << (sand_first ? ", sand first" : ""));
                }
                CHECK(hash_of(*grown) == hash_of(*full));
                check_books(*grown);
            }
        }
    }
}

TEST_CASE("a promotion keeps what runs in parts and what is profiled going") {
    const auto scene = dry_valley(false);
    auto parts = make_world(scene), whole = make_world(scene);
    REQUIRE(parts->stepper().set_profiling(true));
    for (int n = 0; n < 6; ++n) {
        for (auto* world : {parts.get(), whole.get()}) {
            if (n == 1) edit_world(*world, {disc(EditLayer::water, 2, 2, 1, 0.5)});
            if (n == 3) edit_world(*world, {disc(EditLayer::sand, 2, 2, 1, 0.5)});
        }
        do {
            REQUIRE(parts->stepper().step_part());
        } while (parts->stepper().parts_done() > 0);
        step(*whole, 1);
    }
    CHECK(hash_of(*parts) == hash_of(*whole));
    step(*parts, 3);
    auto times = parts->stepper().stage_times();
    REQUIRE(times);
    CHECK(times->size() > 10);
}

TEST_CASE("preparing for every material changes neither plan nor memory nor bits, whatever the level forces off") {
    for (const char* off : {"", "sand", "water"}) {
        auto scene = dry_valley(false);
        if (*off != '\0') scene.settings.effects = {{off, Force::off}};
        auto prepared = make_world(scene), plain = make_world(scene);
        REQUIRE(prepared->stepper().prepare());
        CHECK(prepared->state().device().bytes() == plain->state().device().bytes());
        CHECK(prepared->plan().effects == plain->plan().effects);
        for (auto* world : {prepared.get(), plain.get()}) {
            edit_world(*world, {disc(*off == 'w' ? EditLayer::sand : EditLayer::water, 3, 2, 1, 0.5)});
            step(*world, 3);
        }
        CHECK(hash_of(*prepared) == hash_of(*plain));
    }
}

TEST_CASE("trim brings passes and memory back, and a trimmed world goes on as one that never held the material") {
    auto scene = dry_valley(true);
    auto world = make_world(scene);
    step(*world, 1);
    edit_world(*world, {disc(EditLayer::terrain, 2, 2, 1, 0.1)}); // what edits themselves need is there from now on
    step(*world, 1);
    REQUIRE(world->reader().stats()); // needs a buffer of its own
    const auto bytes = world->state().device().bytes();
    const auto count = passes(*world);
    const auto buffers = world->state().device().memory().size();
    for (int n = 0; n < 3; ++n) {
        edit_world(*world, {disc(EditLayer::water, 5, 2, 1, 0.5)});
        edit_world(*world, {disc(EditLayer::sand, 3, 2, 1, 0.5)});
        step(*world, 20);
        CHECK(world->state().device().bytes() > bytes);
        CHECK(passes(*world) > count);
        REQUIRE(world->commands().trim());
        CHECK(passes(*world) > count); // it still holds both
        edit_world(*world, {disc(EditLayer::sand, 3, 2, 20, -16)});
        step(*world, 1);
        REQUIRE(world->commands().trim());
        CHECK((world->plan().effects & EFFECT_WATER) != 0);
        CHECK((world->plan().effects & (EFFECT_SAND | EFFECT_MIXTURE)) == 0);
        edit_world(*world, {disc(EditLayer::water, 3, 2, 20, -16)});
        step(*world, 1);
        REQUIRE(world->commands().trim());
        CHECK(passes(*world) == count);
        CHECK(world->state().device().bytes() == bytes);
        CHECK(world->state().device().memory().size() == buffers);
        auto s = world->reader().stats();
        REQUIRE(s);
        CHECK(s->ledger.water_in == s->ledger.water_out); // what left through the side is still in the ledger
        CHECK(s->ledger.water_out > 0);
        check_books(*world);
    }
    step(*world, 5);
}

TEST_CASE("passes and bytes follow what the world holds") {
    const auto scene = dry_valley(false);
    auto world = make_world(scene);
    struct Holding {
        std::size_t passes;
        double bytes_per_cell;
    };
    std::vector<Holding> held = {{passes(*world), world->plan().bytes_per_cell()}};
    for (const auto layer : {EditLayer::water, EditLayer::sand}) {
        edit_world(*world, {disc(layer, 3, 2, 1, 0.5)});
        step(*world, 1);
        held.push_back({passes(*world), world->plan().bytes_per_cell()});
    }
    CHECK(held[0].passes == 0);
    CHECK(held[0].bytes_per_cell == 4);
    CHECK(held[1].passes == 4);
    CHECK(held[2].passes > 20);
    CHECK(held[1].bytes_per_cell < held[2].bytes_per_cell);
}

TEST_CASE("nothing is allocated or recorded by edits once a material is there") {
    for (const auto& backend : available_backends()) {
        auto world = make_world(dry_valley(false), {backend});
        const auto frame = [&] {
            edit_world(*world, {disc(EditLayer::water, 3, 2, 1, 0.05)});
            edit_world(*world, {disc(EditLayer::sand, 3, 2, 1, 0.05)});
            step(*world, 1);
        };
        for (int n = 0; n < 3; ++n) frame();
        const auto before = world->device().counters();
        for (int n = 0; n < 10; ++n) frame();
        const auto after = world->device().counters();
        CHECK(after.allocations == before.allocations);
        CHECK(after.recordings == before.recordings);
        CHECK(after.descriptor_writes == before.descriptor_writes);
        CHECK(after.submits == before.submits + 20);
    }
}

TEST_CASE("a snapshot of a promoted world promotes the world it is loaded into") {
    const auto scene = dry_valley(false);
    auto world = make_world(scene), fresh = make_world(scene);
    edit_world(*world, {disc(EditLayer::water, 3, 2, 1, 0.5)});
    edit_world(*world, {disc(EditLayer::sand, 3, 2, 1, 0.5)});
    step(*world, 7);
    const auto bytes = save(*world);
    const auto hash = hash_of(*world);
    REQUIRE(fresh->stepper().step_part());
    REQUIRE(fresh->snapshots().load(bytes));
    CHECK(hash_of(*fresh) == hash);
    step(*fresh, 3);
    step(*world, 3);
    CHECK(hash_of(*fresh) == hash_of(*world));
    auto forced = scene;
    forced.settings.effects = {{"sand", Force::off}};
    auto closed = make_world(forced);
    CHECK(closed->snapshots().load(bytes).code == Code::bad_argument);
}

TEST_CASE("regions are written to the quantum, counted and checked") {
    for (const auto& backend : available_backends()) {
        auto world = make_world(dry_valley(false), {backend});
        const Region corner{0, 20, 5, 4}, middle{10, 3, 8, 12};
        const auto values = [](const Region& region, double base) {
            std::vector<float> v(region.cells());
            for (std::size_t n = 0; n < v.size(); ++n) v[n] = static_cast<float>(base + 0.01 * std::sin(static_cast<double>(n)));
            return v;
        };
        const auto write = [&](EditLayer layer, const Region& region, double base) {
            const auto status = world->commands().write_region(layer, region, values(region, base));
            REQUIRE_MESSAGE(status, status.message);
        };
        write(EditLayer::terrain, corner, 0.5);
        auto raw = world->reader().read_raw("terrain");
        REQUIRE(raw);
        const FieldLayout layout{28, 24};
        for (int j = -GHOST; j < 24 + 1 + GHOST; ++j)
            for (int i = -GHOST; i < 28 + 1 + GHOST; ++i)
                CHECK((*raw)[layout.index(i, j)] == (*raw)[layout.index(std::clamp(i, 0, 27), std::clamp(j, 0, 23))]);
        CHECK((world->plan().effects & EFFECT_WATER) == 0);
        write(EditLayer::water, middle, 0.7);
        write(EditLayer::sand, corner, 0.3);
        std::vector<float> back(middle.cells());
        REQUIRE(world->reader().read("water_height", middle, back));
        const double quantum = world->reader().stats()->quantum;
        const auto wanted = values(middle, 0.7);
        for (std::size_t n = 0; n < back.size(); ++n) {
            CHECK(std::abs(static_cast<double>(back[n]) - static_cast<double>(wanted[n])) <= quantum / 2);
            CHECK(std::fmod(static_cast<double>(back[n]), quantum) == 0);
        }
        check_books(*world);
        step(*world, 10);
        write(EditLayer::sand, middle, 0.2);
        write(EditLayer::sand, {12, 4, 3, 3}, 0.011);
        write(EditLayer::water, corner, 0.02);
        check_books(*world);
        step(*world, 10);
        check_books(*world);

        const auto hash = hash_of(*world);
        const auto refused = [&](EditLayer layer, const Region& region, std::vector<float> v, const char* text) {
            const auto status = world->commands().write_region(layer, region, v);
            CHECK(status.code == Code::bad_argument);
            CHECK_MESSAGE(status.message.find(text) != std::string::npos, status.message);
        };
        auto bad = values(corner, 0.5);
        bad[6] = std::nanf("");
        refused(EditLayer::sand, corner, bad, "in cell (1, 21)");
        bad[6] = -0.1F;
        refused(EditLayer::water, corner, bad, "in cell (1, 21)");
        bad[6] = 15.9F;
        refused(EditLayer::water, corner, bad, "largest_height");
        refused(EditLayer::terrain, corner, {1, 2, 3}, "count is 3");
        for (const Region region : {Region{-1, 0, 2, 2},
                                    {27, 0, 2, 1},
                                    {0, 0, 0, 1},
                                    {0, 0, 1, -1},
                                    {0, 23, 1, 2},
                                    {0, 0, 2147483647, 1},
                                    {2147483647, 0, 2, 1}})
            refused(EditLayer::sand, region, {1}, "region of");
        CHECK(hash_of(*world) == hash);
    }
}
