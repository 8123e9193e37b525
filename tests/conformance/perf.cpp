#include "tests/conformance/perf.hpp"
#include "engine/edits/edits.hpp"
#include "engine/step/run/step_inputs.hpp"
#include "tests/conformance/masks.hpp"
#include "tests/conformance/pass_runner.hpp"
#include "tests/conformance/report.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>

namespace wadi::conformance {

namespace {

using compute::Device;
using compute::ProgramBuilder;

constexpr std::uint32_t ALL = (all_effects & ~(EFFECT_BED_SHEAR | EFFECT_ROUGHNESS | EFFECT_RAIN_MAP | only_seen)) |
                              EFFECT_SHOCK_VISCOSITY; // without what is off unless a level asks for it
constexpr std::uint32_t SAND_LAWS = EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION | EFFECT_RETENTION; // ours, the paper has none
constexpr double wake_up_ms = 700, warm_up_ms = 150; // busy ahead of the first row, and of each
constexpr int burst = 4;                             // submissions in flight while the host is timed: below every backend's queue
constexpr std::uint64_t least_copy_bytes = 64u << 20; // past the caches of most devices

struct Row {
    std::string name = {};
    int size = 0;
    double bytes = 0; // moved by one run
    std::vector<double> milliseconds = {};
    // Whole steps only.
    double floor_bytes = 0, bytes_per_cell = 0, world_bytes = 0;
    std::vector<double> host_microseconds = {}; // of submit()
};

double quantile(std::vector<double> values, double q) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(q * static_cast<double>(values.size())))];
}

double since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Runs programs in turn; the time of each by the device's clock, or by the host's where the device has none. An idle device
// lowers its clocks, so rows begin when it has been busy for a while.
Result<std::vector<double>> time_programs(Device& device, const std::vector<compute::Program>& programs,
                                          const std::vector<StepInput>& inputs, int repeats, double busy_ms = warm_up_ms) {
    std::vector<double> milliseconds;
    std::size_t turn = 0;
    for (const auto begin = std::chrono::steady_clock::now(); turn < 2 || since(begin) < busy_ms;) {
        Status status;
        compute::Ticket last;
        for (int n = 0; n < burst && status; ++n, ++turn) {
            auto ticket = device.submit(programs[turn % programs.size()], inputs[turn % inputs.size()]);
            status = ticket ? ok_status() : ticket.status();
            if (ticket) last = *ticket;
        }
        if (status) status = device.wait(last);
        if (!status) return status;
    }
    for (int n = 0; n < repeats; ++n, ++turn) {
        const auto start = std::chrono::steady_clock::now();
        auto ticket = device.submit(programs[turn % programs.size()], inputs[turn % inputs.size()]);
        if (!ticket) return ticket.status();
        if (auto status = device.wait(*ticket); !status) return status;
        double elapsed = since(start);
        if (device.capabilities().timestamps) {
            auto times = device.timings(*ticket);
            if (!times) return times.status();
            elapsed = 0;
            for (const auto& time : *times) elapsed += time.milliseconds;
        }
        milliseconds.push_back(elapsed);
    }
    return milliseconds;
}

// What submit() costs the calling thread, in bursts that never wait for the queue of submissions [us].
Result<std::vector<double>> time_host(Device& device, const std::vector<compute::Program>& programs, const StepInput& input,
                                      int repeats) {
    std::vector<double> microseconds;
    while (microseconds.size() < static_cast<std::size_t>(repeats)) {
        compute::Ticket last;
        for (int n = 0; n < burst; ++n) {
            const auto start = std::chrono::steady_clock::now();
            auto ticket = device.submit(programs[static_cast<std::size_t>(n) % programs.size()], input);
            microseconds.push_back(1e3 * since(start));
            if (!ticket) return ticket.status();
            last = *ticket;
        }
        if (auto status = device.wait(last); !status) return status;
    }
    return microseconds;
}

Result<std::vector<double>> time_program(Device& device, const ProgramBuilder& builder, const WorldParams& params,
                                         const StepInput& input, int repeats, double busy_ms = warm_up_ms) {
    auto program = device.compile(builder, params);
    if (!program) return program.status();
    auto times = time_programs(device, {*program}, {input}, repeats, busy_ms);
    device.destroy_program(*program);
    return times;
}

// Best of a device-side copy and of the stage nearest to one (publish_velocity reads two fields and writes two) [bytes/s].
struct Ceiling {
    double copy = 0, stage = 0;
    double best() const { return std::max(copy, stage); }
};

Result<double> measure_copy(Device& device, std::uint64_t bytes, int repeats) {
    auto from = device.create_buffer({bytes, "copy from"});
    if (!from) return from.status();
    auto to = device.create_buffer({bytes, "copy to"});
    if (!to) {
        device.destroy_buffer(*from);
        return to.status();
    }
    ProgramBuilder builder("copy");
    builder.timestamp("start");
    builder.copy({*from, *to, 0, 0, bytes});
    builder.timestamp("copy");
    auto times = time_program(device, builder, WorldParams{}, StepInput{}, repeats, wake_up_ms);
    device.destroy_buffer(*from);
    device.destroy_buffer(*to);
    if (!times) return times.status();
    return 2 * static_cast<double>(bytes) / (quantile(*times, 0.5) * 1e-3);
}

Result<double> measure_copy_stage(Device& device, PassRunner& runner, int repeats) {
    const int stage = compute::find_stage("publish_velocity");
    auto pipeline = device.create_pipeline(stage, 0, {});
    if (!pipeline) return pipeline.status();
    ProgramBuilder builder("copy stage");
    builder.timestamp("start");
    builder.dispatch({*pipeline,
                      stage,
                      0,
                      {runner.buffer("water_velocity_x"), runner.buffer("water_velocity_y"),
                       runner.buffer("water_velocity_x_next"), runner.buffer("water_velocity_y_next")},
                      compute::extent_range(compute::Extent::cells, runner.params()),
                      "publish_velocity"});
    builder.timestamp("publish_velocity");
    auto times = time_program(device, builder, runner.params(), StepInput{}, repeats);
    if (!times) return times.status();
    const double cells = static_cast<double>(runner.params().nx) * runner.params().ny;
    return 16 * cells / (quantile(*times, 0.5) * 1e-3);
}

Result<Ceiling> measure_ceiling(Device& device, int size, int repeats) {
    auto scene = make_large_scene(size, "random", EFFECT_WATER);
    if (!scene) return scene.status();
    PassRunner runner(device, *scene);
    if (auto status = runner.open(); !status) return status;
    const std::uint64_t most = device.capabilities().largest_buffer_bytes / 2 / 4 * 4;
    auto copy =
        measure_copy(device, std::min(most, std::max<std::uint64_t>(least_copy_bytes, runner.layout().size() * 4)), repeats);
    if (!copy) return copy.status();
    auto stage = measure_copy_stage(device, runner, repeats);
    if (!stage) return stage.status();
    return Ceiling{*copy, *stage};
}

std::vector<StepInput> inputs_of(const Scene& scene, int count) {
    StepInputs inputs(scene.settings);
    std::vector<StepInput> all;
    for (int n = 0; n < count; ++n) all.push_back(inputs.next(n));
    return all;
}

// Each stage of a step under all effects, once per pass; of a fused step only what the other has not.
Status measure_stages(Device& device, int size, bool fused, const PerfOptions& options, std::vector<Row>& rows) {
    auto scene = make_large_scene(size, options.scene, ALL);
    if (!scene) return scene.status();
    PassRunner runner(device, *scene, {.fused = fused, .fused_slopes = device.tuning().fused_slopes});
    if (auto status = runner.open(); !status) return status;
    const auto inputs = inputs_of(*scene, 1);
    bool slept = true; // while the host made the scene
    for (const auto* passes : {&runner.plan().water_passes, &runner.plan().substep_passes}) {
        for (const PlanPass& pass : *passes) {
            const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
            const std::string name(stage.name);
            ProgramBuilder builder(name);
            builder.timestamp("start");
            if (auto status = runner.append(builder, pass); !status) return status;
            builder.timestamp(name);
            const bool wanted = (options.stage.empty() || options.stage == name) && stage.fused() == fused;
            const double busy = !wanted ? 0 : slept ? wake_up_ms : warm_up_ms;
            if (wanted) slept = false;
            auto times = time_program(device, builder, runner.params(), inputs[0], wanted ? options.repeats : 1, busy);
            if (!times) return times.status();
            if (wanted) rows.push_back({.name = name, .size = size, .bytes = runner.bytes_of(pass), .milliseconds = *times});
        }
    }
    return ok_status();
}

// Whole steps; the least bytes a step can move are its state in and out once.
Status measure_step(Device& device, int size, const std::string& name, std::uint32_t effects, bool fused,
                    const PerfOptions& options, std::vector<Row>& rows) {
    auto scene = make_large_scene(size, options.scene, effects);
    if (!scene) return scene.status();
    PassRunner runner(device, *scene, {.fused = fused, .fused_slopes = device.tuning().fused_slopes});
    const auto passes = runner.passes();
    const bool has = std::any_of(passes.begin(), passes.end(), [](const PlanPass* pass) {
        return compute::stage_table()[static_cast<std::size_t>(pass->stage)].fused();
    });
    if (fused && !has) return ok_status(); // the row without is the same
    if (auto status = runner.open(); !status) return status;
    Row row{.name = name, .size = size, .bytes_per_cell = runner.plan().bytes_per_cell()};
    row.world_bytes = static_cast<double>(runner.layout().size()) * runner.plan().bytes_per_cell();
    std::vector<compute::Program> timed, plain; // a step for each parity, with timestamps and without
    Status status;
    for (int parity = 0; parity < 2 && status; ++parity) {
        ProgramBuilder with(name), without(name);
        with.timestamp("start");
        for (const PlanPass* pass : runner.passes()) {
            if (parity == 0) row.bytes += runner.bytes_of(*pass);
            if (status = runner.append(with, *pass); !status) break;
            without.dispatch(std::get<compute::Dispatch>(with.ops().back()));
        }
        with.timestamp("step");
        for (auto* built : {&with, &without}) {
            auto program = status ? device.compile(*built, runner.params()) : Result<compute::Program>(status);
            status = program.status();
            if (program) (built == &with ? timed : plain).push_back(*program);
        }
    }
    const double cells = static_cast<double>(size) * size;
    for (const auto& field : runner.plan().fields)
        if (field.role == FieldRole::state)
            row.floor_bytes += cells * PlanField::element_bytes * (field.name == "terrain" ? 1 : 2);
    const auto inputs = inputs_of(*scene, options.repeats + 2);
    auto times = status ? time_programs(device, timed, inputs, options.repeats) : Result<std::vector<double>>(status);
    auto host = times ? time_host(device, plain, inputs[0], 5 * options.repeats) : times;
    for (const auto* programs : {&timed, &plain})
        for (const compute::Program program : *programs) device.destroy_program(program);
    if (!host) return host.status();
    row.milliseconds = *times;
    row.host_microseconds = *host;
    rows.push_back(row);
    return ok_status();
}

// A stage outside the step, its buffers the fields of `runner` or `extra`.
Status measure_beside_step(Device& device, PassRunner& runner, const char* stage_name, const StepInput& input,
                           const std::map<std::string, compute::Buffer>& extra, Row row, const PerfOptions& options,
                           std::vector<Row>& rows) {
    const int index = compute::find_stage(stage_name);
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(index)];
    auto pipeline = device.create_pipeline(index, ALL, {});
    if (!pipeline) return pipeline.status();
    compute::Dispatch dispatch{*pipeline, index, ALL, {}, compute::extent_range(stage.extent, runner.params(), input.point_count),
                               stage_name};
    for (const auto& binding : stage.bindings) {
        const auto found = extra.find(std::string(binding.name));
        dispatch.slots.push_back(found != extra.end() ? found->second : runner.buffer(std::string(binding.name)));
    }
    ProgramBuilder builder(stage_name);
    builder.timestamp("start");
    builder.dispatch(std::move(dispatch));
    builder.timestamp(stage_name);
    auto times = time_program(device, builder, runner.params(), input, options.repeats);
    if (!times) return times.status();
    row.milliseconds = *times;
    rows.push_back(std::move(row));
    return ok_status();
}

// What a host asks for beside the step: one brush 64 cells wide, 1000 points, which limits spoke.
Status measure_host_work(Device& device, int size, const PerfOptions& options, std::vector<Row>& rows) {
    constexpr int points = 1000;
    auto scene = make_large_scene(size, options.scene, ALL);
    if (!scene) return scene.status();
    PassRunner runner(device, *scene);
    if (auto status = runner.open(); !status) return status;
    const double dx = scene->settings.grid.dx, middle = 0.5 * size * dx;
    std::vector<float> xy;
    for (int n = 0; n < points; ++n)
        for (const double step : {0.7548776662, 0.5698402910}) // spread over the grid
            xy.push_back(static_cast<float>(size * dx * std::fmod(step * (n + 1), 1.0)));
    std::map<std::string, compute::Buffer> extra;
    Status status;
    for (const auto& [name, bytes] :
         {std::pair<const char*, std::uint64_t>{"stamp_images", STAMP_PAGE * 4},
          {"points", xy.size() * 4},
          {"samples", std::uint64_t{points} * SAMPLE_FLOATS * 4},
          {"limit_marks", runner.layout().size() * 4},
          {"limit_columns", std::uint64_t{LIMIT_WORDS} * 4 * static_cast<std::uint64_t>(runner.layout().pitch()) *
                                static_cast<std::uint64_t>(runner.layout().strips())},
          {"limit_counts", std::uint64_t{LIMIT_WORDS} * 4 * static_cast<std::uint64_t>(runner.layout().tile_columns()) *
                               static_cast<std::uint64_t>(runner.layout().strips())}}) {
        auto made = device.create_buffer({bytes, name});
        if (made) extra[name] = *made;
        if (status) status = made.status();
    }
    if (status) status = device.write(extra["points"], 0, std::as_bytes(std::span(xy)));
    StepInput brush{}, query{};
    Edit edit;
    edit.layer = EditLayer::sand;
    edit.x0 = edit.y0 = middle;
    edit.radius = 32 * dx;
    edit.softness = 0.5;
    edit.amount = 0; // the same work, and the state stays what it is
    brush.edit_count = pack_edit(edit, {}, scene->settings.grid, brush.edit[0]) ? 1 : 0;
    query.point_count = points;
    if (status)
        status = measure_beside_step(device, runner, "apply_edits", brush, extra, {.name = "one brush of 64 cells", .size = size},
                                     options, rows);
    if (status)
        status = measure_beside_step(device, runner, "sample_points", query, extra, {.name = "1000 points", .size = size},
                                     options, rows);
    for (const char* stage : {"mark_limits", "count_limits", "fold_limits"})
        if (status)
            status = measure_beside_step(device, runner, stage, StepInput{}, extra, {.name = stage, .size = size}, options, rows);
    for (const auto& [name, buffer] : extra) device.destroy_buffer(buffer);
    return status;
}

const char* clock_of(const Device& device) { return device.capabilities().timestamps ? "device" : "host"; }

void print_head(const Session& session, const Device& device, const PerfOptions& options, const Ceiling& ceiling, bool first) {
    if (options.csv && first)
        std::printf(
            "backend,device,driver,clock,row,size,repeats,median_ms,p95_ms,bytes,GB_per_s,share_of_ceiling,cells_per_s,"
            "floor_ms,bytes_per_cell,world_bytes,host_us_median,host_us_p95,ceiling_copy_GB_per_s,ceiling_stage_GB_per_s\n");
    if (!options.csv) {
        std::printf(
            "\n%s: %s (%s), %s clock, %d repeats\ncopy ceiling %.1f GB/s (Copy operation %.1f, stage publish_velocity %.1f)\n",
            session.target().label().c_str(), device.capabilities().name.c_str(), device.capabilities().driver.c_str(),
            clock_of(device), options.repeats, ceiling.best() * 1e-9, ceiling.copy * 1e-9, ceiling.stage * 1e-9);
        std::printf("%-30s %6s %10s %10s %9s %7s %10s %9s %7s %9s %9s %9s\n", "row", "size", "median ms", "p95 ms", "GB/s",
                    "share", "Mcells/s", "floor ms", "B/cell", "world MiB", "host us", "host p95");
    }
    std::fflush(stdout);
}

// Takes the rows away: what is measured is seen at once, and kept where the rest is broken off.
void print_rows(const Session& session, const Device& device, const PerfOptions& options, const Ceiling& ceiling,
                std::vector<Row>& rows) {
    const std::string label = session.target().label();
    for (const Row& row : rows) {
        const double median = quantile(row.milliseconds, 0.5), p95 = quantile(row.milliseconds, 0.95);
        const double rate = row.bytes / (median * 1e-3), cells = static_cast<double>(row.size) * row.size / (median * 1e-3);
        const double floor_ms = row.floor_bytes / ceiling.best() * 1e3;
        const bool step = row.floor_bytes > 0;
        const double host = quantile(row.host_microseconds, 0.5), host_p95 = quantile(row.host_microseconds, 0.95);
        if (options.csv) {
            std::printf("%s,%s,%s,%s,%s,%d,%zu,%.6f,%.6f,%.0f,%.3f,%.4f,%.0f,", label.c_str(),
                        csv_field(device.capabilities().name).c_str(), csv_field(device.capabilities().driver).c_str(),
                        clock_of(device), csv_field(row.name).c_str(), row.size, row.milliseconds.size(), median, p95, row.bytes,
                        rate * 1e-9, rate / ceiling.best(), cells);
            step ? std::printf("%.6f,%.1f,%.0f,%.2f,%.2f,", floor_ms, row.bytes_per_cell, row.world_bytes, host, host_p95)
                 : std::printf(",,,,,");
            std::printf("%.3f,%.3f\n", ceiling.copy * 1e-9, ceiling.stage * 1e-9);
        } else {
            std::printf("%-30s %6d %10.4f %10.4f %9.2f %6.0f%% %10.1f", row.name.c_str(), row.size, median, p95, rate * 1e-9,
                        100 * rate / ceiling.best(), cells * 1e-6);
            step ? std::printf(" %9.4f %7.0f %9.1f %9.2f %9.2f\n", floor_ms, row.bytes_per_cell, row.world_bytes / 1048576, host,
                               host_p95)
                 : std::printf("\n");
        }
    }
    rows.clear();
    std::fflush(stdout);
}

} // namespace

Status run_perf(Session& session, const PerfOptions& options, bool first) {
    auto device = session.device();
    if (!device) return device.status();
    auto ceiling = measure_ceiling(**device, options.max_size, options.repeats);
    if (!ceiling) return ceiling.status();
    print_head(session, **device, options, *ceiling, first);
    std::vector<Row> rows;
    const auto told = [&](Status status) {
        print_rows(session, **device, options, *ceiling, rows);
        return status;
    };
    std::vector<bool> kinds = {false};
    if ((*device)->tuning().fused_gain_cells > 0) kinds.push_back(true);
    for (int size = options.min_size; size <= options.max_size; size *= 2) {
        for (const bool fused : kinds)
            if (auto status = told(measure_stages(**device, size, fused, options, rows)); !status) return status;
        if (!options.stage.empty()) continue;
        constexpr std::pair<const char*, std::uint32_t> steps[] = {
            {"step, all effects", ALL},
            {"step, all effects and infiltration", ALL | EFFECT_INFILTRATION},
            {"step, all effects, what is seen", ALL | only_seen},
            {"step, sand of the paper", ALL & ~SAND_LAWS},
            {"step, published", (ALL & ~never_published) | EFFECT_PUBLISHED},
            {"step, water only", EFFECT_WATER},
            {"step, dry sand", EFFECT_SAND | EFFECT_ELASTOPLASTIC | EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION}};
        for (const auto& [name, effects] : steps) {
            for (const bool fused : kinds) {
                const std::string row = name + std::string(fused ? ", fused" : "");
                if (auto status = told(measure_step(**device, size, row, effects, fused, options, rows)); !status) return status;
            }
        }
        if (auto status = told(measure_host_work(**device, size, options, rows)); !status) return status;
    }
    return ok_status();
}

} // namespace wadi::conformance
