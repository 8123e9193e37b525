#include "tests/conformance/pass_runner.hpp"
#include "engine/settings/data/rain_map.hpp"
#include "engine/step/plan/source_shapes.hpp"
#include "engine/step/plan/world_params.hpp"
#include "engine/step/run/field_store.hpp"
#include <algorithm>
#include <cmath>

namespace wadi::conformance {

namespace {

// A state field as a World starts from it: heights in whole quanta, face velocities as means of two cells, ghosts 0 and the
// terrain's edge repeated.
std::vector<float> initial_field(const Scene& scene, const std::string& base) {
    const auto& f = scene.fields;
    const FieldLayout layout{scene.settings.grid.nx, scene.settings.grid.ny};
    const bool sand = base.starts_with("sand_"), x = base.ends_with("velocity_x"), y = base.ends_with("velocity_y");
    const std::vector<float> none;
    const auto& cells = base == "terrain"           ? f.terrain
                        : base.ends_with("_height") ? (sand ? f.sand : f.water)
                        : x                         ? (sand ? f.sand_velocity_x : f.velocity_x)
                        : y                         ? (sand ? f.sand_velocity_y : f.velocity_y)
                                                    : none;
    std::vector<float> field(layout.size(), 0.0F);
    if (cells.empty()) return field;
    const double quantum = height_quantum(scene.settings.method);
    const auto at = [&](int i, int j) {
        const float value =
            cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(layout.nx) + static_cast<std::size_t>(i)];
        if (x || y || quantum <= 0) return value;
        return static_cast<float>(std::nearbyint(static_cast<double>(value) / quantum) * quantum);
    };
    const int reach = base == "terrain" ? GHOST : 0;
    for (int j = -reach; j < layout.ny + (reach > 0 ? 1 + reach : 0); ++j) {
        for (int i = -reach; i < layout.nx + (reach > 0 ? 1 + reach : 0); ++i) {
            const int ci = std::clamp(i, 0, layout.nx - 1), cj = std::clamp(j, 0, layout.ny - 1);
            if ((x && i == 0) || (y && j == 0)) continue; // a wall
            const float value = at(ci, cj);
            field[layout.index(i, j)] = x ? 0.5F * (value + at(ci - 1, cj)) : y ? 0.5F * (value + at(ci, cj - 1)) : value;
        }
    }
    return field;
}

} // namespace

PassRunner::PassRunner(compute::Device& device, const Scene& scene, PlanChoice choice)
    : device_(device), scene_(scene), plan_(make_step_plan(scene.effects, scene.settings.method.substeps, choice)),
      params_(derive_params(scene.settings, scene.effects)) {}

PassRunner::~PassRunner() {
    for (const auto& [name, pair] : buffers_)
        for (const compute::Buffer buffer : pair) device_.destroy_buffer(buffer);
}

std::size_t PassRunner::words_of(const PlanField& field) const {
    if (field.role == FieldRole::shapes) return std::size_t{SOURCE_VECTORS * 4};
    if (field.role != FieldRole::ledger) return layout().size();
    if (field.name != "source_ledger") return 4 * static_cast<std::size_t>(layout().rim());
    return std::size_t{2 * LEDGER_ENTRIES} * static_cast<std::size_t>(params_.strips * params_.pitch);
}

Status PassRunner::open() {
    for (const auto& field : plan_.fields) {
        for (std::size_t n = 0; n < (field.ping_pong ? 2u : 1u); ++n) {
            auto made = device_.create_buffer({words_of(field) * 4, field.name});
            if (!made) return made.status();
            buffers_[field.name][n] = *made;
        }
    }
    for (const auto& field : plan_.fields) {
        if (field.role != FieldRole::state) continue;
        const auto values = initial_field(scene_, field.name);
        if (auto status = device_.write(buffer(field.name), 0, std::as_bytes(std::span(values))); !status) return status;
    }
    if (plan_.find("roughness") != nullptr) {
        const auto values = with_ghosts(layout(), scene_.settings.roughness, true);
        if (auto status = device_.write(buffer("roughness"), 0, std::as_bytes(std::span(values))); !status) return status;
    }
    if (plan_.find("rain_share") != nullptr) {
        const auto values = with_ghosts(layout(), rain_shares(scene_.settings), true);
        if (auto status = device_.write(buffer("rain_share"), 0, std::as_bytes(std::span(values))); !status) return status;
    }
    if (plan_.find("source_shapes") == nullptr) return ok_status();
    const auto shapes = source_shapes(scene_.settings);
    return device_.write(buffer("source_shapes"), 0, std::as_bytes(std::span(shapes)));
}

std::vector<const PlanPass*> PassRunner::passes(bool first) const {
    std::vector<const PlanPass*> all;
    for (std::size_t n = 0; n < plan_.water_passes.size(); ++n) {
        if (first && n == plan_.start_at)
            for (const auto& pass : plan_.start_passes) all.push_back(&pass);
        all.push_back(&plan_.water_passes[n]);
    }
    for (int t = 0; t < plan_.substeps; ++t)
        for (const auto& pass : plan_.substep_passes) all.push_back(&pass);
    return all;
}

compute::Buffer PassRunner::buffer(const std::string& field) const {
    const bool next = field.ends_with("_next");
    const std::string base = next ? field.substr(0, field.size() - 5) : field;
    const auto found = buffers_.find(base);
    return found == buffers_.end() ? compute::Buffer{} : found->second[next != flipped_.contains(base) ? 1 : 0];
}

Status PassRunner::append(compute::ProgramBuilder& builder, const PlanPass& pass) {
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
    auto pipeline = device_.create_pipeline(pass.stage, plan_.effects, {});
    if (!pipeline) return pipeline.status();
    compute::Dispatch dispatch{
        *pipeline, pass.stage, plan_.effects, {}, compute::extent_range(stage.extent, params_), std::string(stage.name)};
    for (const auto& field : pass.fields) dispatch.slots.push_back(field.empty() ? compute::Buffer{} : buffer(field));
    builder.dispatch(std::move(dispatch));
    for (const auto& name : pass.flips)
        if (flipped_.erase(name) == 0) flipped_.insert(name);
    return ok_status();
}

Status PassRunner::run(const PlanPass& pass, const StepInput& input) {
    compute::ProgramBuilder builder("one pass");
    if (auto status = append(builder, pass); !status) return status;
    auto program = device_.compile(builder, params_);
    if (!program) return program.status();
    auto ticket = device_.submit(*program, input);
    Status status = ticket ? device_.wait(*ticket) : ticket.status();
    device_.destroy_program(*program);
    return status;
}

Result<std::vector<std::uint32_t>> PassRunner::read(compute::Buffer from, const std::string& field) {
    const std::string base = field.ends_with("_next") ? field.substr(0, field.size() - 5) : field;
    std::vector<std::uint32_t> words(words_of(*plan_.find(base)));
    if (auto status = device_.read(from, 0, std::as_writable_bytes(std::span(words))); !status) return status;
    return words;
}

Result<std::vector<std::uint32_t>> PassRunner::read(const std::string& field) { return read(buffer(field), field); }

Status PassRunner::write(const std::string& field, const std::vector<std::uint32_t>& words) {
    return device_.write(buffer(field), 0, std::as_bytes(std::span(words)));
}

double PassRunner::bytes_of(const PlanPass& pass) const {
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
    const auto range = compute::extent_range(stage.extent, params_);
    const double threads = static_cast<double>(range.i1 - range.i0) * static_cast<double>(range.j1 - range.j0);
    const int rows = stage.extent == compute::Extent::strips          ? STRIP
                     : stage.extent == compute::Extent::source_pieces ? params_.source_rows
                                                                      : 1;
    double bytes = 0;
    for (std::size_t b = 0; b < pass.fields.size(); ++b) {
        if (pass.fields[b].empty()) continue;
        const auto& binding = stage.bindings[b];
        if (binding.name == "source_shapes") continue; // a few hundred bytes that every thread shares
        // A thread that walks rows of a field adds once to its counts in the ledger.
        const double each = binding.type == compute::Scalar::f32 ? rows : 1;
        bytes += threads * each * (binding.access == compute::Access::inout ? 2 : 1) * 4;
    }
    return bytes;
}

std::string pass_label(const StepPlan& plan, const std::vector<const PlanPass*>& passes, std::size_t pass) {
    const std::size_t sand = plan.substep_passes.size(), water = passes.size() - sand * static_cast<std::size_t>(plan.substeps);
    std::string label(compute::stage_table()[static_cast<std::size_t>(passes[pass]->stage)].name);
    if (pass >= water) label += " of substep " + std::to_string((pass - water) / sand);
    return label;
}

} // namespace wadi::conformance
