#include "world.hpp"
#include <algorithm>
#include <cstdio>
#include <thread>

namespace recorder {
namespace {

void print_log(void*, wadi_log_level severity, const char* message) {
    static constexpr const char* names[] = {"error", "warning", "note"};
    std::fprintf(stderr, "%s: %s\n", names[severity < 0 || severity > 2 ? 2 : severity], message);
}

} // namespace

World::~World() {
    if (id_.index != 0 || id_.generation != 0) wadi_destroy_world(id_);
}

Failure World::fault(const char* action) const { return {EXIT_DEVICE_FAULT, std::string(action) + ": " + wadi_get_last_error()}; }

Failure World::create(const Options& options) {
    if (wadi_get_abi_version() != WADI_ABI_VERSION) {
        return {EXIT_BAD_INPUT, "the loaded wadi library has ABI version " + std::to_string(wadi_get_abi_version()) +
                                    ", this program needs " + std::to_string(WADI_ABI_VERSION)};
    }
    wadi_device_options device = wadi_default_device_options();
    device.backend = options.backend.c_str();
    device.device = options.device;
    // No frame wants the core that the library leaves by default.
    device.threads = options.threads != 0 ? options.threads
                                          : static_cast<std::int32_t>(std::clamp(std::thread::hardware_concurrency(), 1U, 256U));
    device.validate = options.validate ? 1 : 0;
    device.log = print_log;

    wadi_level_overrides overrides = wadi_default_level_overrides();
    overrides.nx = options.nx;
    overrides.ny = options.ny;
    overrides.dt = options.dt;
    overrides.active_tiles = static_cast<wadi_active_tiles>(options.active_tiles);
    overrides.fused_stages = static_cast<wadi_choice>(options.fused_stages);
    overrides.any_files = options.any_files ? 1 : 0;
    overrides.method = options.method.empty() ? nullptr : options.method.c_str();
    overrides.variant = options.variant.empty() ? nullptr : options.variant.c_str();
    overrides.accuracy = options.accuracy.empty() ? nullptr : options.accuracy.c_str();

    if (wadi_create_world_from_level(options.level_file.c_str(), &overrides, &device, &id_) != WADI_OK) {
        return {EXIT_BAD_INPUT, wadi_get_last_error()};
    }
    info_ = wadi_default_world_info();
    if (wadi_world_get_info(id_, &info_) != WADI_OK) return fault("reading the world's description");
    for (std::uint32_t n = 0; n < info_.warning_count; ++n) {
        if (const char* warning = wadi_world_get_warning(id_, n)) warnings_.emplace_back(warning);
    }
    if (options.check && wadi_world_set_checking(id_, 1) != WADI_OK) return {EXIT_BAD_INPUT, wadi_get_last_error()};
    if (options.profile && wadi_world_set_profiling(id_, 1) != WADI_OK) return {EXIT_BAD_INPUT, wadi_get_last_error()};
    return {};
}

Failure World::step(std::uint32_t steps) { return wadi_world_step(id_, steps) == WADI_OK ? Failure{} : fault("stepping"); }

Failure World::wait(double& time) {
    const wadi_region one_cell = {0, 0, 1, 1};
    float value = 0;
    if (wadi_world_read_region(id_, WADI_FIELD_TERRAIN, &one_cell, &value, 1) != WADI_OK) return fault("stepping");
    return wadi_world_get_time(id_, &time, nullptr) == WADI_OK ? Failure{} : fault("reading the time");
}

Failure World::read_stats(wadi_world_stats& stats) {
    stats = wadi_default_world_stats();
    return wadi_world_get_stats(id_, &stats) == WADI_OK ? Failure{} : fault("reading the state's extremes");
}

Failure World::read_field(wadi_field field, std::vector<float>& values) {
    values.resize(static_cast<std::size_t>(info_.nx) * static_cast<std::size_t>(info_.ny));
    return wadi_world_read_field(id_, field, values.data(), values.size()) == WADI_OK ? Failure{} : fault("reading a field");
}

Failure World::read_map(int factor, MapFields& fields) {
    MapFields full;
    full.nx = info_.nx;
    full.ny = info_.ny;
    full.dx = info_.dx;
    if (Failure failure = read_field(WADI_FIELD_TERRAIN, full.terrain)) return failure;
    if (Failure failure = read_field(WADI_FIELD_SAND_DEPTH, full.sand)) return failure;
    if (Failure failure = read_field(WADI_FIELD_WATER_DEPTH, full.water)) return failure;
    if (Failure failure = read_field(WADI_FIELD_SATURATION, full.saturation)) return failure;
    fields = factor == 1 ? std::move(full) : reduced(full, factor);
    return {};
}

Failure World::read_points(const std::vector<float>& xy, std::vector<wadi_query_result>& results) {
    constexpr std::size_t MOST = 65536; // points of one query
    results.resize(xy.size() / 2);
    for (std::size_t done = 0; done < results.size(); done += MOST) {
        const auto count = static_cast<std::uint32_t>(std::min(MOST, results.size() - done));
        std::uint64_t ticket = 0;
        if (wadi_world_query(id_, &xy[2 * done], count, &ticket) != WADI_OK) return fault("asking for the state at points");
        wadi_result got = WADI_NOT_READY;
        while (got == WADI_NOT_READY) {
            double time = 0;
            if (Failure failure = wait(time)) return failure; // a query never does
            got = wadi_world_get_query(id_, ticket, &results[done], count, nullptr, nullptr);
        }
        if (got != WADI_OK) return fault("reading the state at points");
    }
    return {};
}

Failure World::read_timings(std::vector<wadi_stage_timing>& timings) {
    std::uint32_t count = 0;
    if (wadi_world_get_stage_timings(id_, nullptr, &count) != WADI_OK) return fault("reading the stage timings");
    timings.resize(count);
    if (count > 0 && wadi_world_get_stage_timings(id_, timings.data(), &count) != WADI_OK)
        return fault("reading the stage timings");
    timings.resize(count);
    return {};
}

std::string World::describe_plan() const {
    std::string text(wadi_world_describe_plan(id_, nullptr, 0) + 1, '\0');
    text.resize(wadi_world_describe_plan(id_, text.data(), text.size()));
    return text;
}

} // namespace recorder
