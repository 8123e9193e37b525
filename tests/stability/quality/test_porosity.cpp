// Pores that are a share of the sand (NUMERICS 2.23): what sand displaces, what it bears when it is soaked, how water seeps
// through it.
#include "engine/step/plan/world_params.hpp"
#include "tests/stability/quality/wet_scenes.hpp"
#include <algorithm>
#include <cmath>

using namespace wadi;
using namespace wadi::test;

namespace {

/// Quartz sand: grains of 2667 kg/m3, two fifths pores.
void make_quartz(Material& material, double porosity = 0.4) {
    material.porosity = porosity;
    material.sand_density = 1600;
}

double quantum_of(const World& world) { return height_quantum(world.settings().method); }

/// Water that so much sand holds, in whole quanta, by floats as the stages have them.
double room(const World& world, double sand) {
    const auto n = static_cast<float>(world.settings().material.porosity);
    const double quantum = quantum_of(world);
    return std::floor(static_cast<double>(n * static_cast<float>(sand)) / quantum) * quantum;
}

/// How deep a cell's water stands: the definition, from both heights.
double standing(const World& world, double water, double sand) {
    const double holds = room(world, sand);
    return water < holds ? water / world.settings().material.porosity : sand + (water - holds);
}

std::vector<double> surfaces(World& world) {
    const auto ground = cells_of(world, "terrain"), sand = cells_of(world, "sand_height"),
               water = cells_of(world, "water_height");
    std::vector<double> found;
    for (std::size_t c = 0; c < sand.values.size(); ++c)
        found.push_back(static_cast<double>(ground.values[c]) +
                        standing(world, static_cast<double>(water.values[c]), static_cast<double>(sand.values[c])));
    return found;
}

/// By how much the surface of a pond 6 m long and 1 m deep has risen at both of its ends once 0.6 m2 of sand were poured into it,
/// over what that volume would raise it by. It still swings, once in 3.8 s.
std::pair<double, double> rise_of_pond(double dx, double porosity, double conductivity = 0) {
    const int cells = static_cast<int>(std::lround(6 / dx));
    auto scene = flat_scene(cells, 4, dx, 0.08 * dx);
    make_quartz(scene.settings.material, porosity);
    scene.settings.material.conductivity = conductivity;
    scene.fill(scene.fields.water, [](double, double) { return 1.0; });
    Source source;
    source.material = SourceMaterial::sand;
    source.shape = SourceShape::box;
    source.box = {2.4, 0, 3.6, 4 * dx};
    source.rate = {{{0, 0.05}, {10, 0.05}, {10.001, 0}}};
    scene.settings.sources = {source};
    auto world = make_world(scene);
    const auto steps = [&](double seconds) { return static_cast<int>(std::lround(seconds / scene.settings.dt)); };
    step(*world, steps(16));
    std::pair<double, double> ends;
    constexpr int samples = 38;
    for (int n = 0; n < samples; ++n) {
        step(*world, steps(0.2));
        const auto surface = surfaces(*world);
        ends.first += (surface.front() - 1) / samples;
        ends.second += (surface[static_cast<std::size_t>(cells) - 1] - 1) / samples;
    }
    check_books(*world);
    const double poured = total(cells_of(*world, "sand_height")) * dx / 4;
    CHECK(poured == doctest::Approx(0.6).epsilon(0.01));
    return {ends.first * 6 / poured, ends.second * 6 / poured};
}

} // namespace

TEST_CASE("sand that is poured into a pond raises it by the volume of its grains") {
    for (const double dx : {0.1, 0.2}) {
        CAPTURE(dx);
        const auto [west, east] = rise_of_pond(dx, 0.4);
        MESSAGE("cells of " << dx << " m: the pond rises by " << west << " and " << east << " of the sand's volume, right 0.6");
        CHECK(west == doctest::Approx(0.6).epsilon(0.01));
        CHECK(east == doctest::Approx(0.6).epsilon(0.01));
    }
    CHECK(rise_of_pond(0.2, 0.4, 1e-4).first == doctest::Approx(0.6).epsilon(0.01)); // what falls through water is soaked
    CHECK(std::fabs(rise_of_pond(0.2, 1).first) < 0.01);                             // control: grains of no volume
}

namespace {

/// A lake whose table goes on in the dune that stands out of it. pores: by which its water is drawn.
Scene lake_in_dune(double porosity, double pores, bool cohesive) {
    auto scene = flat_scene(96, 3, 0.25, 0.01);
    auto& material = scene.settings.material;
    make_quartz(material, porosity);
    material.friction = 0.5;
    material.young_modulus = cohesive ? 2e5 : 0;
    material.cohesion_dry = material.cohesion_wet = material.cohesion_capillary = cohesive ? 4e3 : 0;
    const auto ground = [](double x, double y) { return 0.2 + 0.05 * std::sin(x) * std::cos(2 * y); };
    const auto dune = [](double x, double) { return std::max(0.1, 1.4 - 0.2 * std::fabs(x - 12)); };
    const double quantum = height_quantum(scene.settings.method), level = 0.9;
    const auto whole = [&](double h) { return std::nearbyint(h / quantum) * quantum; };
    scene.fill(scene.fields.terrain, [&](double x, double y) { return whole(ground(x, y)); });
    scene.fill(scene.fields.sand, [&](double x, double y) { return whole(dune(x, y)); });
    scene.fill(scene.fields.water, [&](double x, double y) {
        const double sand = whole(dune(x, y)), depth = whole(level) - whole(ground(x, y));
        const double holds =
            std::floor(static_cast<double>(static_cast<float>(pores) * static_cast<float>(sand)) / quantum) * quantum;
        return depth >= sand ? holds + (depth - sand) : std::min(whole(pores * depth), holds);
    });
    return scene;
}

bool keeps_every_bit(const Scene& scene) {
    auto world = make_world(scene);
    const auto sand = cells_of(*world, "sand_height").values, water = cells_of(*world, "water_height").values;
    step(*world, 2000);
    check_books(*world);
    return cells_of(*world, "sand_height").values == sand && cells_of(*world, "water_height").values == water;
}

} // namespace

TEST_CASE("a lake over a dune rests in every bit for 20 s at any porosity, with cohesion, too") {
    for (const double porosity : {0.4, 0.375, 1.0 / 3})
        for (const bool cohesive : {false, true}) {
            CAPTURE(porosity);
            CAPTURE(cohesive);
            auto scene = lake_in_dune(porosity, porosity, cohesive);
            CHECK(keeps_every_bit(scene));
            scene.settings.material.conductivity = 1e-3; // 2.24
            CHECK(keeps_every_bit(scene));
        }
    CHECK_FALSE(keeps_every_bit(lake_in_dune(0.4, 1, false))); // control: water as if pores were as large as the sand
}

namespace {

/// Speed in the middle of a slope of soaked sand 0.3 m deep after a second [m/s].
double soaked_speed(double slope, double porosity, double density, double exchange) {
    auto scene = flat_scene(240, 2, 0.1, 0.01);
    scene.settings.method.largest_height = 32;
    auto& material = scene.settings.material;
    material.porosity = porosity;
    material.sand_density = density;
    material.friction = 0.5;
    material.young_modulus = 0;
    material.exchange_rate = exchange;
    scene.fill(scene.fields.terrain, [&](double x, double) { return slope * x; });
    scene.fill(scene.fields.sand, [](double, double) { return 0.3; });
    scene.fill(scene.fields.water, [&](double, double) { return 0.3 * porosity; });
    auto world = make_world(scene);
    step(*world, 100);
    const auto speeds = cells_of(*world, "sand_velocity_x").values;
    double fastest = 0;
    for (std::size_t i = 100; i < 140; ++i) fastest = std::max(fastest, std::fabs(static_cast<double>(speeds[i])));
    return fastest;
}

/// S (1 - beta r) + r S (1 + S^2) = mu (1 - beta r): weight that pressure leaves, and what seeps down the slope (NUMERICS 4).
double soaked_limit(double porosity, double density) {
    const double r = 1000 / density, left = 1 - r * (porosity < 1 ? 1 - porosity : 1);
    double slope = 0.25;
    for (int n = 0; n < 50; ++n) slope = 0.5 * left / (left + r * (1 + slope * slope));
    return slope;
}

} // namespace

TEST_CASE("soaked sand with seepage along its slope stands to half of its friction") {
    CHECK(soaked_limit(0.4, 1600) == doctest::Approx(0.25).epsilon(0.05));
    for (const double exchange : {1e4, 1e6}) {
        CAPTURE(exchange);
        CHECK(soaked_speed(0.24, 0.4, 1600, exchange) == 0);
        CHECK(soaked_speed(0.26, 0.4, 1600, exchange) > 0.01);
        for (const double porosity : {0.3, 0.5}) {
            const double limit = soaked_limit(porosity, 2667 * (1 - porosity));
            CAPTURE(porosity);
            CHECK(soaked_speed(0.95 * limit, porosity, 2667 * (1 - porosity), exchange) == 0);
            CHECK(soaked_speed(1.05 * limit, porosity, 2667 * (1 - porosity), exchange) > 0.01);
        }
    }
    CHECK(soaked_speed(0.24, 1, 1600, 1e6) > 0.01); // control: what displaces as much as it has room for
}

TEST_CASE("water seeps into a wall of sand as Boussinesq's equation has it at any porosity") {
    for (const double porosity : {0.4, 1.0})
        for (const double dx : {0.2, 0.1}) {
            const double seeped = seeped_into_wall(dx, 4, [&](Material& material) { make_quartz(material, porosity); });
            const double share = seeped / seeped_by_boussinesq(4, porosity);
            CAPTURE(porosity);
            MESSAGE("cells of " << dx << " m, porosity " << porosity << ": volume over that of the similarity solution "
                                << share);
            CHECK(share > 0.93);
            CHECK(share < (dx > 0.1 ? 1.2 : 1.06));
        }
}

namespace {

struct GroundWater {
    double flow = 0; // over Dupuit's
    double off = 0;  // of the table, as a share of the difference of the levels
};

/// Sand 2 m deep and 10 m long between levels of 1.2 and 0.6 m, once its flow is steady.
GroundWater between_levels(double porosity) {
    const int cells = 50;
    const double dx = 0.2, high = 1.2, low = 0.6, exchange = 2e4, length = cells * dx + dx; // between the middles of the ghosts
    auto scene = flat_scene(cells, 1, dx, 0.01);
    auto& material = scene.settings.material;
    make_quartz(material, porosity);
    material.exchange_rate = exchange;
    material.retention = material.diffusion_rate = 0;
    material.young_modulus = 0;
    material.friction = 2;
    scene.settings.method.rest_rule = false;
    scene.fill(scene.fields.sand, [](double, double) { return 2.0; });
    scene.fill(scene.fields.water, [&](double, double) { return porosity * 0.9; });
    scene.settings.sides[SIDE_WEST] = {SideKind::level, 0, 1e30, {{{0, high}}}};
    scene.settings.sides[SIDE_EAST] = {SideKind::level, 0, 1e30, {{{0, low}}}};
    auto world = make_world(scene);
    step(*world, 20000);
    const auto before = stats_of(*world);
    step(*world, 2000);
    const auto after = stats_of(*world);
    const double out = static_cast<double>(after.ledger.water_out - before.ledger.water_out) * after.quantum * dx / (2000 * 0.01);
    const double truth = 1000 * 9.81 / exchange * (high * high - low * low) / (2 * length);
    const auto table = surfaces(*world);
    GroundWater found{out / truth, 0};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double x = (static_cast<double>(i) + 1) * dx;
        const double right = std::sqrt(high * high - (high * high - low * low) * x / length);
        found.off = std::max(found.off, std::fabs(table[i] - right) / (high - low));
    }
    return found;
}

} // namespace

TEST_CASE("ground water between two levels flows as Dupuit has it at any porosity") {
    for (const double porosity : {0.4, 1.0 / 3, 1.0}) {
        const auto found = between_levels(porosity);
        MESSAGE("porosity " << porosity << ": flow over Dupuit's " << found.flow << ", table off by " << found.off);
        CHECK(found.flow == doctest::Approx(1).epsilon(0.02));
        CHECK(found.off < 0.01);
    }
}

TEST_CASE("porous sand and water: the same bits on every backend, no quantum lost") {
    for (const double porosity : {0.4, 1.0 / 3, 0.02, 0.999}) {
        CAPTURE(porosity);
        auto scene = mixed_scene_with_sides(33, 20);
        make_quartz(scene.settings.material, porosity);
        on_every_backend(scene, [](World& w) { step(w, 60); });
    }
}
