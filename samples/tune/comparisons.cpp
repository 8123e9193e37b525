#include "comparisons.hpp"
#include <algorithm>
#include <cmath>

namespace tune {
namespace {

// The order at which kin must come closer to each other, the same as that of errors. Of the levels that the tuner's constants
// rest on flush and letters go down to -0.2 and are told well; spring, which is not, goes further down.
constexpr double LEAST_CLOSING = -0.25;

} // namespace

bool alike(const Way& a, const Way& b) { return a.water_order == b.water_order && a.sand_order == b.sand_order; }
bool same_but_tiles(const Way& a, const Way& b) { return alike(a, b) && a.substeps == b.substeps; }

/// As errors_against, each pair once: means of fields as large as a GPU's cost more than its steps.
Errors Comparisons::errors_of(const Run& run, const Run& reference, int checkpoints) {
    Pair pair{run.settings, reference.settings, run.at.size(), reference.at.size(), checkpoints, {}};
    const auto known = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& other) { return pair.same(other); });
    if (known != pairs_.end()) return known->errors;
    const double before = elapsed_();
    pair.errors = errors_against(run, reference, checkpoints);
    seconds_ += elapsed_() - before;
    pairs_.push_back(pair);
    return pair.errors;
}

/// Differences of ladder runs whose way is wanted from the reference, at its first checkpoints.
template <class Wanted> std::vector<ErrorPoint> Comparisons::differences(bool sand, int checkpoints, const Wanted& wanted) {
    std::vector<ErrorPoint> points;
    for (const Run& run : ladder_) {
        const double h = static_cast<double>(reference_->settings.nx) / run.settings.nx;
        if (h < LEAST_H || !wanted(run.settings.way)) continue;
        const Errors errors = errors_of(run, *reference_, checkpoints);
        const std::optional<double>& difference = sand ? errors.sand : errors.water;
        if (difference && *difference > 0) points.push_back({h, *difference});
    }
    return points;
}

/// Of the reference's coarser kin the one with cells along x nearest to these.
const Run* Comparisons::nearest_kin(double nx) const {
    const Run* nearest = nullptr;
    for (const Run& run : ladder_) {
        if (run.settings.way != reference_->settings.way || run.settings.nx >= reference_->settings.nx) continue;
        if (!nearest || std::abs(std::log(run.settings.nx / nx)) < std::abs(std::log(nearest->settings.nx / nx))) nearest = &run;
    }
    return nearest;
}

/// The order at which the reference and its kin of half and a quarter of its cells along x come closer to each other: differences
/// from one run fall towards it on every level, those among runs only where it is near the truth.
std::optional<double> Comparisons::closing(bool sand, int checkpoints) {
    const double nx = reference_->settings.nx;
    const Run *const middle = nearest_kin(nx / 2), *const coarse = nearest_kin(nx / 4);
    if (!middle || middle == coarse) return {};
    const Errors first = errors_of(*coarse, *middle, checkpoints), second = errors_of(*middle, *reference_, checkpoints);
    const auto &from = sand ? first.sand : first.water, &to = sand ? second.sand : second.water;
    if (!from || !to || !(*from > 0) || !(*to > 0)) return {};
    return order_among(nx / coarse->settings.nx, nx / middle->settings.nx, *from, *to);
}

/// What the reference and its kin tell of an error in so much of the piece.
Told Comparisons::told_until(bool exists, bool sand, int checkpoints) {
    Told told;
    told.exists = exists;
    const Way& finest = reference_->settings.way;
    told.differences = differences(sand, checkpoints, [&](const Way& way) { return same_but_tiles(way, finest); });
    told.moved = told.exists && !told.differences.empty();
    if (!told.moved) return told;
    const ErrorFit fit = fit_own(told.differences);
    const std::optional<double> closer = closing(sand, checkpoints);
    told.order = fit.order;
    told.scatter = fit.scatter;
    told.closing = closer.value_or(0);
    told.converges = told.differences.size() > 1 && fit.converges() && closer && *closer > LEAST_CLOSING;
    told.reference = told.converges ? fit.at(1) : 0;
    return told;
}

/// How errors fall with cells follows from the orders of transport, so that ways of all substeps share it with that of two. Small
/// differences grow with time, until runs on any grid are as far apart: where that is so at the end, an earlier part may be told.
void Comparisons::fit_errors(Outcome& outcome, std::vector<WayModel>& models) {
    const int usual = ladder_.front().settings.way.substeps, all = outcome.checkpoints;
    for (const bool sand : {true, false}) {
        Told& told = sand ? outcome.sand : outcome.water;
        told = told_until(told.exists, sand, all);
        for (int checkpoints = all - 1; checkpoints > 0 && !told.converges && told.early == 0; --checkpoints) {
            const Told shorter = told_until(told.exists, sand, checkpoints);
            if (!shorter.converges) continue;
            told.early = checkpoints;
            told.early_reference = shorter.reference;
        }
        if (!told.moved) continue;
        for (WayModel& model : models) {
            const auto kin =
                differences(sand, all, [&](const Way& way) { return alike(way, model.way) && way.substeps == usual; });
            const auto same = differences(sand, all, [&](const Way& way) { return same_but_tiles(way, model.way); });
            if (kin.empty() || same.empty()) continue;
            (sand ? model.sand : model.water) = fit_other(same, told.reference, fit_other(kin, told.reference, 0).order);
        }
    }
}

} // namespace tune
