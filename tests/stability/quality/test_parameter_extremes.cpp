// Parameters from nothing to far beyond sense: every setting's range, exchange rate, stiffness, cohesion, sources.
#include "backends/registry.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/messages.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/stability/quality.hpp"
#include <limits>

using namespace wadi;
using namespace wadi::test;

namespace {

Scene column(double wet) {
    auto scene = flat_scene(40, 40, 0.1, 0.009);
    const auto inside = [](double x, double y) { return std::hypot(x - 2, y - 2) < 1.2; };
    scene.fill(scene.fields.sand, [&](double x, double y) { return inside(x, y) ? 1.0 : 0.0; });
    scene.fill(scene.fields.water, [&](double x, double y) { return inside(x, y) ? wet : 0.0; });
    return scene;
}

/// Edges count: a column that stands keeps the roughness it was drawn with.
double drawn_roughness(const Scene& scene) { return roughness(cells_of(*make_world(scene), "sand_height")); }

/// Water comes at 100 m/s and 100 m of depth a second, and leaves over two sides.
Scene jet(double dt) {
    auto scene = flat_scene(48, 32, 0.2, dt);
    scene.settings.method.largest_height = 1024;
    scene.fill(scene.fields.water, [](double, double) { return 0.3; });
    scene.fill(scene.fields.sand, [](double x, double y) { return std::hypot(x - 6, y - 3.2) < 1 ? 0.5 : 0.0; });
    scene.settings.sources = {{SourceShape::disc, SourceMaterial::water, {2, 3.2}, 0.6, {}, {{{0, 100}}}, true, {100, 0}}};
    scene.settings.sides[SIDE_EAST].kind = scene.settings.sides[SIDE_WEST].kind = SideKind::outflow;
    return scene;
}

/// Everything at once: what a number does not touch cannot tell that it is wrong.
Scene all_at_once() {
    auto scene = mixed_scene(14, 11);
    auto& material = scene.settings.material;
    material.bed_shear = 0.1;
    material.manning = 0.03;
    auto& method = scene.settings.method;
    method.largest_height = 64;
    method.bulk_viscosity = 0.3;
    scene.settings.sources = {{SourceShape::disc, SourceMaterial::water, {0.6, 0.9}, 0.5, {}, {{{0, 0.5}}}, true, {3, 0}}};
    scene.settings.rain = {{{0, 1e-3}}};
    return scene;
}

/// Next to nothing, the ends, and what lies between them by decades. Nothing where the setting is no number.
std::vector<double> ladder(const Setting& row) {
    if (row.at.kind != SettingKind::number) return {};
    const auto [least, most] = std::pair{row.values.least, row.values.most};
    std::vector<double> values = {least, most, 0.5 * most, 1e-3 * most};
    for (const double value :
         {5e-324, 1e-300, 1e-100, 1e-50, 1e-45, 1e-42, 1e-39, 1e-38, 1e-37, 1e-30, 1e-24, 1e-20, 1e-15, 1e-10, 1e-6, 1e-3})
        if (value > least && value < most) values.push_back(value);
    return values;
}

/// As messages name it: one saturation is refused for the sake of another.
std::string name_of(const Setting& row) {
    const std::string path = row.path;
    return path.substr(0, path.find('['));
}

/// What a world does wrong in a few steps, "" if nothing. One that is refused must be told by one of these fields.
std::string wrong_of(Scene scene, const std::vector<std::string>& fields) {
    const double width = scene.settings.grid.nx * scene.settings.grid.dx;
    scene.settings.sources[0].center = {0.2 * width, 0.3 * width};
    scene.settings.sources[0].radius = 0.2 * width;
    auto device = backends::open_device("cpu", -1, {});
    Status valid = validate(scene.settings);
    if (valid) valid = validate(scene.fields, scene.settings);
    auto world = valid && device ? World::create(scene.settings, scene.fields, std::move(*device)) : valid;
    if (!world) {
        const auto named = [&](const std::string& field) { return world.status().message.find(field) != std::string::npos; };
        return std::any_of(fields.begin(), fields.end(), named) ? "" : "refused: " + world.status().message;
    }
    for (int n = 1; n <= 4; ++n) {
        step(**world, 1);
        const auto stats = stats_of(**world);
        if (stats.largest_water + stats.largest_sand > 0.5 * scene.settings.method.largest_height && stats.not_finite == 0) break;
        if (!ledger_holds(**world, stats))
            return std::to_string(stats.not_finite) + " values not finite, water " +
                   std::to_string(stats.water_quanta - stats.water_initial - stats.ledger.water_in + stats.ledger.water_out) +
                   " and sand " +
                   std::to_string(stats.sand_quanta - stats.sand_initial - stats.ledger.sand_in + stats.ledger.sand_out) +
                   " quanta off after step " + std::to_string(n);
    }
    return "";
}

} // namespace

TEST_CASE("every setting from next to nothing to its end, alone and with others: finite, every quantum in the ledger, or refused "
          "by name") {
    int worlds = 0;
    std::vector<const Setting*> rows;
    for (const Setting& row : setting_table())
        if (!ladder(row).empty()) rows.push_back(&row);
    for (const Setting* row : rows) {
        for (const double value : ladder(*row)) {
            auto scene = all_at_once();
            row->at.set(scene.settings, value);
            ++worlds;
            const auto wrong = wrong_of(scene, {name_of(*row)});
            CHECK_MESSAGE(wrong.empty(), std::string(row->path) << " " << value << ": " << wrong);
        }
    }
    for (std::uint64_t seed = 0; seed < (few_steps ? 50 : 1500); ++seed) {
        fuzz::Random random(seed);
        auto scene = all_at_once();
        std::vector<std::string> fields;
        std::string text;
        for (int n = random.whole(2, 5); n > 0; --n) {
            const Setting& row = *rows[random.next() % rows.size()];
            const auto values = ladder(row);
            const double value = values[random.next() % values.size()];
            row.at.set(scene.settings, value);
            fields.push_back(name_of(row));
            text += std::string(row.path) + " " + number_text(value) + ", ";
        }
        ++worlds;
        const auto wrong = wrong_of(scene, fields);
        CHECK_MESSAGE(wrong.empty(), text << wrong);
    }
    MESSAGE(worlds, " worlds");
}

TEST_CASE("Young's modulus 0 to 1e12: a pile within its slope keeps every bit, a damp column comes to rest smooth") {
    for (const double modulus : {0.0, 1e2, 1e5, 1e9, 1e12}) {
        CAPTURE(modulus);
        auto pile = flat_scene(40, 40, 0.1, 0.009);
        pile.settings.material.young_modulus = modulus;
        pile.fill(pile.fields.sand, [](double x, double y) { return std::max(0.0, 0.8 - 0.45 * std::hypot(x - 2, y - 2)); });
        auto still = make_world(pile);
        const auto before = cells_of(*still, "sand_height");
        step(*still, 100);
        CHECK(moved(before, cells_of(*still, "sand_height"), 0.1) == 0);
        auto damp = column(0.25);
        damp.settings.material.young_modulus = modulus;
        auto world = make_world(damp);
        step(*world, 200);
        check_books(*world);
        CHECK(sand_speed(*world) < 0.02);
        CHECK(roughness(cells_of(*world, "sand_height")) <= drawn_roughness(damp));
    }
    on_every_backend(column(0.25), [](World& world) { step(world, 30); });
}

TEST_CASE("cohesion 0 to 1e12 Pa: more of it holds a column higher, and it comes to rest") {
    double height = 0;
    for (const double cohesion : {0.0, 1e-3, 1e3, 1e4, 1e8, 1e12}) {
        CAPTURE(cohesion);
        auto scene = column(0.25);
        scene.settings.material.cohesion_wet = scene.settings.material.cohesion_capillary = cohesion;
        auto world = make_world(scene);
        step(*world, 200);
        check_books(*world);
        const auto sand = cells_of(*world, "sand_height");
        CHECK(largest(sand) > height - 0.01);
        height = largest(sand);
        CHECK(sand_speed(*world) < 0.02);
        CHECK(roughness(sand) <= drawn_roughness(scene));
        // What cohesion is for. A column as wide as high keeps much of its middle without (Lube et al. 2004).
        if (cohesion == 0) CHECK(height < 0.9);
    }
    CHECK(height == 1); // as drawn
}

TEST_CASE("exchange rate 0 to 1e15: a soaked column runs out with its own energy") {
    const auto energy = [](Scene scene, double rate) {
        scene.settings.material.exchange_rate = rate;
        auto world = make_world(scene);
        const double most = worst(*world, 150, 10, kinetic_energy);
        check_books(*world);
        return most;
    };
    const auto wet = column(1.4), level = level_ground(wet);
    const double free = energy(level, 0);
    // On slopes water and sand that move as one lose less than each by itself: the measure is what they have as one.
    const double as_one = energy(wet, 1e5);
    for (const double rate : {1e2, 1e5, 1e8, 1e12, 1e15}) {
        CAPTURE(rate);
        CHECK(energy(level, rate) < 1.1 * free);
        CHECK(energy(wet, rate) < 1.1 * as_one);
    }
    auto stiff = column(1.4);
    stiff.settings.material.exchange_rate = 1e12;
    on_every_backend(stiff, [](World& world) { step(world, 30); });
}

TEST_CASE("a source of 100 m/s: nothing outruns it, no checkerboard; without the gravity cap there is one") {
    for (const double dt : {0.0005, 0.005, 0.05}) {
        CAPTURE(dt);
        on_every_backend(jet(dt), [](World& world) {
            CHECK(worst(world, 60, 20, water_checkerboard) < 0.01);
            CHECK(stats_of(world).largest_water_speed <= 100);
        });
    }
    auto bare = jet(0.05);
    bare.settings.method.gravity_cap = 0;
    CHECK(worst(*make_world(bare), 150, 10, water_checkerboard) > 0.1);
}
