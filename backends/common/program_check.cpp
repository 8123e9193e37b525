#include "backends/common/program_check.hpp"
#include <string_view>

namespace wadi::backends {

namespace {

Status bad(const std::string& where, const std::string& what) { return error(Code::bad_argument, where + ": " + what); }

// Where in a program something is wrong: a text only where something is.
struct Where {
    const compute::ProgramBuilder& program;
    const char* op;
    const compute::Dispatch* dispatch = nullptr;
    const compute::StageInfo* stage = nullptr;
    std::string_view binding = {};

    operator std::string() const {
        std::string text = "program '" + program.label() + "', " + op;
        if (dispatch != nullptr) text += " '" + dispatch->label + "'";
        if (stage != nullptr) text += " of " + std::string(stage->name);
        if (!binding.empty()) text += ", " + std::string(binding);
        return text;
    }
};

template <class Place> Status check_buffer(const Objects& objects, compute::Buffer buffer, const Place& where) {
    if (buffer.id == 0) return bad(where, "the buffer is null");
    if (objects.buffers.count(buffer.id) == 0) return bad(where, "no buffer has the handle " + std::to_string(buffer.id));
    return ok_status();
}

// A buffer for stages and fills.
Status check_device_buffer(const Objects& objects, compute::Buffer buffer, const Where& where) {
    if (auto status = check_buffer(objects, buffer, where); !status) return status;
    const auto& found = objects.buffers.at(buffer.id);
    if (found.host) return bad(where, "buffer '" + found.label + "' is the host's memory, which only copies may use");
    return ok_status();
}

std::string tiles_of(int side) {
    return side == 0 ? "without active tiles" : "over active tiles of " + std::to_string(side) + " cells";
}

class Checker {
  public:
    Checker(const compute::ProgramBuilder& program, const WorldParams& params, const Objects& objects)
        : program_(program), params_(params), objects_(objects) {}

    Status check(const compute::Dispatch& d) const {
        Where here{program_, "dispatch", &d};
        if (auto status = check_stage(d.stage); !status) return bad(here, status.message);
        const auto& stage = compute::stage_table()[static_cast<std::size_t>(d.stage)];
        here.stage = &stage;
        if (auto status = check_pipeline(d, stage, here); !status) return status;
        if (d.tiles.on()) {
            Where lists = here;
            lists.binding = "lists of active tiles";
            for (const auto list : {d.tiles.activity, d.tiles.flags, d.tiles.counts, d.tiles.list, d.tiles.dispatch}) {
                if (auto status = check_device_buffer(objects_, list, lists); !status) return status;
            }
        }
        return check_slots(d, stage, here);
    }

    Status check(const compute::Copy& copy) const {
        const std::string where = "program '" + program_.label() + "', copy";
        if (auto status = check_range(objects_, copy.from, copy.from_offset, copy.bytes, where); !status) return status;
        if (auto status = check_range(objects_, copy.to, copy.to_offset, copy.bytes, where); !status) return status;
        if (copy.from == copy.to) return bad(where, "from and to one buffer, '" + objects_.buffers.at(copy.to.id).label + "'");
        return ok_status();
    }

    Status check(const compute::Fill& fill) const { return check_device_buffer(objects_, fill.buffer, {program_, "fill"}); }

    Status check(const compute::Timestamp&) const { return ok_status(); }

  private:
    Status check_pipeline(const compute::Dispatch& d, const compute::StageInfo& stage, const Where& where) const {
        if (d.pipeline.id == 0) return bad(where, "the pipeline is null");
        const auto found = objects_.pipelines.find(d.pipeline.id);
        if (found == objects_.pipelines.end()) return bad(where, "no pipeline has the handle " + std::to_string(d.pipeline.id));
        const auto& pipeline = found->second;
        if (pipeline.stage != d.stage) {
            const auto& other = compute::stage_table()[static_cast<std::size_t>(pipeline.stage)];
            return bad(where, "the pipeline was made for stage " + std::string(other.name));
        }
        if (pipeline.effects != (d.effects & stage.tested_effects)) return bad(where, "the pipeline was made for other effects");
        const int side = d.tiles.on() ? params_.tile_size : 0;
        if (d.tiles.on() && side < 1) return bad(where, "the parameters have active tiles of " + std::to_string(side) + " cells");
        if (pipeline.group.tile != side) {
            return bad(where,
                       "the pipeline was made to run " + tiles_of(pipeline.group.tile) + ", the dispatch runs " + tiles_of(side));
        }
        return ok_status();
    }

    Status check_slots(const compute::Dispatch& d, const compute::StageInfo& stage, Where where) const {
        if (d.slots.size() != stage.bindings.size()) {
            return bad(where, std::to_string(d.slots.size()) + " slots, the stage has " + std::to_string(stage.bindings.size()));
        }
        std::map<std::uint32_t, bool> written; // by buffer, of those bound so far
        for (const auto& binding : stage.bindings) {
            if (!binding.exists(d.effects)) continue;
            const auto buffer = d.slots[static_cast<std::size_t>(binding.slot)];
            where.binding = binding.name;
            if (auto status = check_device_buffer(objects_, buffer, where); !status) return status;
            const bool writes = binding.access != compute::Access::in;
            const auto [seen, first] = written.emplace(buffer.id, writes);
            if (!first && (seen->second || writes))
                return bad(where, "buffer '" + objects_.buffers.at(buffer.id).label + "' is bound twice and written");
        }
        return ok_status();
    }

    const compute::ProgramBuilder& program_;
    const WorldParams& params_;
    const Objects& objects_;
};

} // namespace

Status check_stage(int stage) {
    const auto count = static_cast<int>(compute::stage_table().size());
    if (stage >= 0 && stage < count) return ok_status();
    return error(Code::bad_argument,
                 "no stage has the index " + std::to_string(stage) + ", only 0 to " + std::to_string(count - 1));
}

Status check_range(const Objects& objects, compute::Buffer buffer, std::uint64_t offset, std::uint64_t bytes,
                   const std::string& what) {
    if (auto status = check_buffer(objects, buffer, what); !status) return status;
    const auto& found = objects.buffers.at(buffer.id);
    if (offset <= found.bytes && bytes <= found.bytes - offset) return ok_status();
    return bad(what, std::to_string(bytes) + " bytes at offset " + std::to_string(offset) + " reach past the " +
                         std::to_string(found.bytes) + " bytes of buffer '" + found.label + "'");
}

Status check_program(const compute::ProgramBuilder& program, const WorldParams& params, const Objects& objects) {
    if (program.inputs() > compute::most_inputs)
        return bad("program '" + program.label() + "'", std::to_string(program.inputs()) + " inputs; a submission has " +
                                                            std::to_string(compute::most_inputs) + " at most");
    const Checker checker(program, params, objects);
    for (const auto& op : program.ops()) {
        if (auto status = std::visit([&](const auto& o) { return checker.check(o); }, op); !status) return status;
    }
    return ok_status();
}

} // namespace wadi::backends
