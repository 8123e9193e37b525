#include "engine/reads/checking.hpp"
#include "engine/settings/data/quanta.hpp"
#include <cmath>

namespace wadi {

namespace {

std::string text(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", value);
    return digits;
}

} // namespace

Status Checking::look() {
    if (auto status = stepper_.finish_step(); !status) return status;
    auto stats = reader_.stats();
    return stats ? look(*stats) : stats.status();
}

Status Checking::look(const WorldStats& stats) {
    if (stats.not_finite > 0)
        return broken(
            "", [](double value) { return !std::isfinite(value); }, "every number is finite");
    if (state_.settings().method.published()) return ok_status();
    if (stats.smallest_height < 0)
        return broken(
            "_height", [](double value) { return value < 0; }, "no height is negative");
    if (auto status = check_speeds(stats); !status) return status;
    return check_books(stats);
}

Status Checking::check_speeds(const WorldStats& stats) {
    const auto& settings = state_.settings();
    const double cell = settings.method.velocity_clamp * settings.grid.dx, water = cell / settings.water_dt(),
                 sand = cell / settings.dt * settings.method.substeps;
    const auto check = [&](double fastest, double clamp, const std::vector<const char*>& layers) {
        const double most = clamp * (1 + 1e-6); // as floats
        if (!(fastest > most)) return ok_status();
        for (const char* layer : layers) {
            auto status = broken(
                layer, [&](double speed) { return std::abs(speed) > most; },
                "no speed is above its clamp, " + text(clamp) + " m/s");
            if (!status) return status;
        }
        return ok_status();
    };
    auto status =
        check(stats.largest_water_speed, water, {"water_velocity_x", "water_velocity_y", "mixed_velocity_x", "mixed_velocity_y"});
    return status ? check(stats.largest_sand_speed, sand, {"sand_velocity_x", "sand_velocity_y"}) : status;
}

Status Checking::check_books(const WorldStats& stats) {
    const auto& method = state_.settings().method;
    if (height_quantum(method) <= 0) return ok_status();
    auto terrain = reader_.read_raw("terrain");
    if (!terrain) return terrain.status();
    double ground = 0;
    for (const float height : *terrain) ground = std::max(ground, std::abs(static_cast<double>(height)));
    // Twice: a column may stand higher between two sand steps than at the end of either step.
    high_ = high_ || !(ground + 2 * (stats.largest_sand + stats.largest_water) < method.largest_height);
    if (high_) return ok_status();
    const auto& ledger = stats.ledger;
    const std::int64_t water = stats.water_quanta - (stats.water_initial + ledger.water_in - ledger.water_out),
                       sand = stats.sand_quanta - (stats.sand_initial + ledger.sand_in - ledger.sand_out);
    if (water == 0 && sand == 0) return ok_status();
    return error(Code::internal, "checking: after step " + std::to_string(state_.steps) + " the world holds " +
                                     std::to_string(water) + " quanta of water and " + std::to_string(sand) +
                                     " of sand more than its books; promised: initial + in - out = now, to the quantum");
}

Status Checking::broken(const std::string& ending, const std::function<bool(double)>& wrong, const std::string& promise) {
    const auto& layout = state_.layout();
    const std::string when = "checking: after step " + std::to_string(state_.steps) + " ";
    for (const FieldRow& field : field_table()) {
        const std::string name(field.name);
        if (!field.hashed || !name.ends_with(ending) || state_.plan().find(name) == nullptr) continue;
        const bool rim = field.role == FieldRole::rim;
        std::vector<float> values(rim ? static_cast<std::size_t>(layout.rim()) * 4 : layout.size());
        if (auto status = state_.fields().read(name, 0, values); !status) return status;
        const int nx = rim ? static_cast<int>(values.size()) : layout.nx + (field.place == FieldPlace::west_face ? 1 : 0),
                  ny = rim ? 1 : layout.ny + (field.place == FieldPlace::south_face ? 1 : 0);
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) {
                const double value = static_cast<double>(values[rim ? static_cast<std::size_t>(i) : layout.index(i, j)]);
                if (!wrong(value)) continue;
                const std::string place = rim ? std::to_string(i) : std::to_string(i) + ", " + std::to_string(j);
                return error(Code::internal, when + name + "(" + place + ") is " + text(value) + "; promised: " + promise);
            }
        }
    }
    return ok_status();
}

} // namespace wadi
