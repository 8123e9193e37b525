#include "tests/conformance/values_check.hpp"
#include "engine/step/run/region.hpp"
#include "tests/conformance/stage_inputs.hpp"
#include "tests/reference/solver.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace wadi::conformance {

namespace {

constexpr std::array stretch_names = {"stretch_xx", "stretch_xy", "stretch_yy", "rotation"};

double wide(float x) { return static_cast<double>(x); }

Region region_of(const Scene& scene) {
    const auto& grid = scene.settings.grid;
    const int i0 = grid.nx > 4 ? 1 : 0, j0 = grid.ny > 4 ? 2 : 0;
    return {i0, j0, grid.nx > 6 ? grid.nx - i0 - 2 : grid.nx - i0, grid.ny - j0};
}

// One that the mask has; the cases of a stage meet all of them.
int layer_of(const Scene& scene) {
    std::vector<int> layers = {LAYER_TERRAIN};
    if ((scene.effects & EFFECT_WATER) != 0) layers.push_back(LAYER_WATER);
    if ((scene.effects & EFFECT_SAND) != 0) layers.insert(layers.end(), 2, LAYER_SAND); // the one that has most to do
    const auto number = static_cast<unsigned>(scene.settings.grid.nx + scene.settings.grid.ny + std::popcount(scene.effects));
    return layers[number % layers.size()];
}

template <class Real> struct Cell {
    Real terrain, sand, water, stretch[4];
    double in = 0, out = 0, refused = 0; // [m]
};

// What becomes of one cell, exact in double where heights are whole quanta.
template <class Real> class Definition {
  public:
    explicit Definition(const StageRun& run)
        : run_(run), region_(region_of(run.scene)), layer_(layer_of(run.scene)), values_(values_of_cases(run.scene)),
          solver_(run.scene.settings, run.scene.effects) {}

    Cell<Real> at(int i, int j) const {
        const auto before = [&](const char* name) { return static_cast<Real>(run_.before(name, i, j)); };
        Cell<Real> cell{before("terrain"), before("sand_height"), before("water_height"), {}};
        for (std::size_t n = 0; n < 4; ++n) cell.stretch[n] = before(stretch_names[n]);
        const int a = i - region_.i0, b = j - region_.j0;
        if (a >= 0 && b >= 0 && a < region_.nx && b < region_.ny)
            write(values_[static_cast<std::size_t>(b * region_.nx + a)], cell);
        return cell;
    }

  private:
    Real whole(Real height, Real (*round)(Real)) const {
        const auto quantum = static_cast<Real>(run_.params.quantum);
        return quantum > 0 ? round(height / quantum) * quantum : height;
    }

    void write(float given, Cell<Real>& cell) const {
        const auto largest = static_cast<Real>(run_.params.largest_height);
        const bool terrain = layer_ == LAYER_TERRAIN, sand = layer_ == LAYER_SAND;
        Real& held = terrain ? cell.terrain : sand ? cell.sand : cell.water;
        if (!std::isfinite(given)) {
            cell.refused = static_cast<double>(largest);
            return;
        }
        const Real others = terrain ? cell.sand + cell.water : sand ? cell.terrain + cell.water : cell.terrain + cell.sand;
        const Real wanted = whole(std::clamp(static_cast<Real>(given), -2 * largest, 2 * largest), std::nearbyint);
        const Real least = terrain ? -whole(largest, std::floor) : 0;
        const Real height = std::max(std::min(wanted, whole(std::min(largest, largest - others), std::floor)), least);
        cell.refused = static_cast<double>(std::abs(wanted - height));
        if (!terrain) (height > held ? cell.in : cell.out) = static_cast<double>(std::abs(height - held));
        if (sand) strain(cell, height);
        held = height;
    }

    void strain(Cell<Real>& cell, Real height) const {
        const Real keep = height > cell.sand ? cell.sand / height : Real(1);
        const Real before = solver_.balance(cell.sand, cell.water), after = solver_.balance(height, cell.water);
        for (const std::size_t n : {0u, 2u}) cell.stretch[n] = after + keep * (cell.stretch[n] - before);
        for (const std::size_t n : {1u, 3u}) cell.stretch[n] *= keep;
    }

    const StageRun& run_;
    const Region region_;
    const int layer_;
    const std::vector<float> values_;
    const reference::Solver<Real> solver_; // for its material
};

template <class Real> Real value_of(const Cell<Real>& cell, const std::string& name) {
    for (std::size_t n = 0; n < 4; ++n)
        if (name == stretch_names[n]) return cell.stretch[n];
    return name == "terrain" ? cell.terrain : name == "sand_height" ? cell.sand : cell.water;
}

Verdict check_field(const StageRun& run, const std::string& name) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    const Definition<float> narrow(run);
    const Definition<double> exact(run);
    std::vector<float> near(layout.size(), 0.0F), bits(layout.size(), 0.0F);
    std::vector<double> far(layout.size(), 0.0);
    const auto range = written_range("write_values", name, run.params);
    for (int j = range.j0; j < range.j1; ++j) {
        for (int i = range.i0; i < range.i1; ++i) {
            const int a = std::clamp(i, 0, layout.nx - 1), b = std::clamp(j, 0, layout.ny - 1);
            const std::size_t at = layout.index(i, j);
            near[at] = value_of(narrow.at(a, b), name);
            far[at] = value_of(exact.at(a, b), name);
            bits[at] = static_cast<float>(far[at]);
        }
    }
    const auto got = run.buffer(name.c_str()).floats();
    const bool height = name == "terrain" || name.ends_with("_height");
    if (height && run.params.quantum > 0) return compare_bits(name, got, bits, layout, range);
    // Strain: that in balance, which is taken and given anew, is known to an iteration's last bits.
    return compare_fields({{name, range, got, near, far, {}}}, layout, height ? 0.0 : 5e-7);
}

Verdict check_ledger(const StageRun& run) {
    const WorldParams& p = run.params;
    const auto row = static_cast<std::size_t>(p.strips * p.pitch);
    const BenchBuffer& ledger = run.buffer("source_ledger");
    const Definition<double> exact(run);
    const bool sand = layer_of(run.scene) == LAYER_SAND;
    for (int strip = 0; strip < p.strips; ++strip) {
        for (int i = 0; i < p.pitch; ++i) {
            double expected[LEDGER_ENTRIES] = {};
            for (int j = strip * STRIP; i < p.nx && j < std::min((strip + 1) * STRIP, p.ny); ++j) {
                const auto cell = exact.at(i, j);
                expected[sand ? LEDGER_SAND_IN : LEDGER_WATER_IN] += cell.in;
                expected[sand ? LEDGER_SAND_OUT : LEDGER_WATER_OUT] += cell.out;
                expected[LEDGER_REFUSED] += cell.refused;
            }
            for (std::size_t n = 0; n < LEDGER_ENTRIES; ++n) {
                const std::size_t low = 2 * n * row + static_cast<std::size_t>(strip * p.pitch + i), high = low + row;
                const auto count = [](std::uint32_t l, std::uint32_t h) { return std::uint64_t{l} + (std::uint64_t{h} << 32); };
                const auto grown = static_cast<double>(count(ledger.words()[low], ledger.words()[high]) -
                                                       count(ledger.before[low], ledger.before[high]));
                const double quanta = expected[n] * wide(p.inv_ledger_quantum);
                // Amounts of more than 2^24 quanta, which no cell can hold, are refused to the nearest float.
                const bool rounds = p.quantum <= 0.0F || n == LEDGER_REFUSED;
                const double slack = rounds ? (p.quantum > 0.0F ? 0 : quanta * 1e-5) + (i < p.nx ? STRIP : 0) : 0;
                if (!(std::abs(grown - quanta) <= slack))
                    return failed("ledger entry " + std::to_string(n) + " of column " + std::to_string(i) + ", strip " +
                                  std::to_string(strip) + " grew by " + std::to_string(grown) + " quanta, expected " +
                                  std::to_string(quanta) + " +- " + std::to_string(slack));
            }
        }
    }
    return {};
}

} // namespace

void add_values(const Scene& scene, StepInput& input) {
    const Region region = region_of(scene);
    cover(region, input.edit[0]);
    input.edit[0].layer = layer_of(scene);
}

std::vector<float> values_of_cases(const Scene& scene) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const auto most = static_cast<float>(scene.settings.method.largest_height);
    const std::array odd = {std::numeric_limits<float>::quiet_NaN(), infinite, -infinite, -0.3F, 3e38F, -3e38F, 1.5F * most};
    const double quantum = height_quantum(scene.settings.method);
    std::vector<float> values(region_of(scene).cells());
    for (std::size_t n = 0; n < values.size(); ++n) {
        const double height = 0.021 * static_cast<double>(n % 53), quarters = 0.25 * static_cast<double>(n % 5);
        values[n] =
            quantum > 0 ? static_cast<float>((std::floor(height / quantum) + quarters) * quantum) : static_cast<float>(height);
        if (n % 3 == 1) values[n] = odd[n / 3 % odd.size()];
    }
    return values;
}

Verdict check_values(const StageRun& run) {
    Verdict verdict = check_ledger(run);
    for (const auto& binding : run.stage.bindings) {
        const std::string name(binding.name);
        const bool field = binding.access == compute::Access::inout && name != "source_ledger";
        if (verdict.outcome != Outcome::ok) return verdict;
        if (field && run.buffer(name.c_str()).exists) verdict = worse(verdict, check_field(run, name));
    }
    return verdict;
}

} // namespace wadi::conformance
