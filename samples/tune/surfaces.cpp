#include "surfaces.hpp"
#include <algorithm>
#include <cmath>

namespace tune {
namespace {

/// What has moved less than this share of the largest depth or of the relief has not moved.
constexpr double STILL = 1e-4;

/// Shares of `from` cells that make up each of `to` cells along one axis.
struct Overlap {
    int first;
    std::vector<double> shares;
};
std::vector<Overlap> overlaps(int from, int to) {
    std::vector<Overlap> list;
    const double ratio = static_cast<double>(from) / to;
    for (int n = 0; n < to; ++n) {
        const double low = n * ratio, high = (n + 1) * ratio;
        Overlap overlap{std::min(static_cast<int>(low), from - 1), {}};
        for (int k = overlap.first; k < from && (k == overlap.first || k < high - 1e-9); ++k)
            overlap.shares.push_back(std::max(std::min(high, k + 1.0) - std::max(low, static_cast<double>(k)), 0.0) / ratio);
        list.push_back(std::move(overlap));
    }
    return list;
}

std::optional<double> percent_of(const Run& run, const Run& reference, std::size_t checkpoints,
                                 std::vector<float> Surfaces::*field) {
    const auto on_grid = [&](const Surfaces& s) { return averaged(s.*field, s.nx, s.ny, run.at[0].nx, run.at[0].ny); };
    const std::vector<float> start = on_grid(reference.at[0]);
    const auto [lowest, highest] = std::minmax_element(start.begin(), start.end());
    const double scale = static_cast<double>(*highest) - static_cast<double>(*lowest);
    const std::vector<float>& mine_start = run.at[0].*field;
    double sum = 0, low = 0, high = 0;
    std::size_t count = 0;
    const std::size_t end = std::min({reference.at.size(), run.at.size(), checkpoints + 1});
    for (std::size_t time = 1; time < end; ++time) {
        const std::vector<float> truth = on_grid(reference.at[time]), &mine = run.at[time].*field;
        for (std::size_t n = 0; n < truth.size(); ++n) {
            const double moved = static_cast<double>(truth[n]) - static_cast<double>(start[n]);
            sum += std::abs(static_cast<double>(mine[n]) - static_cast<double>(mine_start[n]) - moved);
            low = std::min(low, moved);
            high = std::max(high, moved);
        }
        count += truth.size();
    }
    if (count == 0 || !(high - low > STILL * scale) || !(high - low > 1e-6)) return {};
    return 100 * sum / static_cast<double>(count) / (high - low);
}

} // namespace

std::vector<float> averaged(const std::vector<float>& field, int nx, int ny, int to_nx, int to_ny) {
    if (nx == to_nx && ny == to_ny) return field;
    const std::vector<Overlap> along_x = overlaps(nx, to_nx), along_y = overlaps(ny, to_ny);
    std::vector<double> rows(static_cast<std::size_t>(to_nx) * static_cast<std::size_t>(ny), 0.0);
    const auto at = [](int i, int j, int width) {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
    };
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < to_nx; ++i) {
            const Overlap& overlap = along_x[static_cast<std::size_t>(i)];
            for (std::size_t k = 0; k < overlap.shares.size(); ++k)
                rows[at(i, j, to_nx)] +=
                    overlap.shares[k] * static_cast<double>(field[at(overlap.first + static_cast<int>(k), j, nx)]);
        }
    }
    std::vector<float> result(static_cast<std::size_t>(to_nx) * static_cast<std::size_t>(to_ny));
    for (int j = 0; j < to_ny; ++j) {
        const Overlap& overlap = along_y[static_cast<std::size_t>(j)];
        for (int i = 0; i < to_nx; ++i) {
            double sum = 0;
            for (std::size_t k = 0; k < overlap.shares.size(); ++k)
                sum += overlap.shares[k] * rows[at(i, overlap.first + static_cast<int>(k), to_nx)];
            result[at(i, j, to_nx)] = static_cast<float>(sum);
        }
    }
    return result;
}

Errors errors_against(const Run& run, const Run& reference, int checkpoints) {
    Errors errors;
    const auto count = static_cast<std::size_t>(checkpoints);
    if (reference.has_sand) errors.sand = percent_of(run, reference, count, &Surfaces::sand);
    if (reference.has_water) errors.water = percent_of(run, reference, count, &Surfaces::surface);
    return errors;
}

} // namespace tune
