// Half storage (NUMERICS 2.17): rounding to nearest, the same bits however a step is run, exact mass, rest, and what it costs in
// accuracy and saves in memory.
#include "engine/step/plan/half.hpp"
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

namespace narrow {
#include "shaders/language/stage_cpp.h"
}

Scene halved(Scene scene) {
    scene.settings.method.half_storage = true;
    return scene;
}

float next_up(std::uint16_t bits) { return from_half(static_cast<std::uint16_t>(bits + 1)); }

} // namespace

TEST_CASE("half storage: every 16-bit float stays, what lies between goes to the nearest, in the engine and in the stages") {
    using narrow::Half;
    for (std::uint32_t bits = 0; bits < 0x7c00; ++bits) {
        const auto low = static_cast<std::uint16_t>(bits);
        const float value = from_half(low);
        const auto goes_to = [&](float x, std::uint32_t expected) {
            const Half positive(narrow::half_of(x)), negative(narrow::half_of(-x));
            const std::uint32_t minus = expected == 0 ? 0 : expected | 0x8000u;
            return to_half(x) == expected && to_half(-x) == minus && positive.bits == expected && negative.bits == minus &&
                   static_cast<float>(positive) == from_half(static_cast<std::uint16_t>(expected));
        };
        bool right = goes_to(value, bits);
        if (bits < 0x7bff) {
            const float middle = 0.5F * (value + next_up(low));
            right = right && goes_to(std::nextafter(middle, 0.0F), bits) && goes_to(std::nextafter(middle, 1e9F), bits + 1) &&
                    goes_to(middle, bits + (bits & 1)); // to the even one
        }
        REQUIRE_MESSAGE(right, "16-bit float " << bits << ", " << value);
    }
    for (const float large : {65519.0F, 65520.0F, 1e30F}) CHECK(to_half(large) == Half(narrow::half_of(large)).bits);
    CHECK(from_half(to_half(1e30F)) == 65504);
    CHECK(std::isnan(from_half(to_half(NAN))));
    CHECK(std::isnan(static_cast<float>(Half(narrow::half_of(NAN)))));
}

TEST_CASE("half storage: the same bits on every backend, fused, over active tiles, in parts and across snapshots") {
    for (const char* name : {"dam_break", "castle", "spring"}) {
        if (few_steps && name != std::string("castle")) continue;
        CAPTURE(name);
        const auto scene = halved(shipped_level(name, 70, 50));
        auto plain = scene;
        plain.settings.fused_stages = FusedStages::never;
        auto expected = make_world(plain), full = make_world(shipped_level(name, 70, 50));
        const int steps = few_steps ? 4 : 8;
        step(*expected, steps);
        step(*full, steps);
        CHECK(hash_of(*expected) != hash_of(*full)); // it does something
        for (const auto& backend : available_backends()) {
            for (const bool fused : {false, true}) {
                for (const int tiles : {0, 16}) {
                    if (backend != "cpu" && fused != (tiles > 0)) continue; // each of the two once
                    auto way = scene;
                    way.settings.fused_stages = fused ? FusedStages::always : FusedStages::never;
                    way.settings.active_tiles = tiles;
                    CAPTURE(backend);
                    CAPTURE(fused);
                    CAPTURE(tiles);
                    auto world = make_world(way, {.backend = backend, .shared_device = true});
                    const auto& device = world->device().capabilities();
                    if (!device.exact_float || (fused && !device.fused_stages)) continue;
                    step(*world, steps / 2);
                    auto again = make_world(plain);
                    REQUIRE(again->snapshots().load(save(*world)));
                    for (auto* w : {world.get(), again.get()}) step(*w, steps - steps / 2);
                    CHECK(hash_of(*world) == hash_of(*expected));
                    CHECK(hash_of(*again) == hash_of(*expected));
                    CHECK(world->device().counters().validation_messages == 0);
                }
            }
        }
    }
}

TEST_CASE("half storage: mass is exact, a lake and a pile rest, and the error is below that of the time step") {
    auto scene = mixed_scene(48, 40), finer = scene;
    finer.settings.dt /= 2;
    const auto half = halved(scene);
    auto full_world = make_world(scene), half_world = make_world(half), fine_world = make_world(finer);
    const int steps = few_steps ? 10 : 150;
    step(*full_world, steps);
    step(*half_world, steps);
    step(*fine_world, 2 * steps);
    const auto difference = [&](World& a, World& b, const char* field) {
        const auto x = a.reader().read_raw(field), y = b.reader().read_raw(field);
        REQUIRE((x && y));
        double sum = 0, all = 0;
        for (std::size_t n = 0; n < x->size(); ++n) {
            sum += std::abs(static_cast<double>((*x)[n]) - static_cast<double>((*y)[n]));
            all += std::abs(static_cast<double>((*x)[n]));
        }
        return sum / all;
    };
    for (const char* field : {"sand_height", "water_height"}) {
        const double by_half = difference(*full_world, *half_world, field), by_dt = difference(*full_world, *fine_world, field);
        MESSAGE(field << ": half storage " << 100 * by_half << " %, half the time step " << 100 * by_dt << " %");
        CHECK(by_half > 0);
        CHECK(by_half < by_dt);
    }
    const auto stats = half_world->reader().stats();
    REQUIRE(stats);
    CHECK(stats->sand_quanta == stats->sand_initial + stats->ledger.sand_in - stats->ledger.sand_out);
    CHECK(stats->water_quanta == stats->water_initial + stats->ledger.water_in - stats->ledger.water_out);
    CHECK(half_world->plan().bytes_per_cell() < 0.8 * full_world->plan().bytes_per_cell());
    CHECK(half_world->state().device().bytes() < full_world->state().device().bytes());

    auto still = halved(flat_scene(40, 30, 0.2, 0.01));
    still.fill(still.fields.terrain, [](double x, double y) { return 0.5 + 0.4 * std::sin(x) * std::cos(y); });
    still.fill(still.fields.water,
               [](double x, double y) { return std::max(0.0, 0.8 - (0.5 + 0.4 * std::sin(x) * std::cos(y))); });
    auto lake = make_world(still);
    step(*lake, few_steps ? 5 : 20);
    const auto settled = lake->reader().stats();
    REQUIRE(settled);
    const auto before = hash_of(*lake);
    step(*lake, few_steps ? 10 : 200);
    CHECK(lake->reader().stats()->largest_water_speed == 0);
    CHECK(hash_of(*lake) == before);
}

TEST_CASE("half storage: no speed is rounded above the clamp") {
    for (const float value : {30.0087384F, 0.12332255F, 0.959863591F, 4096.0F, 7e4F, 3e-8F}) {
        CHECK(half_at_most(value) <= value);
        const bool next_is_above = value > 65504 || next_up(to_half(half_at_most(value))) > value;
        CHECK(next_is_above);
    }
    auto scene = halved(flat_scene(24, 4, 0.2, 0.1)); // a dam that breaks far beyond what the step can follow
    scene.fill(scene.fields.water, [](double x, double) { return x < 2 ? 2.0 : 0.1; });
    auto world = make_world(scene);
    for (int n = 0; n < 20; ++n) {
        step(*world, 1);
        const auto stats = world->reader().stats();
        REQUIRE(stats);
        CHECK(stats->largest_water_speed <= 0.35 * 0.2 / 0.1);
        if (n == 10) CHECK(stats->largest_water_speed > 0.99 * 0.35 * 0.2 / 0.1);
    }
}

TEST_CASE("half storage: regions, edits and fields of a world read and write plain numbers") {
    auto scene = halved(mixed_scene(40, 30));
    auto world = make_world(scene);
    step(*world, 5);
    const auto stretch = world->reader().read_raw("stretch_xx"), velocity = world->reader().read_raw("sand_velocity_x");
    REQUIRE((stretch && velocity));
    float most = 0;
    for (const float v : *velocity) {
        most = std::max(most, std::abs(v));
        CHECK(from_half(to_half(v)) == v);
    }
    CHECK(most > 1e-3F);
    std::vector<float> cells(40 * 30);
    REQUIRE(world->reader().read("stretch_xx", cells));
    const FieldLayout layout{40, 30};
    for (int j = 0; j < 30; ++j)
        for (int i = 0; i < 40; ++i) CHECK(cells[static_cast<std::size_t>(j * 40 + i)] == (*stretch)[layout.index(i, j)]);
    edit_world(*world, {brush(EditLayer::sand, 4, 3, 1, 0.3)});
    step(*world, 5);
    const auto stats = world->reader().stats();
    REQUIRE(stats);
    CHECK(stats->not_finite == 0);
}
