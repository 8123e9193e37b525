#include "comparisons.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace tune {
namespace {

// Shares of the time to measure for.
constexpr double LONG_PROBE = 0.05, SHORT_PROBE = 0.03, PLANNED = 0.5, LOAD = 0.06, BEFORE_CONFIRMING = 0.7, CONFIRMING = 0.12;
constexpr double WANTED_PIECE = 0.5;                 // of the level's duration, rather than finer runs
constexpr int COARSE_SIDE = 40, LEAST_SIDE = 48;     // cells along the shorter side: of the probe, of the largest measured grid
constexpr double LADDER[] = {0.35, 0.5, 0.71};       // of the largest measured grid's cells along x
constexpr double REFERENCES[] = {4, 3, 2.5, 2, 1.6}; // likewise
constexpr double KIN[] = {0.5, 0.354, 0.25, 0.177};  // cells along x of the reference's coarser kin, over its own
constexpr double KIN_TIME = 1.2;                     // time of a reference with its kin, over its own
constexpr int LEAST_KIN_SIDE = 8;
constexpr double TOLD_H = 1.4; // cells of settings whose error is told, in units of the reference's
constexpr double FINER[] = {1.6, TOLD_H},
                 FINER_TIME = 0.4; // cells along x over the chosen settings'; share of the time, beyond it
constexpr int ATTEMPTS = 4;
constexpr double ENOUGH = 0.9; // of the budget

/// Guess of what a way's step takes, in steps of first order with two substeps.
double usual_cost(const Way& way) {
    return (0.35 + 0.325 * way.substeps) * (way.water_order == 2 ? 1.35 : 1) * (way.sand_order == 2 ? 1.35 : 1);
}

class Tuner {
  public:
    Tuner(const Level& level, const Request& request)
        : level_(level), request_(request), runner_(level, request.device, request.stop), start_(now(request.device)) {}
    Outcome tune();

  private:
    const Level& level_;
    const Request& request_;
    Runner runner_;
    double start_;
    Outcome outcome_;
    TimeFit base_;             // of first order with two substeps, from the probes
    std::optional<Run> whole_; // one over all of the level, for how its time changes
    double piece_ = 0;         // [s] of the level's time in the ladder's runs; the reference may take less
    double measured_nx_ = 0;   // cells along x of the largest grid of the ladder
    bool gpu_ = false;
    std::vector<Run> ladder_;
    std::vector<WayModel> models_;
    std::optional<Run> reference_;
    double scale_ = 1; // of the models' times
    Comparisons comparisons_{ladder_, reference_, [this] { return elapsed(); }};
    double making_worlds_ = 0; // [s]

    double seconds() const { return 60 * request_.minutes; }
    double elapsed() const { return now(request_.device) - start_; }
    // On steps: the plan of what to run counts neither making worlds nor comparing surfaces.
    double spent() const { return elapsed() - making_worlds_ - comparisons_.seconds(); }
    void tell(const std::string& text) const {
        if (request_.tell) request_.tell(text);
    }
    Run run(const Settings& settings, const RunRequest& request);
    Settings sized(double nx, const Way& way) const { return level_.on_grid(nx, way); }
    double short_side(double nx) const { return std::min(nx, nx * level_.ny() / level_.nx()); }
    double nx_of_short_side(double cells) const { return cells * level_.nx() / std::min(level_.nx(), level_.ny()); }
    double cost(const Settings& settings) const; // guessed time of a simulated second

    void probe();
    void plan();
    void climb();
    void fit_times();
    void try_tiles();
    std::pair<Way, const WayModel*> finest_way() const;
    void run_kin(int parts);
    void refer();
    std::vector<Candidate> model_frontier() const {
        return frontier(candidates(level_, models_, reference_->settings.nx, request_.frames, scale_));
    }
    void choose();
    [[noreturn]] void refuse(const Candidate& cheapest) const;
    void confirm(const Candidate& candidate);
    void measure_load();
    bool refer_finer();
    void measure_errors();
};

Run Tuner::run(const Settings& settings, const RunRequest& request) {
    char text[160];
    std::snprintf(text, sizeof text, "%3.0f s: %d x %d cells, %s, %.3g s", elapsed(), settings.nx, settings.ny,
                  describe(settings.way).c_str(), request.seconds);
    tell(text);
    ++outcome_.runs;
    const double before = elapsed();
    Run done = runner_.run(settings, request);
    making_worlds_ += elapsed() - before - done.stepping;
    return done;
}

double Tuner::cost(const Settings& settings) const {
    return base_.step(settings.cells()) * usual_cost(settings.way) / level_.dt(settings);
}

/// A coarse run over the whole level shows what it holds and when it costs most; a few steps of its own grid, what cells cost.
void Tuner::probe() {
    Way way = level_.own_way();
    way.substeps = 2;
    way.water_order = way.sand_order = 1;
    const double nx = std::min(nx_of_short_side(COARSE_SIDE), static_cast<double>(level_.nx()));
    const Run coarse = run(sized(nx, way), {level_.duration(), false, LONG_PROBE * seconds()});
    outcome_.sand.exists = coarse.has_sand;
    outcome_.water.exists = coarse.has_water;
    outcome_.device_name = coarse.device_name;
    outcome_.backend = coarse.backend;
    gpu_ = coarse.backend != "cpu";

    const Settings own = sized(level_.nx(), way);
    const Run brief = run(own, {2.0 * PARTS * level_.dt(own), false, SHORT_PROBE * seconds()});
    base_ = fit_time({{coarse.settings.cells(), coarse.step_seconds()}, {own.cells(), brief.step_seconds()}});
}

/// The largest grid that the budget may pay for, and for how long of the level's time it can be measured.
void Tuner::plan() {
    Way way;
    way.substeps = outcome_.sand.exists ? 2 : level_.own_way().substeps;
    const std::vector<Settings> all = grids(level_);
    Settings largest = all.front();
    largest.way = way;
    for (Settings grid : all) {
        grid.way = way;
        if (1e3 * cost(grid) / request_.frames <= 1.15 * request_.budget_ms) largest = grid;
    }
    if (1e3 * cost(largest) / request_.frames > 2 * request_.budget_ms) { // no need to measure more
        Candidate cheapest;
        cheapest.settings = largest;
        cheapest.frame_ms = 1e3 * cost(largest) / request_.frames;
        refuse(cheapest);
    }
    const double least = std::max(nx_of_short_side(LEAST_SIDE), static_cast<double>(all.front().nx));
    double nx = std::max(static_cast<double>(largest.nx), least);
    for (;; nx *= 0.92) {
        double work = cost(sized(2 * nx, reference_way(level_, outcome_.sand.exists, outcome_.water.exists)));
        for (const Way& each : ways(level_, outcome_.sand.exists, outcome_.water.exists)) {
            work += 2 * cost(sized(LADDER[1] * nx, each));
            if (each.substeps == way.substeps) work += cost(sized(LADDER[0] * nx, each)) + cost(sized(LADDER[2] * nx, each));
        }
        piece_ = std::min(level_.duration(), PLANNED * seconds() / work);
        if (piece_ >= WANTED_PIECE * level_.duration() || 0.92 * nx < least) break;
    }
    // A step at least in each part: what holds none has no time to go by.
    piece_ = std::max(piece_, std::min(level_.duration(), PARTS * level_.dt(sized(LADDER[0] * nx, way))));
    measured_nx_ = nx;
}

/// Every way on half of the largest grid, those with two substeps on two more.
void Tuner::climb() {
    const std::vector<Way> list = ways(level_, outcome_.sand.exists, outcome_.water.exists);
    const RunRequest request{piece_, true, 1e9};
    for (const Way& way : list) {
        for (const double share : LADDER) {
            if (way.substeps != list.front().substeps && share != LADDER[1]) continue;
            const Settings settings = sized(share * measured_nx_, way);
            try {
                Run best = run(settings, request);
                if (best.seconds() < 0.02 * seconds()) best.keep_quicker(run(settings, {piece_, false, 1e9}));
                ladder_.push_back(std::move(best));
            } catch (const BadInput& error) {
                if (way == list.front()) throw;
                outcome_.notes.push_back("left out " + describe(way) + ": " + error.what());
                break;
            }
        }
    }
}

/// Ways of two substeps by their own sizes; others by what they take of those on the one grid that both ran on.
void Tuner::fit_times() {
    for (const Run& run : ladder_) {
        const Way& way = run.settings.way;
        if (std::any_of(models_.begin(), models_.end(), [&](const WayModel& m) { return m.way == way; })) continue;
        std::vector<TimePoint> points;
        for (const Run& other : ladder_) {
            if (other.settings.way == way) points.push_back({other.settings.cells(), other.step_seconds()});
        }
        WayModel model{way, fit_time(points), {}, {}};
        if (points.size() == 1) {
            Way kin = way;
            kin.substeps = ladder_.front().settings.way.substeps;
            for (const WayModel& known : models_) {
                if (known.way != kin) continue;
                const double ratio = points[0].step / known.time.step(points[0].cells);
                model.time = {ratio * known.time.fixed, ratio * known.time.per_cell};
            }
        }
        models_.push_back(model);
    }
}

/// Tiles change no bit, so that their time decides.
void Tuner::try_tiles() {
    const Run* largest = &ladder_.front();
    for (const Run& run : ladder_) {
        if (run.settings.way == ladder_.front().settings.way && run.settings.nx > largest->settings.nx) largest = &run;
    }
    Settings settings = largest->settings;
    settings.way.active_tiles = 1;
    const Run tiled = run(settings, {piece_, false, 1e9});
    outcome_.tiles_gain = tiled.seconds() / largest->seconds();
    if (outcome_.tiles_gain > 0.95) return;
    for (WayModel& model : models_) {
        model.way.active_tiles = 1;
        model.time.fixed *= outcome_.tiles_gain;
        model.time.per_cell *= outcome_.tiles_gain;
    }
}

/// The way of reference runs, and the model that tells their time.
std::pair<Way, const WayModel*> Tuner::finest_way() const {
    Way way = reference_way(level_, outcome_.sand.exists, outcome_.water.exists);
    const WayModel* model = &models_.front();
    for (const WayModel& known : models_) {
        if (known.way.water_order == way.water_order && known.way.sand_order == way.sand_order &&
            known.way.substeps == way.substeps)
            model = &known;
    }
    if (model->way.water_order != way.water_order ||
        model->way.sand_order != way.sand_order) { // the level's method has no second order
        way.water_order = model->way.water_order;
        way.sand_order = model->way.sand_order;
    }
    return {way, model};
}

/// Coarser runs that differ from the reference in nothing but cells: what else differs would pass for an effect of theirs.
void Tuner::run_kin(int parts) {
    for (const double share : KIN) {
        const Settings settings = sized(share * reference_->settings.nx, reference_->settings.way);
        const bool known =
            std::any_of(ladder_.begin(), ladder_.end(), [&](const Run& other) { return other.settings == settings; });
        if (!known && std::min(settings.nx, settings.ny) >= LEAST_KIN_SIDE)
            ladder_.push_back(run(settings, {piece_, true, 1e9, parts}));
    }
}

/// The finest run that the time allows.
void Tuner::refer() {
    const auto finest = finest_way();
    const Way& way = finest.first;
    const WayModel* const model = finest.second;
    const double room = BEFORE_CONFIRMING * seconds() - spent();
    const auto try_with = [&](double times, int parts) {
        const Settings settings = sized(std::min(times * measured_nx_, 16384.0), way);
        const double simulated = piece_ * parts / PARTS;
        if (times > 1 && KIN_TIME * simulated / level_.dt(settings) * model->time.step(settings.cells()) > room) return false;
        reference_ = run(settings, {piece_, true, 1e9, parts});
        run_kin(parts);
        outcome_.piece = simulated;
        outcome_.checkpoints = CHECKPOINTS * parts / PARTS;
        return true;
    };
    for (const int parts : {PARTS, PARTS / 2, PARTS / 4}) { // a shorter time rather than a coarse one
        for (const double times : REFERENCES) {
            if (!reference_) try_with(times, parts);
        }
    }
    if (!reference_) try_with(1, PARTS / 4);
    outcome_.reference = reference_->settings;
}

/// Measures what the model says is best, corrects the model's times by it, and again, until the budget is nearly used up.
void Tuner::choose() {
    scale_ = outcome_.load;
    std::optional<Outcome> fitting;
    for (int attempt = 1; attempt <= ATTEMPTS; ++attempt) {
        outcome_.frontier = model_frontier();
        const std::optional<Candidate> best = best_within(outcome_.frontier, request_.budget_ms);
        if (!best && fitting) break;
        if (!best) refuse(outcome_.frontier.front());
        if (attempt == 1) outcome_.predicted = *best;
        if (fitting && best->settings == fitting->chosen.settings) break;
        confirm(*best);
        const double frame_ms = outcome_.chosen.frame_ms, ratio = frame_ms / best->frame_ms;
        if (frame_ms <= request_.budget_ms && (!fitting || outcome_.chosen.settings.cells() > fitting->chosen.settings.cells()))
            fitting = outcome_;
        if (fitting &&
            (fitting->chosen.frame_ms > ENOUGH * request_.budget_ms || outcome_.frontier.back().frame_ms < request_.budget_ms))
            break;
        scale_ *= ratio > 1 ? 1.02 * ratio : ratio;
    }
    if (fitting) {
        fitting->frontier = outcome_.frontier;
        fitting->runs = outcome_.runs;
        outcome_ = *fitting;
    } else {
        outcome_.notes.push_back("the settings measured last take more than the budget: the machine's times vary too much");
    }
}

void Tuner::refuse(const Candidate& cheapest) const {
    char text[256];
    std::snprintf(text, sizeof text,
                  "a budget of %g ms a frame is too small: the cheapest settings, %d x %d cells, %s, take %.3g ms a frame",
                  request_.budget_ms, cheapest.settings.nx, cheapest.settings.ny, describe(cheapest.settings.way).c_str(),
                  cheapest.frame_ms);
    throw BadInput(text);
}

/// Runs the settings themselves over the level; sets `chosen` and what goes with its time.
void Tuner::confirm(const Candidate& candidate) {
    const double limit = CONFIRMING * seconds(), start = spent();
    const RunRequest request{level_.duration(), false, limit};
    Run best = run(candidate.settings, request);
    std::vector<double> means = {best.seconds() / static_cast<double>(best.parts.size())}; // of a part
    while (means.size() < 3 && spent() - start < 0.7 * limit) {
        const Run again = run(candidate.settings, request);
        means.push_back(again.seconds() / static_cast<double>(again.parts.size()));
        best.keep_quicker(again);
    }
    outcome_.chosen = candidate;
    outcome_.warnings = best.warnings;
    outcome_.measured_share = static_cast<double>(best.parts.size()) / PARTS;
    outcome_.chosen.step_ms = 1e3 * best.step_seconds();
    if (outcome_.measured_share < 1 && whole_->parts.size() == PARTS) // as much of its time as of the other run's
        outcome_.chosen.step_ms *= outcome_.measured_share / whole_->share(best.parts.size());
    outcome_.chosen.frame_ms = outcome_.chosen.step_ms * candidate.steps_per_frame;
    outcome_.dearest_frame_ms =
        1e3 * *std::max_element(best.parts.begin(), best.parts.end()) * PARTS / (level_.duration() * request_.frames);
    outcome_.confirming_runs = static_cast<int>(means.size());
    const auto [quickest, slowest] = std::minmax_element(means.begin(), means.end());
    outcome_.spread = (*slowest - *quickest) / *quickest;
}

/// A run finer than the chosen settings, over a shorter time of the level where need be, or false: what was planned with was
/// coarser than what the budget buys, and errors of a model alone were off by twice.
bool Tuner::refer_finer() {
    const auto finest = finest_way();
    const Way& way = finest.first;
    const WayModel* const model = finest.second;
    const int whole = static_cast<int>(reference_->parts.size());
    const double room = std::max(FINER_TIME * seconds(), seconds() - spent());
    for (const int parts : {whole, whole / 2, whole / 4}) {
        if (parts < PARTS / CHECKPOINTS) break;
        for (const double times : FINER) {
            const Settings settings = sized(times * outcome_.chosen.settings.nx, way);
            const double simulated = piece_ * parts / PARTS;
            if (KIN_TIME * simulated / level_.dt(settings) * model->time.step(settings.cells()) > room) continue;
            Run finer = run(settings, {piece_, true, 1e9, parts});
            if (reference_->settings.way == way) ladder_.push_back(std::move(*reference_)); // now one of its kin
            reference_ = std::move(finer);
            run_kin(parts); // those that there are may be far coarser, and come closer faster
            outcome_.reference = settings;
            outcome_.piece = simulated;
            outcome_.checkpoints = CHECKPOINTS * parts / PARTS;
            comparisons_.fit_errors(outcome_, models_);
            outcome_.frontier = model_frontier();
            return true;
        }
    }
    return false;
}

/// Of the chosen settings themselves.
void Tuner::measure_errors() {
    const auto finer_by = [&] { return static_cast<double>(reference_->settings.nx) / outcome_.chosen.settings.nx; };
    const bool far = finer_by() >= 0.99 * TOLD_H || refer_finer(); // grids come in whole cells
    outcome_.errors_measured = far || finer_by() >= LEAST_H;
    for (Told* told : {&outcome_.sand, &outcome_.water}) {
        if (!far) told->early = 0;
        if (!far && outcome_.errors_measured) told->converges = false;
    }
    if (!outcome_.errors_measured) return;
    const Run chosen = run(outcome_.chosen.settings, {piece_, true, 1e9, static_cast<int>(reference_->parts.size())});
    const Errors apart = errors_against(chosen, *reference_);
    Errors& errors = outcome_.chosen.errors;
    if (apart.sand) errors.sand = error_of(*apart.sand, outcome_.sand.converges ? outcome_.sand.reference : 0);
    if (apart.water) errors.water = error_of(*apart.water, outcome_.water.converges ? outcome_.water.reference : 0);
    const Errors sand = errors_against(chosen, *reference_, outcome_.sand.early);
    const Errors water = errors_against(chosen, *reference_, outcome_.water.early);
    if (sand.sand) outcome_.sand.early_percent = error_of(*sand.sand, outcome_.sand.early_reference);
    if (water.water) outcome_.water.early_percent = error_of(*water.water, outcome_.water.early_reference);
}

/// What happens in a level decides what its steps cost, on some grids more than on others: a run over all of it tells what the
/// rest costs of what the piece does.
void Tuner::measure_load() {
    const Settings settings = sized(LADDER[2] * measured_nx_, ladder_.front().settings.way);
    whole_ = run(settings, {level_.duration(), false, LOAD * seconds()});
    const double share = piece_ / level_.duration();
    double inside = 0;
    for (std::size_t n = 0; n < whole_->parts.size(); ++n)
        inside += whole_->parts[n] * std::clamp(share * PARTS - static_cast<double>(n), 0.0, 1.0);
    const double part_of_parts = std::min(share * PARTS, static_cast<double>(whole_->parts.size()));
    outcome_.load = whole_->seconds() / static_cast<double>(whole_->parts.size()) / (inside / part_of_parts);
}

Outcome Tuner::tune() {
    probe();
    plan();
    climb();
    measure_load();
    fit_times();
    try_tiles();
    refer();
    comparisons_.fit_errors(outcome_, models_);
    choose();
    measure_errors();
    outcome_.seconds = elapsed();
    return std::move(outcome_);
}

} // namespace

Outcome tune(const Level& level, const Request& request) { return Tuner(level, request).tune(); }

} // namespace tune
