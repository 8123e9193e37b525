// mark_limits by its definition: a count of faces at the clamp, of faces with capped gravity, and whether the outflow of a
// cell's layers exceeds what they hold. Where a float may fall on either side of a limit, both answers pass.
#include "tests/conformance/stage_checks.hpp"
#include <algorithm>
#include <cmath>

namespace wadi::conformance {

namespace {

struct Marks {
    const StageRun& run;

    double at(const char* binding, int i, int j) const { return static_cast<double>(run.before(binding, i, j)); }
    bool has(std::uint32_t bits) const { return (run.scene.effects & bits) == bits; }

    // Count between `least` and `most`: value > limit for sure, or perhaps.
    struct Range {
        unsigned least = 0, most = 0;
        void add(double value, double limit) {
            least += value > limit * (1 + 1e-5) ? 1 : 0;
            most += value > limit * (1 - 1e-5) ? 1 : 0;
        }
        bool holds(unsigned n) const { return n >= least && n <= most; }
    };

    double height(char layer, int i, int j) const {
        const double water = has(EFFECT_WATER) ? at("water_height", i, j) : 0,
                     sand = has(EFFECT_SAND) ? at("sand_height", i, j) : 0;
        if (layer == 's') return sand;
        const double mixed = has(EFFECT_MIXTURE) ? std::min(water, sand) : 0;
        return layer == 'm' ? mixed : water - mixed;
    }
    static std::string velocity(char layer, char axis) {
        return std::string(layer == 's' ? "sand" : layer == 'm' ? "mixed" : "water") + "_velocity_" + axis;
    }
    double u(char layer, int i, int j) const { return at(velocity(layer, 'x').c_str(), i, j); }
    double v(char layer, int i, int j) const { return at(velocity(layer, 'y').c_str(), i, j); }

    // The west and the south face: by the size of the velocity there, a hundredth of its square below the clamp's.
    void clamp(char layer, int i, int j, double limit, Range& range) const {
        const double v_west = (v(layer, i - 1, j) + v(layer, i - 1, j + 1) + v(layer, i, j) + v(layer, i, j + 1)) / 4,
                     u_south = (u(layer, i, j - 1) + u(layer, i + 1, j - 1) + u(layer, i, j) + u(layer, i + 1, j)) / 4;
        range.add(std::pow(u(layer, i, j), 2) + std::pow(v_west, 2), 0.99 * limit * limit);
        range.add(std::pow(v(layer, i, j), 2) + std::pow(u_south, 2), 0.99 * limit * limit);
    }

    void outflow(char layer, int i, int j, double k, Range& range) const {
        const double h = height(layer, i, j);
        const double out = std::max(-u(layer, i, j), 0.0) + std::max(u(layer, i + 1, j), 0.0) + std::max(-v(layer, i, j), 0.0) +
                           std::max(v(layer, i, j + 1), 0.0);
        if (h > 0) range.add(k * out * h, h);
    }

    // The two faces of cell (i, j): capped where the cap [m2/s2 per metre of depth] is below gravity.
    void gravity(int i, int j, bool sand, Range& range) const {
        const WorldParams& p = run.params;
        for (const bool y : {false, true}) {
            const bool inner = y ? j > 0 && j < p.ny && i < p.nx : i > 0 && i < p.nx && j < p.ny;
            if (!inner) continue;
            const char* name = sand ? "sand_height" : "water_height";
            const double deepest = std::max(at(name, i, j), y ? at(name, i, j - 1) : at(name, i - 1, j));
            double cap = static_cast<double>(p.sand_gravity_cap);
            if (!sand) {
                double speed = std::abs(y ? v('w', i, j) : u('w', i, j));
                if (has(EFFECT_MIXTURE)) speed = std::max(speed, std::abs(y ? v('m', i, j) : u('m', i, j)));
                const double room = std::max(static_cast<double>(LEAST_GRAVITY_CAP),
                                             static_cast<double>(p.gravity_cap_base) - static_cast<double>(p.k) * speed);
                cap = room * room * static_cast<double>(p.inv_k2);
            }
            range.add(static_cast<double>(p.gravity) * deepest, cap);
        }
    }
};

} // namespace

Verdict check_marks(const StageRun& run) {
    const Marks marks{run};
    const WorldParams& p = run.params;
    const FieldLayout layout{p.nx, p.ny};
    for (int j = 0; j <= p.ny; ++j) {
        for (int i = 0; i <= p.nx; ++i) {
            const bool cell = i < p.nx && j < p.ny;
            Marks::Range clamped, capped, limited;
            if (marks.has(EFFECT_WATER)) {
                marks.clamp('w', i, j, static_cast<double>(p.water_velocity_clamp), clamped);
                Marks::Range water;
                if (marks.has(EFFECT_MIXTURE)) marks.clamp('m', i, j, static_cast<double>(p.water_velocity_clamp), clamped);
                if (cell) marks.outflow('w', i, j, static_cast<double>(p.k), water);
                if (cell && marks.has(EFFECT_MIXTURE)) marks.outflow('m', i, j, static_cast<double>(p.k), water);
                limited.least += std::min(water.least, 1u); // one mark for both layers of water
                limited.most += std::min(water.most, 1u);
                marks.gravity(i, j, false, capped);
            }
            if (marks.has(EFFECT_SAND)) {
                marks.clamp('s', i, j, static_cast<double>(p.sand_velocity_clamp), clamped);
                if (cell) marks.outflow('s', i, j, static_cast<double>(p.ks), limited);
                marks.gravity(i, j, true, capped);
            }
            const std::uint32_t got = run.buffer("limit_marks").words()[layout.index(i, j)];
            if (clamped.holds(got & 255u) && capped.holds(got >> 8 & 255u) && limited.holds(got >> 16)) continue;
            return failed("limit_marks(" + std::to_string(i) + ", " + std::to_string(j) + ") counts " +
                          std::to_string(got & 255u) + " clamped, " + std::to_string(got >> 8 & 255u) + " capped, " +
                          std::to_string(got >> 16) + " limited; expected " + std::to_string(clamped.least) + ", " +
                          std::to_string(capped.least) + ", " + std::to_string(limited.least));
        }
    }
    return {};
}

} // namespace wadi::conformance
