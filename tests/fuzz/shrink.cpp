// Greedy: whatever can go without the failure going stays away.
#include "engine/settings/data/setting_table.hpp"
#include "tests/fuzz/checks.hpp"
#include <chrono>
#include <functional>

namespace wadi::fuzz {

namespace {

using Change = std::function<bool(Case&)>; // false: there is nothing to change

std::vector<float> crop(const std::vector<float>& field, const Grid& old, int i0, int j0, int nx, int ny) {
    std::vector<float> part;
    if (field.empty()) return part;
    for (int j = j0; j < j0 + ny; ++j)
        for (int i = i0; i < i0 + nx; ++i)
            part.push_back(field[static_cast<std::size_t>(j) * static_cast<std::size_t>(old.nx) + static_cast<std::size_t>(i)]);
    return part;
}

void move(Case& c, double x, double y) {
    for (Edit& edit : c.commands) edit.x0 -= x, edit.x1 -= x, edit.y0 -= y, edit.y1 -= y;
    for (Source& source : c.scene.settings.sources) {
        source.center[0] -= x;
        source.center[1] -= y;
        source.box = {source.box[0] - x, source.box[1] - y, source.box[2] - x, source.box[3] - y};
    }
}

// Keeps one half, along x or y, the low or the high one.
bool halve(Case& c, bool along_y, bool high) {
    const Grid old = c.scene.settings.grid;
    Grid& grid = c.scene.settings.grid;
    int& cells = along_y ? grid.ny : grid.nx;
    if (cells < 2) return false;
    const int half = (cells + 1) / 2, first = high ? cells - half : 0;
    cells = half;
    auto& f = c.scene.fields;
    for (auto* field : {&f.terrain, &f.sand, &f.water, &f.velocity_x, &f.velocity_y, &f.sand_velocity_x, &f.sand_velocity_y,
                        &c.scene.settings.roughness, &c.scene.settings.rain_map})
        *field = crop(*field, old, along_y ? 0 : first, along_y ? first : 0, grid.nx, grid.ny);
    move(c, along_y ? 0 : first * grid.dx, along_y ? first * grid.dx : 0);
    for (Side& side : c.scene.settings.sides) side.from = 0, side.to = 1e30;
    return true;
}

template <class T> bool drop(std::vector<T>& list, std::size_t first, std::size_t count) {
    if (first >= list.size()) return false;
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first);
    list.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(count, list.size() - first)));
    return true;
}

template <class T> bool reset(T& value, const T& normal) {
    if (value == normal) return false;
    value = normal;
    return true;
}

bool clear(std::vector<float>& field) {
    if (field.empty()) return false;
    field.clear();
    return true;
}

bool flatten(std::vector<float>& field) {
    if (field.empty()) return false;
    float most = 0;
    bool flat = true;
    for (const float h : field) {
        flat = flat && h == field[0];
        most = std::max(most, h);
    }
    field.assign(field.size(), most);
    return !flat;
}

std::vector<Change> changes() {
    std::vector<Change> list;
    for (const bool along_y : {false, true})
        for (const bool high : {false, true}) list.push_back([=](Case& c) { return halve(c, along_y, high); });
    list.push_back([](Case& c) { return drop(c.commands, 0, c.commands.size()); });
    for (std::size_t n = 0; n < 8; ++n) list.push_back([n](Case& c) { return drop(c.commands, n, 1); });
    list.push_back([](Case& c) { return c.steps > 1 && (c.steps = (c.steps + 1) / 2) > 0; });
    list.push_back([](Case& c) { return c.steps > 1 && --c.steps > 0; });
    for (std::size_t n = 0; n < 3; ++n) list.push_back([n](Case& c) { return drop(c.scene.settings.sources, n, 1); });
    list.push_back([](Case& c) { return reset(c.scene.settings.rain.samples, {}); });
    list.push_back([](Case& c) { return reset(c.scene.settings.evaporation.samples, {}); });
    for (std::size_t n = 0; n < 4; ++n)
        list.push_back([n](Case& c) {
            const bool open = c.scene.settings.sides[n].kind != SideKind::wall;
            c.scene.settings.sides[n] = {};
            return open;
        });
    list.push_back([](Case& c) { return clear(c.scene.fields.sand); });
    list.push_back([](Case& c) { return clear(c.scene.fields.water); });
    list.push_back([](Case& c) { return clear(c.scene.fields.terrain); });
    list.push_back([](Case& c) { return clear(c.scene.fields.velocity_x) && clear(c.scene.fields.velocity_y); });
    list.push_back([](Case& c) { return clear(c.scene.fields.sand_velocity_x) && clear(c.scene.fields.sand_velocity_y); });
    list.push_back([](Case& c) { return clear(c.scene.settings.roughness); });
    list.push_back([](Case& c) { return clear(c.scene.settings.rain_map); });
    list.push_back([](Case& c) { return flatten(c.scene.fields.sand); });
    list.push_back([](Case& c) { return flatten(c.scene.fields.water); });
    list.push_back([](Case& c) { return flatten(c.scene.fields.terrain); });
    for (const Setting& row : setting_table())
        if (!row.required())
            list.push_back([&row](Case& c) {
                if (row.at.get(c.scene.settings) == row.normal()) return false;
                row.at.set(c.scene.settings, row.normal());
                return true;
            });
    list.push_back([](Case& c) { return reset(c.scene.settings.method.name, Method().name); });
    // Whole effects: what is forced off needs what depends on it off as well.
    for (const char* name : {"rain_map", "roughness", "retention", "internal_friction", "slope_normal", "bed_shear",
                             "bed_friction", "cohesion", "elastoplastic", "diffusion", "drag", "mixture"})
        list.push_back([name](Case& c) {
            for (const auto& [known, force] : c.scene.settings.effects)
                if (known == name) return false;
            c.scene.settings.effects.emplace_back(name, Force::off);
            return true;
        });
    return list;
}

} // namespace

Case shrink(Case c, const std::string& check, Devices& devices, Weaken weaken, double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    const auto list = changes();
    for (bool smaller = true; smaller && Clock::now() < end;) {
        smaller = false;
        for (const auto& change : list) {
            // Again and again while it helps: a grid can be halved several times.
            while (Clock::now() < end) {
                Case candidate = c;
                if (!change(candidate) || run_case(candidate, devices, weaken, check).check != check) break;
                c = candidate;
                smaller = true;
            }
        }
    }
    return c;
}

} // namespace wadi::fuzz
