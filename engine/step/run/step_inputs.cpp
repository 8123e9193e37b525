#include "engine/step/run/step_inputs.hpp"
#include "engine/settings/data/rain_map.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/step/plan/source_shapes.hpp"
#include "engine/step/plan/world_params.hpp"
#include "engine/step/run/step_number.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace wadi {

namespace {

/// Area of the cells that a source covers: covers() of apply_sources.stage, in its arithmetic, so that a cell whose centre lies
/// on the rim counts here where it counts there [m2].
double covered_area(const vec4& shape, bool disc, const Grid& grid) {
    const auto dx = static_cast<float>(grid.dx);
    const float radius = disc ? std::sqrt(shape.z) : 0;
    // Rows and columns from `low` to `high`, a cell wide of them.
    const auto first = [dx](float low, int cells) { return static_cast<int>(std::clamp(low / dx - 1.0F, 0.0F, float(cells))); };
    const auto end = [dx](float high, int cells) { return static_cast<int>(std::clamp(high / dx + 2.0F, 0.0F, float(cells))); };
    const int i0 = first(shape.x - radius, grid.nx), i1 = end(disc ? shape.x + radius : shape.z, grid.nx);
    const int j0 = first(shape.y - radius, grid.ny), j1 = end(disc ? shape.y + radius : shape.w, grid.ny);
    std::int64_t cells = 0;
    for (int j = j0; j < j1; ++j)
        for (int i = i0; i < i1; ++i) {
            const float x = (static_cast<float>(i) + 0.5F) * dx, y = (static_cast<float>(j) + 0.5F) * dx;
            const float rx = x - shape.x, ry = y - shape.y;
            const bool in_box = x >= shape.x && y >= shape.y && x < shape.z && y < shape.w;
            cells += (disc ? rx * rx + ry * ry <= shape.z : in_box) ? 1 : 0;
        }
    return static_cast<double>(cells) * grid.dx * grid.dx;
}

} // namespace

StepInputs::StepInputs(const Settings& settings)
    : settings_(settings), quantum_(height_quantum(settings.method)), rain_is_mapped_(rain_is_mapped(settings)),
      rain_peak_(rain_peak(settings)), areas_(settings.sources.size()), totals_(settings.sources.size() + 6) {
    const auto shapes = source_shapes(settings);
    for (std::size_t n = 0; n < areas_.size(); ++n)
        if (!settings.sources[n].discharge.samples.empty())
            areas_[n] = covered_area(shapes[2 * n], settings.sources[n].shape == SourceShape::disc, settings.grid);
}

void StepInputs::carry_over(const StepInputs& before) {
    const std::size_t sources = std::min(settings_.sources.size(), before.settings_.sources.size());
    std::copy_n(before.totals_.begin(), sources, totals_.begin());
    std::copy(before.totals_.begin() + static_cast<std::ptrdiff_t>(before.settings_.sources.size()), before.totals_.end(),
              totals_.begin() + static_cast<std::ptrdiff_t>(settings_.sources.size()));
}

double StepInputs::rate_of(std::size_t n, double time) const {
    const auto& source = settings_.sources[n];
    if (source.discharge.samples.empty()) return source.rate.at(time);
    return areas_[n] > 0 ? std::clamp(source.discharge.at(time) / areas_[n], -RATE_MOST, RATE_MOST) : 0;
}

float StepInputs::advance(Total& total, double rate) const {
    const double depth = rate * settings_.water_dt();
    if (quantum_ <= 0) return static_cast<float>(depth);
    total.metres += depth;
    const double quanta = std::floor(total.metres / quantum_);
    const double difference = quanta - total.quanta;
    total.quanta = quanta;
    return static_cast<float>(difference * quantum_);
}

vec4 StepInputs::source_input(std::size_t n, double time) {
    const auto& source = settings_.sources[n];
    const double rate = rate_of(n, time);
    if (source.level.samples.empty()) {
        const bool velocity = source.set_velocity && rate > 0;
        return {advance(totals_[n], rate), static_cast<float>(source.velocity[0]), static_cast<float>(source.velocity[1]),
                velocity ? 1.0F : 0.0F};
    }
    const bool bounded = !source.rate.samples.empty() || !source.discharge.samples.empty();
    const double most = 2 * settings_.method.largest_height; // more than any cell lacks
    const double level = source.level.at(time);
    return {bounded ? advance(totals_[n], rate) : static_cast<float>(most),
            static_cast<float>(quantum_ > 0 ? std::floor(level / quantum_) * quantum_ : level), source.drain ? 1.0F : 0.0F, 0.0F};
}

void StepInputs::set_sides(StepInput& input, double time) {
    const double dt = settings_.water_dt(), k = dt / settings_.grid.dx;
    for (std::size_t n = 0; n < 4; ++n) {
        const auto& side = settings_.sides[n];
        const int cells = n == SIDE_WEST || n == SIDE_EAST ? settings_.grid.ny : settings_.grid.nx;
        // Cells whose centre lies in the span.
        const double dx = settings_.grid.dx;
        const int first = static_cast<int>(std::clamp(std::ceil(side.from / dx - 0.5), 0.0, double(cells)));
        const int last = static_cast<int>(std::clamp(std::floor(side.to / dx - 0.5), -1.0, double(cells - 1)));
        double value = side.value.at(time), depth = 0;
        if (side.kind == SideKind::discharge) {
            value = last >= first ? std::max(0.0, value) / ((last - first + 1) * dx) : 0.0;
            const double critical = std::cbrt(value * value / std::max(1e-9, settings_.gravity));
            const auto moved = static_cast<double>(advance(totals_[settings_.sources.size() + 2 + n], value / dx));
            // Half a quantum more than is meant: the flux is cut to whole quanta after rounding.
            value = moved > 0 ? (moved + quantum_ / 2) / k : 0;
            const double fastest = value * k / settings_.method.velocity_clamp;
            // Deep enough that the flow into a dry cell is critical and within the velocity clamp; as deep as given where that is
            // less than critical, whatever the cell holds.
            const bool shooting = side.depth > 0 && side.depth < critical;
            depth = shooting ? -std::max(side.depth, fastest) : std::max(critical, fastest);
        } else if (side.has_level()) {
            depth = side.wave.at(time);
            input.side_pace[n].x = side.absorb > 0 ? static_cast<float>(std::min(0.5, dt / side.absorb)) : 0.0F;
        }
        if (side.kind == SideKind::outflow) value = side.slope;
        const double unless_said = side.kind == SideKind::discharge ? 0 : 1;
        input.side_pace[n].y = static_cast<float>(side.sediment >= 0 ? side.sediment : unless_said);
        input.side[n] = {static_cast<float>(value), static_cast<float>(depth), static_cast<float>(first),
                         static_cast<float>(last)};
    }
}

void StepInputs::next(std::uint64_t step, std::span<StepInput> inputs) {
    before_ = totals_;
    for (std::size_t n = 0; n < inputs.size(); ++n) {
        inputs[n] = substep(step * inputs.size() + n);
        inputs[n].step = stage_step(step); // of which tiles keep count
    }
}

StepInput StepInputs::substep(std::uint64_t substep) {
    StepInput input{};
    const double time = static_cast<double>(substep) * settings_.water_dt();
    input.phase = settings_.method.published() ? 0.0F : rounding_phase(substep); // the paper says nothing of rounding
    const std::size_t sources = settings_.sources.size();
    const double before = totals_[sources].quanta;
    const float rain = advance(totals_[sources], settings_.rain.at(time) * rain_peak_);
    if (rain_is_mapped_)
        input.mapped_rain = {rain, static_cast<float>(std::fmod(before, 65536)), 0, 0}; // part_of() of rain.glsl
    else
        input.rain = rain;
    input.evaporation = advance(totals_[sources + 1], settings_.evaporation.at(time));
    for (std::size_t n = 0; n < sources; ++n) input.source[n] = source_input(n, time);
    set_sides(input, time);
    input.side_pace[0].z = substep == 0 ? 1.0F : 0.0F;
    input.side_pace[0].w = stage_step(substep) % SIDE_SLOPE_EVERY == 0 ? 1.0F : 0.0F;
    return input;
}

} // namespace wadi
