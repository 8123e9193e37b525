// Published fields by their definitions, in both precisions: single cells, the flow map, foam, normals, the smoothed surface and
// the interpolation between two publishes.
#include "tests/conformance/half.hpp"
#include "tests/conformance/stage_checks.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace wadi::conformance {

namespace {

template <class Real> using Components = std::array<Real, 4>;

template <class Real> struct Publisher {
    const StageRun& run;

    Real in(const char* binding, int i, int j) const { return static_cast<Real>(run.before(binding, i, j)); }
    Real param(float value) const { return static_cast<Real>(value); }
    Real water(int i, int j) const { return standing_water<Real>(run, i, j); }
    Real sand(int i, int j) const { return in("sand_height", i, j); }
    Real depth(int i, int j) const { return std::max(water(i, j) - sand(i, j), Real(0)); }
    // The rim repeats its cells.
    Real surface(int i, int j) const {
        const int a = std::clamp(i, 0, run.params.nx - 1), b = std::clamp(j, 0, run.params.ny - 1);
        return in("terrain", a, b) + std::max(water(a, b), sand(a, b));
    }
    Components<Real> centre(const char* x, const char* y, int i, int j) const {
        return {(in(x, i, j) + in(x, i + 1, j)) / 2, (in(y, i, j) + in(y, i, j + 1)) / 2};
    }

    Real foam(int i, int j) const {
        if ((run.scene.effects & EFFECT_FOAM) != 0) return std::min(in("surface_foam", i, j), Real(1));
        const Real h = depth(i, j), g = param(run.params.gravity), dx = param(run.params.dx);
        if (!(h > param(run.params.dry_threshold))) return 0;
        const auto [u, v, none, nothing] = centre("water_velocity_x", "water_velocity_y", i, j);
        const Real divergence = (in("water_velocity_x", i + 1, j) - in("water_velocity_x", i, j) +
                                 in("water_velocity_y", i, j + 1) - in("water_velocity_y", i, j)) /
                                dx;
        const auto unit = [](Real x) { return std::clamp(x, Real(0), Real(1)); };
        const Real wave = std::sqrt(g * h);
        const Real jet = wave > 0 ? ((u * u + v * v) / (wave * wave) - 1) / 3 : Real(0);
        const Real front = wave > 0 ? (-h * divergence / wave - Real(0.15)) / Real(0.5) : Real(0);
        return std::max(unit(jet), unit(front)) * unit(10 * h / dx);
    }
    Components<Real> normal(int i, int j) const {
        const auto slope = [&](int low_i, int low_j, int high_i, int high_j, bool both_sides) {
            return (surface(high_i, high_j) - surface(low_i, low_j)) / (param(run.params.dx) * (both_sides ? 2 : 1));
        };
        const Real x = slope(i - 1, j, i + 1, j, i > 0 && i + 1 < run.params.nx);
        const Real y = slope(i, j - 1, i, j + 1, j > 0 && j + 1 < run.params.ny);
        const Real size = std::sqrt(1 + x * x + y * y);
        return {-x / size, -y / size, 1 / size, 0};
    }
    Real saturation(int i, int j) const {
        const bool dry = !(sand(i, j) > param(run.params.dry_threshold));
        return dry ? Real(0) : water(i, j) / (water(i, j) + sand(i, j));
    }
    Real smooth(int i, int j) const {
        Real sum = 0;
        for (int b = -1; b <= 1; ++b)
            for (int a = -1; a <= 1; ++a) sum += static_cast<Real>((2 - std::abs(a)) * (2 - std::abs(b))) * surface(i + a, j + b);
        return sum / 16;
    }

    Components<Real> value(const std::string& name, int i, int j) const {
        if (name == "centre_velocity_x") return centre("velocity_x", "velocity_y", i, j);
        if (name == "centre_velocity_y") return {centre("velocity_x", "velocity_y", i, j)[1]};
        if (name == "flow") return centre("velocity_x", "velocity_y", i, j);
        if (name == "water_depth") return {depth(i, j)};
        if (name == "free_surface") return {surface(i, j)};
        if (name == "sand_surface") return {in("terrain", i, j) + sand(i, j)};
        if (name == "foam") return {foam(i, j)};
        if (name == "normal") return normal(i, j);
        if (name == "packed_surface") return {surface(i, j), depth(i, j), foam(i, j), saturation(i, j)};
        if (name == "smooth_surface") return {smooth(i, j)};
        if (name == "interpolated_output") {
            const Real f = param(run.pilot.input.interpolation), from = in("previous_output", i, j);
            return {from + f * (in("current_output", i, j) - from)};
        }
        return {saturation(i, j)};
    }
};

} // namespace

Verdict check_published(const StageRun& run) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    Verdict verdict;
    for (const auto& binding : run.stage.bindings) {
        if (binding.access != compute::Access::out) continue;
        const std::string name(binding.name);
        const bool half = binding.type == compute::Scalar::uvec2; // four 16-bit floats
        const std::size_t components = half || binding.type == compute::Scalar::vec4 ? 4
                                       : binding.type == compute::Scalar::vec2       ? 2
                                                                                     : 1;
        std::vector<std::vector<float>> got(components, std::vector<float>(layout.size())), narrow = got;
        std::vector<std::vector<double>> exact(components, std::vector<double>(layout.size()));
        std::vector<FieldCheck> checks; // the components of one vector share a scale
        for (std::size_t n = 0; n < components; ++n) {
            for (int j = 0; j < layout.ny; ++j) {
                for (int i = 0; i < layout.nx; ++i) {
                    const std::size_t at = layout.index(i, j);
                    const auto& buffer = run.buffer(name.c_str());
                    const float value = Publisher<float>{run}.value(name, i, j)[n];
                    got[n][at] = half ? from_half(static_cast<std::uint16_t>(buffer.words()[at * 2 + n / 2] >> 16 * (n % 2)))
                                      : buffer.floats()[at * components + n];
                    narrow[n][at] = half ? from_half(to_half(value)) : value;
                    exact[n][at] = Publisher<double>{run}.value(name, i, j)[n];
                }
            }
            const std::string label = components == 1 ? name : name + "." + "xyzw"[n];
            checks.push_back({label, {0, 0, layout.nx, layout.ny}, got[n], narrow[n], exact[n], {}});
        }
        verdict = worse(verdict, compare_fields(checks, layout, 0));
    }
    return verdict;
}

} // namespace wadi::conformance
