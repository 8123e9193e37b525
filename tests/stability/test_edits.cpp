// Edits: what they change, what they leave alone, that every quantum is in the ledger, and the same bits however they arrive.
#include "tests/stability/quality.hpp"
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace wadi;
using namespace wadi::test;

namespace {

Edit push(double x, double y, double radius, double u, double v, double strength = 1) {
    Edit edit = brush(EditLayer::terrain, x, y, radius, 0, 0.2);
    edit.kind = EditKind::push;
    edit.strength = strength;
    edit.velocity_x = u;
    edit.velocity_y = v;
    return edit;
}

// Any kind on any layer, some beyond the rim, some too high, over a grid of lx x ly metres.
std::vector<Edit> random_edits(std::mt19937& random, int count, double lx, double ly, std::uint32_t stamps) {
    const auto real = [&](double low, double high) { return low + (high - low) * static_cast<double>(random()) / 4294967296.0; };
    std::vector<Edit> edits;
    for (int n = 0; n < count; ++n) {
        const auto layer = static_cast<EditLayer>(random() % 3);
        Edit edit = brush(layer, real(-0.2, 1.2) * lx, real(-0.2, 1.2) * ly, real(0.01, 0.3) * lx, real(-0.2, 0.2), real(0, 1));
        // Far more than there is, or than there is room for. Depths above the declared largest height would end the exact ledger.
        if (random() % 20 == 0) edit.amount = layer == EditLayer::terrain ? 20 : -20;
        edit.capsule = random() % 3 == 0;
        edit.x1 = real(0, 1) * lx;
        edit.y1 = real(0, 1) * ly;
        if (random() % 4 == 0) {
            edit.kind = EditKind::push;
            edit.strength = real(0, 1);
            edit.velocity_x = real(-5, 5);
            edit.velocity_y = real(-5, 5);
        } else if (stamps > 0 && random() % 4 == 0) {
            edit.kind = EditKind::stamp;
            edit.stamp = 1 + static_cast<std::uint32_t>(random() % stamps);
            edit.x1 = edit.x0 + real(0.1, 0.6) * lx;
            edit.y1 = edit.y0 + real(0.1, 0.6) * ly;
            edit.amount = real(-0.1, 0.1);
        }
        edits.push_back(edit);
    }
    return edits;
}

std::uint32_t make_stamp(World& world, int nx, int ny) {
    std::vector<float> values;
    for (int n = 0; n < nx * ny; ++n) values.push_back(static_cast<float>(std::sin(0.7 * n)));
    auto stamp = world.edits().create_stamp(nx, ny, values);
    REQUIRE_MESSAGE(stamp, stamp.status().message);
    return *stamp;
}

// Columns of 0 and 1 by turns.
std::uint32_t make_stripes(World& world, int columns) {
    std::vector<float> values;
    for (int n = 0; n < columns; ++n) values.push_back(static_cast<float>(n % 2));
    auto stamp = world.edits().create_stamp(columns, 1, values);
    REQUIRE_MESSAGE(stamp, stamp.status().message);
    return *stamp;
}

std::vector<float> read(World& world, const char* field) {
    const auto& grid = world.settings().grid;
    std::vector<float> values(static_cast<std::size_t>(grid.nx * grid.ny));
    const auto status = world.reader().read(field, values);
    REQUIRE_MESSAGE(status, status.message);
    return values;
}

} // namespace

TEST_CASE("thousands of random edits keep the ledger to the last quantum, and every backend gives the same bits") {
    std::uint64_t first = 0;
    for (const auto& backend : available_backends()) {
        auto scene = mixed_scene(40, 37);
        auto world = make_world(scene, {backend});
        std::mt19937 random(7);
        std::uint32_t stamps = 0;
        for (int n = 0; n < 60; ++n) {
            if (n % 20 == 5) stamps = make_stamp(*world, 7 + 30 * n, 3 + n);
            edit_world(*world, random_edits(random, 50, 8, 7.4, stamps));
            step(*world, 1);
        }
        check_books(*world);
        CHECK(stats_of(*world).ledger.refused > 0);
        const auto hash = hash_of(*world);
        if (backend == "cpu") first = hash;
        CHECK_MESSAGE(hash == first, backend);
    }
}

TEST_CASE("a brush changes its layer by the amount at its centre, less towards its rim, and nothing outside") {
    const auto scene = mixed_scene(32, 32);
    const char* fields[] = {"terrain", "sand_height", "water_height"};
    for (const auto layer : {EditLayer::terrain, EditLayer::sand, EditLayer::water}) {
        auto world = make_world(scene), still = make_world(scene);
        std::vector<std::vector<float>> before;
        for (const char* field : fields) before.push_back(read(*world, field));
        edit_world(*world, {brush(layer, 3.3, 3.3, 1.0, 0.25)});
        // Only what the edits do: the step that follows is the same in both worlds but for them.
        step(*world, 1);
        step(*still, 1);
        const auto n = static_cast<std::size_t>(layer);
        const auto after = read(*world, fields[n]), other = read(*still, fields[n]);
        if (layer == EditLayer::terrain) {
            for (int j = 0; j < 32; ++j) {
                for (int i = 0; i < 32; ++i) {
                    const auto k = static_cast<std::size_t>(j * 32 + i);
                    const double d = std::hypot((i + 0.5) * 0.2 - 3.3, (j + 0.5) * 0.2 - 3.3),
                                 s = std::clamp((1 - d) / 0.5, 0.0, 1.0);
                    const double expected = static_cast<double>(before[n][k]) + 0.25 * s * s * (3 - 2 * s);
                    CHECK(static_cast<double>(after[k]) == doctest::Approx(expected).epsilon(1e-4));
                    if (d > 1) CHECK(after[k] == other[k]);
                }
            }
        }
        const auto s = stats_of(*world), t = stats_of(*still);
        const auto added = [&](std::int64_t now, std::int64_t then) {
            return static_cast<double>(now - then) * s.quantum * 0.04;
        };
        // Volume of the bump: 2 pi times the integral of w(r) r: a core of 0.5 m and a falloff whose moment is 0.5^2 (1/2 - 3/20)
        // + ...
        double volume = 0;
        for (int k = 0; k < 1000; ++k) {
            const double r = (k + 0.5) / 1000, w = std::clamp((1 - r) / 0.5, 0.0, 1.0);
            volume += 2 * 3.14159265 * r * w * w * (3 - 2 * w) * 0.25 / 1000;
        }
        const double sand = added(s.ledger.sand_in, t.ledger.sand_in), water = added(s.ledger.water_in, t.ledger.water_in);
        CHECK(sand == doctest::Approx(layer == EditLayer::sand ? volume : 0).epsilon(0.03));
        CHECK(water == doctest::Approx(layer == EditLayer::water ? volume : 0).epsilon(0.03));
        check_books(*world);
    }
}

TEST_CASE("a brush with a hard rim and a stamp have their volume, wherever they lie between the cells") {
    const double pi = std::acos(-1.0);
    const auto brought = [](const Edit& edit, int image) {
        auto world = make_world(mixed_scene(32, 32));
        Edit placed = edit;
        if (image > 0) placed.stamp = make_stripes(*world, image);
        edit_world(*world, {placed});
        step(*world, 1);
        check_books(*world);
        const auto stats = stats_of(*world);
        return static_cast<double>(stats.ledger.sand_in) * stats.quantum * 0.04;
    };
    for (const double x : {3.2, 3.3, 3.23, 3.37}) {
        for (const double radius : {0.06, 0.15, 0.3, 0.41, 0.9, 1.5}) { // cells of 0.2 m
            CAPTURE(x);
            CAPTURE(radius);
            const double within = radius < 0.1 ? 0.02 : 0.004;
            CHECK(brought(brush(EditLayer::sand, x, 3.31, radius, 0.5, 0), 0) ==
                  doctest::Approx(0.5 * pi * radius * radius).epsilon(within));
            Edit line = brush(EditLayer::sand, x, 3.31, radius, 0.5, 0);
            line.capsule = true;
            line.x1 = x - 1.3;
            line.y1 = 2.4;
            const double length = std::hypot(1.3, 0.91);
            CHECK(brought(line, 0) == doctest::Approx(0.5 * (pi * radius * radius + 2 * radius * length)).epsilon(2 * within));
        }
        // Stripes finer than the cells: their mean, and of cells at the rim what lies inside.
        Edit stamp = brush(EditLayer::sand, x, 2.11, 0, 0.5);
        stamp.kind = EditKind::stamp;
        stamp.x1 = x + 2.05;
        stamp.y1 = 4.02;
        CHECK(brought(stamp, 40) == doctest::Approx(0.25 * 2.05 * 1.91).epsilon(0.01));
    }
}

TEST_CASE("terrain edits repeat the edge in the ghosts") {
    for (const auto& [nx, ny] : {std::pair{20, 40}, {1, 1}, {1, 9}, {9, 1}}) {
        const auto scene = flat_scene(nx, ny, 0.5, 0.02);
        auto world = make_world(scene);
        edit_world(*world, {brush(EditLayer::terrain, 0, 0, 3, 0.5), brush(EditLayer::terrain, 0.5 * nx, 0.5 * ny, 4, -0.75, 1)});
        step(*world, 1);
        auto raw = world->reader().read_raw("terrain");
        REQUIRE(raw);
        const FieldLayout layout{nx, ny};
        CHECK((*raw)[layout.index(0, 0)] != 0.0F);
        for (int j = -GHOST; j < ny + 1 + GHOST; ++j)
            for (int i = -GHOST; i < nx + 1 + GHOST; ++i)
                CHECK((*raw)[layout.index(i, j)] == (*raw)[layout.index(std::clamp(i, 0, nx - 1), std::clamp(j, 0, ny - 1))]);
    }
}

TEST_CASE("one call with a hundred edits equals a hundred calls, and queued steps equal calls in time") {
    const auto scene = mixed_scene(40, 24);
    std::mt19937 random(3);
    const auto edits = random_edits(random, 100, 8, 4.8, 0);
    auto all = make_world(scene), single = make_world(scene), ahead = make_world(scene);
    step(*all, 3);
    step(*single, 3);
    edit_world(*all, edits);
    for (auto edit : edits) edit_world(*single, {edit});
    for (auto edit : edits) {
        edit.step = 3;
        edit_world(*ahead, {edit});
    }
    step(*ahead, 3);
    CHECK(hash_of(*ahead) == hash_of(*single)); // nothing is due yet
    for (auto* world : {all.get(), single.get(), ahead.get()}) step(*world, 5);
    CHECK(hash_of(*all) == hash_of(*single));
    CHECK(hash_of(*all) == hash_of(*ahead));
    // The order counts: filling a pit and digging it are not the same.
    auto forth = make_world(scene), back = make_world(scene);
    edit_world(*forth, {brush(EditLayer::sand, 4, 2, 1, -9), brush(EditLayer::sand, 4, 2, 1, 0.5)});
    edit_world(*back, {brush(EditLayer::sand, 4, 2, 1, 0.5), brush(EditLayer::sand, 4, 2, 1, -9)});
    step(*forth, 1);
    step(*back, 1);
    CHECK(hash_of(*forth) != hash_of(*back));
}

TEST_CASE("an edit made in the middle of a step belongs to the next one") {
    const auto scene = mixed_scene(24, 24);
    auto parts = make_world(scene), whole = make_world(scene);
    REQUIRE(parts->stepper().step_part());
    edit_world(*parts, {brush(EditLayer::water, 2, 2, 1, 0.3)});
    CHECK(parts->edits().next_step() == 1);
    for (int n = 1; n < 2 * parts->stepper().parts(); ++n) REQUIRE(parts->stepper().step_part());
    step(*whole, 1);
    edit_world(*whole, {brush(EditLayer::water, 2, 2, 1, 0.3)});
    step(*whole, 1);
    CHECK(hash_of(*parts) == hash_of(*whole));
}

TEST_CASE("mirrored and transposed edits give mirrored and transposed bits") {
    const int nx = 36, ny = 36;
    const double l = nx * 0.2;
    // 0 as it is, 1 mirrored in x, 2 mirrored in y, 3 transposed
    std::vector<float> first;
    for (int kind = 0; kind < 4; ++kind) {
        auto scene = flat_scene(nx, ny, 0.2, 0.015);
        const auto place = [&](double& x, double& y) {
            if (kind == 1) x = l - x;
            if (kind == 2) y = l - y;
            if (kind == 3) std::swap(x, y);
        };
        auto world = make_world(scene);
        std::mt19937 random(11);
        for (int n = 0; n < 20; ++n) {
            auto edits = random_edits(random, 10, l, l, 0);
            for (auto& edit : edits) {
                place(edit.x0, edit.y0);
                place(edit.x1, edit.y1);
                if (kind == 1) edit.velocity_x = -edit.velocity_x;
                if (kind == 2) edit.velocity_y = -edit.velocity_y;
                if (kind == 3) std::swap(edit.velocity_x, edit.velocity_y);
            }
            edit_world(*world, edits);
            step(*world, 1);
        }
        std::vector<float> all;
        for (const char* field : {"terrain", "sand_height", "water_height"}) {
            const auto values = read(*world, field);
            for (int j = 0; j < ny; ++j) {
                for (int i = 0; i < nx; ++i) {
                    const int a = kind == 1 ? nx - 1 - i : kind == 3 ? j : i, b = kind == 2 ? ny - 1 - j : kind == 3 ? i : j;
                    all.push_back(values[static_cast<std::size_t>(b * nx + a)]);
                }
            }
        }
        if (kind == 0) first = all;
        CHECK_MESSAGE(all == first, "kind " << kind);
    }
}

TEST_CASE("edits beyond the rim touch the cells inside only; far outside they cost no submission") {
    const auto scene = mixed_scene(24, 20);
    auto world = make_world(scene), still = make_world(scene);
    step(*world, 1);
    step(*still, 1);
    const auto submits = world->device().counters().submits;
    edit_world(*world, {brush(EditLayer::water, -50, 3, 10, 1), brush(EditLayer::sand, 3, 1e9, 10, 1), push(900, 3, 10, 1, 0)});
    step(*world, 1);
    CHECK(world->device().counters().submits == submits + 1);
    step(*still, 1);
    CHECK(hash_of(*world) == hash_of(*still));
    edit_world(*world, {brush(EditLayer::water, -1, -1, 3, 0.5)}); // half a disc
    step(*world, 1);
    check_books(*world);
    step(*still, 1);
    CHECK(hash_of(*world) != hash_of(*still));
}

TEST_CASE("a body pushes water and sand and moves no mass itself") {
    for (const bool capsule : {false, true}) {
        const auto scene = mixed_scene(32, 32);
        auto world = make_world(scene), still = make_world(scene);
        auto body = push(2.6, 2.9, 1, 2, -1);
        body.capsule = capsule;
        body.x1 = 4;
        body.y1 = 3;
        for (int n = 0; n < 10; ++n) {
            edit_world(*world, {body});
            step(*world, 1);
            step(*still, 1);
        }
        check_books(*world);
        const auto s = stats_of(*world);
        CHECK(s.ledger.sand_in + s.ledger.sand_out + s.ledger.water_in + s.ledger.water_out == 0);
        for (const char* layer : {"sand_velocity_", "water_velocity_", "mixed_velocity_"}) {
            const auto x = read(*world, (std::string(layer) + "x").c_str()),
                       before = read(*still, (std::string(layer) + "x").c_str());
            float most = 0;
            for (std::size_t n = 0; n < x.size(); ++n) most = std::max(most, x[n] - before[n]);
            CHECK_MESSAGE(most > 0.2F, layer);
        }
    }
}

TEST_CASE("edits that are no edits are refused by name, and nothing is queued") {
    auto scene = mixed_scene(16, 16);
    scene.settings.effects = {{"water", Force::off}};
    scene.fields.water.clear();
    auto world = make_world(scene);
    const auto good = brush(EditLayer::sand, 1, 1, 1, 0.1);
    const auto refused = [&](auto change, const char* name) {
        Edit bad = good;
        change(bad);
        const auto status = world->commands().edit(std::vector<Edit>{good, bad});
        CHECK_MESSAGE(status.code == Code::bad_argument, name);
        CHECK_MESSAGE(status.message.find("edits[1]." + std::string(name)) != std::string::npos, status.message);
    };
    const double nan = std::nan("");
    refused([&](Edit& e) { e.x0 = nan; }, "x0");
    refused([&](Edit& e) { e.y0 = INFINITY; }, "y0");
    refused([&](Edit& e) { e.capsule = true, e.x1 = nan; }, "x1");
    refused([&](Edit& e) { e.radius = 0; }, "radius");
    refused([&](Edit& e) { e.radius = -1; }, "radius");
    refused([&](Edit& e) { e.softness = 1.01; }, "softness");
    refused([&](Edit& e) { e.amount = nan; }, "amount");
    refused([&](Edit& e) { e.amount = 33; }, "amount");
    refused([&](Edit& e) { e.layer = EditLayer::water; }, "layer: effects.water");
    refused([&](Edit& e) { e.kind = EditKind::push, e.strength = 2; }, "strength");
    refused([&](Edit& e) { e.kind = EditKind::push, e.velocity_y = nan; }, "velocity_y");
    refused([&](Edit& e) { e.kind = EditKind::stamp, e.stamp = 1, e.x1 = 2, e.y1 = 2; }, "stamp: 1 is not one");
    refused([&](Edit& e) { e.kind = EditKind::stamp; }, "x1");
    step(*world, 2);
    refused([&](Edit& e) { e.step = 1; }, "step: 1 has been");
    const auto hash = hash_of(*world);
    auto still = make_world(scene);
    step(*still, 2);
    CHECK(hash == hash_of(*still));
    const float bad_values[] = {1, std::nanf("")};
    CHECK(world->edits().create_stamp(2, 1, bad_values).status().code == Code::bad_argument);
    CHECK(world->edits().create_stamp(0, 1, {}).status().code == Code::bad_argument);
    CHECK(world->edits().create_stamp(5000, 1, bad_values).status().code == Code::bad_argument);
    const float big[] = {1000};
    REQUIRE(world->edits().create_stamp(1, 1, big));
    refused([&](Edit& e) { e.kind = EditKind::stamp, e.stamp = 1, e.x1 = 2, e.y1 = 2; }, "amount times");
}
