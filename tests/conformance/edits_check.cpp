#include "tests/conformance/edits_check.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/stage_inputs.hpp"
#include "tests/reference/solver.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace wadi::conformance {

namespace {

double wide(float x) { return static_cast<double>(x); }

// A length in cells as edits keep it, in metres.
double metres(double cells, const Grid& grid) { return std::nearbyint(cells * 256) / 256 * grid.dx; }

// The state of one cell and its west and south faces, edited one edit after the other.
template <class Real> struct Cell {
    Real terrain, sand, water, stretch[4];
    Real velocity[6]; // water, mixed, sand; x and y each
    double counts[LEDGER_ENTRIES] = {};
};

constexpr std::array velocity_names = {"water_velocity_x", "water_velocity_y", "mixed_velocity_x",
                                       "mixed_velocity_y", "sand_velocity_x",  "sand_velocity_y"};
constexpr std::array stretch_names = {"stretch_xx", "stretch_xy", "stretch_yy", "rotation"};

template <class Real> class Definition {
  public:
    Definition(const StageRun& run, std::span<const Edit> edits)
        : run_(run), edits_(edits), stamp_(stamp_of_cases()), solver_(run.scene.settings, run.scene.effects) {}

    Cell<Real> at(int i, int j) const {
        Cell<Real> cell{};
        const auto before = [&](const char* name) { return static_cast<Real>(run_.before(name, i, j)); };
        cell.terrain = before("terrain");
        cell.sand = before("sand_height");
        cell.water = before("water_height");
        for (std::size_t n = 0; n < 4; ++n) cell.stretch[n] = before(stretch_names[n]);
        for (std::size_t n = 0; n < 6; ++n) cell.velocity[n] = before(velocity_names[n]);
        for (const Edit& edit : edits_) edit.kind == EditKind::push ? push(edit, i, j, cell) : change(edit, i, j, cell);
        return cell;
    }

  private:
    bool has(std::uint32_t effects) const { return (run_.scene.effects & effects) != 0; }

    // 1 at the shape's middle line, 0 at its radius and beyond.
    Real weight(const Edit& edit, double i, double j) const {
        const double dx = run_.scene.settings.grid.dx;
        const Real x = static_cast<Real>(i * dx - edit.x0), y = static_cast<Real>(j * dx - edit.y0);
        const Real lx = edit.capsule ? static_cast<Real>(edit.x1 - edit.x0) : 0,
                   ly = edit.capsule ? static_cast<Real>(edit.y1 - edit.y0) : 0;
        const Real length2 = lx * lx + ly * ly;
        const Real t = length2 > 0 ? std::clamp((x * lx + y * ly) / length2, Real(0), Real(1)) : Real(0);
        const Real distance = std::hypot(x - t * lx, y - t * ly), radius = static_cast<Real>(edit.radius);
        if (distance >= radius) return 0;
        if (edit.softness <= 0) return 1;
        const Real s = std::min(Real(1), (radius - distance) / static_cast<Real>(edit.softness * edit.radius));
        return s * s * (3 - 2 * s);
    }

    // Share of the cell within a hard rim (NUMERICS 2.10), lengths in cells: in squares of side h, beyond a straight edge.
    Real share(const Edit& edit, int i, int j) const {
        const double dx = run_.scene.settings.grid.dx;
        const Real radius = static_cast<Real>(edit.radius / dx * (1 - edit.softness / 2));
        const int parts = radius < 2 ? 8 : 1;
        const Real h = Real(1) / static_cast<Real>(parts);
        const Real lx = edit.capsule ? static_cast<Real>((edit.x1 - edit.x0) / dx) : 0,
                   ly = edit.capsule ? static_cast<Real>((edit.y1 - edit.y0) / dx) : 0;
        Real sum = 0;
        for (int part = 0; part < parts * parts; ++part) {
            const Real x = static_cast<Real>(i + (part % parts + 0.5) / parts - edit.x0 / dx),
                       y = static_cast<Real>(j + (part / parts + 0.5) / parts - edit.y0 / dx);
            const Real along = lx != 0 || ly != 0 ? (x * lx + y * ly) / (lx * lx + ly * ly) : Real(0);
            const Real t = std::clamp(along, Real(0), Real(1)), px = x - t * lx, py = y - t * ly;
            const Real distance = std::hypot(px, py);
            const Real inside = radius - (t == along && t > 0 && t < 1 ? distance : std::sqrt(px * px + py * py + h * h / 12));
            const Real cx = distance > 0 ? std::abs(px) / distance * h : Real(0),
                       cy = distance > 0 ? std::abs(py) / distance * h : Real(0);
            const auto [least, most] = std::minmax(cx, cy);
            const Real left = (cx + cy) / 2 - std::abs(inside);
            const Real tail = left <= 0 ? Real(0) : left < least ? left * left / (2 * cx * cy) : (left - least / 2) / most;
            sum += std::floor((inside > 0 ? 1 - tail : tail) * 262144 + Real(0.5)) / 262144; // whole 2^-18
        }
        return sum * h * h;
    }

    // Mean over the cell of the image, 0 counting outside its rectangle.
    Real stamped(const Edit& edit, int i, int j) const {
        const double dx = run_.scene.settings.grid.dx;
        const double west = std::max(i * dx, edit.x0), east = std::min((i + 1) * dx, edit.x1);
        const double south = std::max(j * dx, edit.y0), north = std::min((j + 1) * dx, edit.y1);
        if (east <= west || north <= south) return 0;
        const auto places = [&](int pixels, double extent) {
            return std::clamp(static_cast<int>(std::ceil(pixels * dx / extent)), 1, 8);
        };
        const int columns = places(stamp_.nx, edit.x1 - edit.x0), rows = places(stamp_.ny, edit.y1 - edit.y0);
        Real sum = 0;
        for (int q = 0; q < rows; ++q)
            for (int p = 0; p < columns; ++p)
                sum += image(edit, west + (p + 0.5) / columns * (east - west), south + (q + 0.5) / rows * (north - south));
        return sum / static_cast<Real>(columns * rows) * static_cast<Real>((east - west) * (north - south) / (dx * dx));
    }

    Real image(const Edit& edit, double x, double y) const {
        const Real u = static_cast<Real>((x - edit.x0) / (edit.x1 - edit.x0)),
                   v = static_cast<Real>((y - edit.y0) / (edit.y1 - edit.y0));
        const auto pixel = [&](int a, int b) {
            a = std::clamp(a, 0, stamp_.nx - 1);
            b = std::clamp(b, 0, stamp_.ny - 1);
            return static_cast<Real>(stamp_.values[static_cast<std::size_t>(b * stamp_.nx + a)]);
        };
        const Real px = u * static_cast<Real>(stamp_.nx) - Real(0.5), py = v * static_cast<Real>(stamp_.ny) - Real(0.5);
        const int a = static_cast<int>(std::floor(px)), b = static_cast<int>(std::floor(py));
        const Real fx = px - static_cast<Real>(a), fy = py - static_cast<Real>(b);
        return (pixel(a, b) * (1 - fx) + pixel(a + 1, b) * fx) * (1 - fy) +
               (pixel(a, b + 1) * (1 - fx) + pixel(a + 1, b + 1) * fx) * fy;
    }

    void change(const Edit& edit, int i, int j, Cell<Real>& cell) const {
        const Real amount = static_cast<Real>(edit.amount), most = static_cast<Real>(run_.params.largest_height);
        const bool hard = edit.softness * edit.radius < run_.scene.settings.grid.dx;
        Real wanted = amount * (edit.kind == EditKind::stamp ? stamped(edit, i, j)
                                : hard                       ? share(edit, i, j)
                                                             : weight(edit, i + 0.5, j + 0.5));
        const Real quantum = static_cast<Real>(run_.params.quantum);
        if (quantum > 0) wanted = std::round(wanted / quantum) * quantum;
        const bool terrain = edit.layer == EditLayer::terrain, sand = edit.layer == EditLayer::sand;
        if (!terrain && !has(sand ? EFFECT_SAND : EFFECT_WATER) && amount < 0) return;
        Real& height = terrain ? cell.terrain : sand ? cell.sand : cell.water;
        const Real room = std::max(Real(0), most - std::max(cell.terrain + cell.sand + cell.water, height));
        const Real changed = std::clamp(wanted, terrain ? -most - height : -height, room);
        const Real refused = terrain ? std::abs(wanted - changed) : std::max(wanted - changed, Real(0));
        const auto quanta = [&](Real depth) { return static_cast<double>(depth) * wide(run_.params.inv_ledger_quantum); };
        cell.counts[LEDGER_REFUSED] += quanta(refused);
        if (terrain) {
            height += changed;
            return;
        }
        if (!has(sand ? EFFECT_SAND : EFFECT_WATER)) return;
        const int in = sand ? LEDGER_SAND_IN : LEDGER_WATER_IN; // the entry behind it counts what went out
        cell.counts[changed > 0 ? in : in + 1] += quanta(std::abs(changed));
        if (sand && changed != 0) {
            // What is added or taken leaves sand in balance that was in balance (NUMERICS 2.20).
            const Real keep = changed > 0 ? height / (height + changed) : Real(1);
            const Real before = solver_.balance(height, cell.water), after = solver_.balance(height + changed, cell.water);
            for (const std::size_t n : {0u, 2u}) cell.stretch[n] = after + keep * (cell.stretch[n] - before);
            for (const std::size_t n : {1u, 3u}) cell.stretch[n] *= keep;
        }
        height += changed;
    }

    void push(const Edit& edit, int i, int j, Cell<Real>& cell) const {
        const WorldParams& p = run_.params;
        for (std::size_t n = 0; n < 6; ++n) {
            const bool y = n % 2 == 1;
            if (y ? j == 0 || j >= p.ny || i >= p.nx : i == 0 || i >= p.nx || j >= p.ny) continue;
            const Real limit = static_cast<Real>(n < 4 ? p.water_velocity_clamp : p.sand_velocity_clamp);
            const Real w = static_cast<Real>(edit.strength) * (y ? weight(edit, i + 0.5, j) : weight(edit, i, j + 0.5));
            if (!(w > 0)) continue;
            const Real target = static_cast<Real>(y ? edit.velocity_y : edit.velocity_x);
            cell.velocity[n] = std::clamp(cell.velocity[n] + w * (target - cell.velocity[n]), -limit, limit);
        }
    }

    const StageRun& run_;
    std::span<const Edit> edits_;
    const Stamp stamp_;
    const reference::Solver<Real> solver_; // for its material
};

template <class Real> Real value_of(const Cell<Real>& cell, const std::string& name) {
    for (std::size_t n = 0; n < 6; ++n)
        if (name == velocity_names[n]) return cell.velocity[n];
    for (std::size_t n = 0; n < 4; ++n)
        if (name == stretch_names[n]) return cell.stretch[n];
    return name == "terrain" ? cell.terrain : name == "sand_height" ? cell.sand : cell.water;
}

Verdict check_fields(const StageRun& run, std::span<const Edit> edits) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    const Definition<float> narrow(run, edits);
    const Definition<double> exact(run, edits);
    Verdict verdict;
    for (const auto& binding : run.stage.bindings) {
        const std::string name(binding.name);
        if (binding.access != compute::Access::inout || name == "source_ledger" || !run.buffer(name.c_str()).exists) continue;
        std::vector<float> near(layout.size(), 0.0F);
        std::vector<double> far(layout.size(), 0.0);
        const bool ground = name == "terrain";
        const auto range = written_range("apply_edits", name, run.params);
        for (int j = range.j0; j < range.j1; ++j) {
            for (int i = range.i0; i < range.i1; ++i) {
                const int a = ground ? std::clamp(i, 0, layout.nx - 1) : i, b = ground ? std::clamp(j, 0, layout.ny - 1) : j;
                near[layout.index(i, j)] = value_of(narrow.at(a, b), name);
                far[layout.index(i, j)] = value_of(exact.at(a, b), name);
            }
        }
        FieldCheck check{name, range, run.buffer(name.c_str()).floats(), near, far, {}};
        const bool height = ground || name.ends_with("_height");
        // Strain: that in balance, which each edit takes and gives anew, is known to an iteration's last bits.
        const bool strain = std::find(stretch_names.begin(), stretch_names.end(), name) != stretch_names.end();
        const double each = height ? wide(run.params.quantum) : strain ? 5e-7 : 0.0;
        const double quanta = static_cast<double>(edits.size()) * each;
        verdict = worse(verdict, compare_fields({check}, layout, quanta));
    }
    return verdict;
}

// Whole quanta that the depths of a column's strip hold, from the words of a buffer.
double quanta_in(const StageRun& run, std::span<const float> field, int i, int strip) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    double sum = 0;
    for (int j = strip * STRIP; i < layout.nx && j < std::min((strip + 1) * STRIP, layout.ny); ++j)
        sum += wide(field[layout.index(i, j)]) * wide(run.params.inv_ledger_quantum);
    return sum;
}

std::span<const float> as_floats(const std::vector<std::uint32_t>& words) {
    return {reinterpret_cast<const float*>(words.data()), words.size()};
}

Verdict check_ledger(const StageRun& run, std::span<const Edit> edits) {
    const WorldParams& p = run.params;
    const auto row = static_cast<std::size_t>(p.strips * p.pitch);
    const BenchBuffer& ledger = run.buffer("source_ledger");
    const Definition<double> exact(run, edits);
    const auto grown = [&](int entry, std::size_t at) {
        const std::size_t low = static_cast<std::size_t>(2 * entry) * row + at, high = low + row;
        const auto count = [](std::uint32_t l, std::uint32_t h) { return std::uint64_t{l} + (std::uint64_t{h} << 32); };
        return static_cast<double>(count(ledger.words()[low], ledger.words()[high]) -
                                   count(ledger.before[low], ledger.before[high]));
    };
    for (int strip = 0; strip < p.strips; ++strip) {
        for (int i = 0; i < p.pitch; ++i) {
            const auto at = static_cast<std::size_t>(strip * p.pitch + i);
            const std::string place = " of column " + std::to_string(i) + ", strip " + std::to_string(strip);
            double expected[LEDGER_ENTRIES] = {};
            for (int j = strip * STRIP; i < p.nx && j < std::min((strip + 1) * STRIP, p.ny); ++j) {
                const auto cell = exact.at(i, j);
                for (int n = 0; n < LEDGER_ENTRIES; ++n) expected[n] += cell.counts[n];
            }
            for (int n = 0; n < LEDGER_ENTRIES; ++n) {
                const double slack = expected[n] * 1e-5 + (i < p.nx ? STRIP : 0) * static_cast<double>(edits.size());
                if (!(std::abs(grown(n, at) - expected[n]) <= slack))
                    return failed("ledger entry " + std::to_string(n) + place + " grew by " + std::to_string(grown(n, at)) +
                                  " quanta, expected " + std::to_string(expected[n]) + " +- " + std::to_string(slack));
            }
            for (const char* name : {"water_height", "sand_height"}) {
                const bool water = name[0] == 'w';
                const double net =
                    grown(water ? LEDGER_WATER_IN : LEDGER_SAND_IN, at) - grown(water ? LEDGER_WATER_OUT : LEDGER_SAND_OUT, at);
                const BenchBuffer& field = run.buffer(name);
                const double change =
                    field.exists ? quanta_in(run, field.floats(), i, strip) - quanta_in(run, as_floats(field.before), i, strip)
                                 : 0;
                // Plain floats: each amount was rounded to a quantum of its own.
                const double slack =
                    p.quantum > 0.0F ? 0 : std::abs(change) * 1e-5 + (i < p.nx ? STRIP : 0) * static_cast<double>(edits.size());
                if (!(std::abs(net - change) <= slack))
                    return failed(std::string(name) + place + " changed by " + std::to_string(change) +
                                  " quanta, its ledger by " + std::to_string(net));
            }
        }
    }
    return {};
}

} // namespace

std::vector<Edit> edits_of(const Scene& scene) {
    const auto& grid = scene.settings.grid;
    const double most = scene.settings.method.largest_height, narrow = std::min(grid.nx, grid.ny);
    const auto place = [&](Edit& edit, double u0, double v0, double u1, double v1) {
        edit.x0 = metres(u0 * grid.nx + 0.17, grid);
        edit.y0 = metres(v0 * grid.ny + 0.31, grid);
        edit.x1 = metres(u1 * grid.nx + 0.23, grid);
        edit.y1 = metres(v1 * grid.ny + 0.29, grid);
    };
    std::vector<Edit> edits;
    const auto add = [&](EditKind kind, EditLayer layer, bool capsule, double amount, double cells, double softness) -> Edit& {
        Edit edit;
        edit.kind = kind;
        edit.layer = layer;
        edit.capsule = capsule;
        edit.amount = edit.strength = amount;
        edit.radius = metres(cells, grid) + 0.003 * grid.dx;
        edit.softness = softness;
        edit.velocity_x = 0.7;
        edit.velocity_y = -0.4;
        edit.stamp = kind == EditKind::stamp ? 1 : 0;
        return edits.emplace_back(edit);
    };
    const auto brush = EditKind::brush, stamp = EditKind::stamp, push = EditKind::push;
    place(add(brush, EditLayer::sand, false, 0.17, 0.3 * narrow + 0.6, 0.6), 0.4, 0.5, 0, 0);
    place(add(brush, EditLayer::water, true, -0.11, 0.2 * narrow + 0.4, 1), 0.1, 0.2, 0.9, 0.7);
    place(add(brush, EditLayer::terrain, false, 0.3, 0.4 * narrow + 1.1, 0.3), 0, 0, 0, 0);
    place(add(brush, EditLayer::terrain, true, -2 * most, 1.37, 0), 0.8, 1.05, 1.2, 0.9); // lower than may be
    place(add(brush, EditLayer::water, false, 1.5 * most, 1.37, 0), 0.5, 0.5, 0, 0);      // higher than may be
    place(add(brush, EditLayer::sand, true, -3, 1.61, 0.5), 0.3, 0.9, 0.35, 0.4);
    place(add(stamp, EditLayer::sand, false, 0.2, 1, 0), 0.2, -0.2, 0.75, 0.6);
    place(add(stamp, EditLayer::water, false, -0.3, 1, 0), 0.4, 0.3, 1.3, 0.8);
    place(add(stamp, EditLayer::terrain, false, 0.1, 1, 0), 0, 0.5, 0.6, 1);
    place(add(push, EditLayer::terrain, true, 0.6, 0.25 * narrow + 0.7, 0.7), 0.2, 0.3, 0.8, 0.4);
    place(add(push, EditLayer::terrain, false, 1, 2.61, 0), 0.9, 0.9, 0, 0);
    return edits;
}

Stamp stamp_of_cases() {
    Stamp stamp{5, 4, {}, 0, 0, 0};
    for (int n = 0; n < 20; ++n) stamp.values.push_back(band_limited(31, n % 5, n / 5));
    return stamp;
}

void add_edits(const Scene& scene, StepInput& input) {
    const std::vector<Stamp> stamps = {stamp_of_cases()};
    for (const Edit& edit : edits_of(scene)) {
        if (pack_edit(edit, stamps, scene.settings.grid, input.edit[input.edit_count])) ++input.edit_count;
    }
}

Verdict check_edits(const StageRun& run) {
    const auto edits = edits_of(run.scene);
    const Verdict ledger = check_ledger(run, edits);
    return ledger.outcome == Outcome::ok ? check_fields(run, edits) : ledger;
}

} // namespace wadi::conformance
