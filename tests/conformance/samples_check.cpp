// sample_points by its definition, in float and in double: bilinear between cell centres and between faces, slopes by central
// differences.
#include "tests/conformance/stage_checks.hpp"
#include <algorithm>
#include <cmath>

namespace wadi::conformance {

namespace {

// Groups of components that share a scale: first and one past the last.
constexpr std::pair<std::size_t, std::size_t> groups[] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 6}, {6, 9}, {9, 10}, {10, 12}};
constexpr std::size_t sand_depth = 1, saturation = 9;

template <class Real> struct Sampler {
    const StageRun& run;

    Real field(const char* name, int i, int j) const { return static_cast<Real>(run.before(name, i, j)); }
    Real water(int i, int j) const { return standing_water<Real>(run, i, j); }
    Real sand(int i, int j) const { return field("sand_height", i, j); }
    Real surface(int i, int j) const { return field("terrain", i, j) + std::max(water(i, j), sand(i, j)); }
    int column(int i) const { return std::clamp(i, 0, run.params.nx - 1); }
    int row(int j) const { return std::clamp(j, 0, run.params.ny - 1); }
    Real slope(int i, int j, bool along_x) const {
        const int w = along_x ? column(i - 1) : i, e = along_x ? column(i + 1) : i;
        const int s = along_x ? j : row(j - 1), n = along_x ? j : row(j + 1);
        const int steps = (e - w) + (n - s);
        return steps == 0 ? Real(0)
                          : (surface(e, n) - surface(w, s)) / (static_cast<Real>(steps) * static_cast<Real>(run.params.dx));
    }

    // `at` in places of the field, the values of which f gives; limited to 0 ... last.
    template <class F> static Real between(Real x, Real y, int last_i, int last_j, F f) {
        x = std::clamp(x, Real(0), static_cast<Real>(last_i));
        y = std::clamp(y, Real(0), static_cast<Real>(last_j));
        const int i = static_cast<int>(x), j = static_cast<int>(y), e = std::min(i + 1, last_i), n = std::min(j + 1, last_j);
        const Real fx = x - static_cast<Real>(i), fy = y - static_cast<Real>(j);
        return (1 - fy) * ((1 - fx) * f(i, j) + fx * f(e, j)) + fy * ((1 - fx) * f(i, n) + fx * f(e, n));
    }

    std::array<Real, SAMPLE_FLOATS> at(Real px, Real py) const {
        const int nx = run.params.nx, ny = run.params.ny;
        const Real x = px / static_cast<Real>(run.params.dx), y = py / static_cast<Real>(run.params.dx), half = Real(0.5);
        if (x < 0 || y < 0 || x > static_cast<Real>(nx) || y > static_cast<Real>(ny)) return {};
        const auto cells = [&](const auto& f) { return between(x - half, y - half, nx - 1, ny - 1, f); };
        std::array<Real, SAMPLE_FLOATS> s{};
        s[0] = cells([&](int i, int j) { return field("terrain", i, j); });
        s[1] = cells([&](int i, int j) { return sand(i, j); });
        s[2] = cells([&](int i, int j) { return std::max(water(i, j) - sand(i, j), Real(0)); });
        s[3] = cells([&](int i, int j) { return surface(i, j); });
        s[4] = between(x, y - half, nx, ny - 1, [&](int i, int j) { return field("water_velocity_x", i, j); });
        s[5] = between(x - half, y, nx - 1, ny, [&](int i, int j) { return field("water_velocity_y", i, j); });
        const Real gx = cells([&](int i, int j) { return slope(i, j, true); }),
                   gy = cells([&](int i, int j) { return slope(i, j, false); });
        const Real up = 1 / std::sqrt(gx * gx + gy * gy + 1), w = cells([&](int i, int j) { return water(i, j); });
        s[6] = -gx * up;
        s[7] = -gy * up;
        s[8] = up;
        s[9] = s[1] > static_cast<Real>(run.params.dry_threshold) ? w / (w + s[1]) : Real(0);
        s[10] = 1;
        return s;
    }
};

} // namespace

Verdict check_samples(const StageRun& run) {
    const int count = run.pilot.input.point_count;
    const FieldLayout layout{count, 1};
    const auto points = run.buffer("points").floats(), samples = run.buffer("samples").floats();
    std::array<std::vector<float>, SAMPLE_FLOATS> got, narrow;
    std::array<std::vector<double>, SAMPLE_FLOATS> wide;
    for (std::size_t k = 0; k < SAMPLE_FLOATS; ++k) {
        got[k] = narrow[k] = std::vector<float>(layout.size(), 0.0F);
        wide[k] = std::vector<double>(layout.size(), 0.0);
    }
    const double dry = static_cast<double>(run.params.dry_threshold);
    for (int p = 0; p < count; ++p) {
        const auto at = static_cast<std::size_t>(p);
        const float x = points[2 * at], y = points[2 * at + 1];
        const auto n = Sampler<float>{run}.at(x, y);
        const auto w = Sampler<double>{run}.at(static_cast<double>(x), static_cast<double>(y));
        const std::size_t cell = layout.index(p, 0);
        for (std::size_t k = 0; k < SAMPLE_FLOATS; ++k) {
            got[k][cell] = samples[at * SAMPLE_FLOATS + k];
            narrow[k][cell] = n[k];
            wide[k][cell] = w[k];
        }
        // Where a float may fall on either side of the threshold both answers pass.
        if (std::abs(w[sand_depth] - dry) > 1e-2 * dry) continue;
        narrow[saturation][cell] = got[saturation][cell];
        wide[saturation][cell] = static_cast<double>(got[saturation][cell]);
    }
    Verdict verdict;
    for (const auto& [first, last] : groups) {
        std::vector<FieldCheck> components;
        for (std::size_t k = first; k < last; ++k)
            components.push_back(
                {"sample " + std::to_string(k) + " of point ", {0, 0, count, 1}, got[k], narrow[k], wide[k], {}});
        verdict = worse(verdict, compare_fields(components, layout, 0));
    }
    return verdict;
}

} // namespace wadi::conformance
