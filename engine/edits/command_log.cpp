#include "engine/edits/command_log.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/step/run/prestress.hpp"
#include <algorithm>
#include <cstring>

namespace wadi {

std::uint64_t step_of(const Command& command) {
    return std::visit([](const auto& c) { return c.step; }, command);
}

std::uint32_t player_of(const Command& command) {
    if (const auto* edit = std::get_if<Edit>(&command)) return edit->player;
    const auto* source = std::get_if<SourceChange>(&command);
    return source != nullptr ? source->player : 0;
}

namespace {

bool same_image(const Stamp& a, const Stamp& b) {
    return a.nx == b.nx && a.ny == b.ny && std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

void count(std::map<std::uint64_t, CommandCounts>& counts, const Command& command) {
    CommandCounts& of_step = counts[step_of(command)];
    ++(std::holds_alternative<Edit>(command) ? of_step.edits : of_step.others);
}

std::string too_many_text(std::uint64_t step, bool edits) {
    return "more than " + std::to_string(edits ? LOG_EDITS_MOST : LOG_COMMANDS_MOST) +
           (edits ? " edits" : " commands but edits") + " of step " + std::to_string(step) + " are more than a log may hold";
}

// Heights as write_region() takes them, whatever stands in the cell by then.
Status check_values(const RegionWrite& write, double most) {
    const double least = write.layer == EditLayer::terrain ? -most : 0;
    for (const float value : write.values) {
        const auto height = static_cast<double>(value);
        if (!(height >= least && height <= most))
            return error(Code::bad_argument, outside_text("play_commands: a height of a region", height, least, most));
    }
    return ok_status();
}

Content content_written(const RegionWrite& write) {
    const bool some = std::any_of(write.values.begin(), write.values.end(), [](float height) { return height > 0.0F; });
    return {some && write.layer == EditLayer::sand, some && write.layer == EditLayer::water};
}

} // namespace

void CommandLog::note(const Command& command) {
    if (!remember_) return;
    remembered_.push_back(command);
    count(counts_, command);
}

Status CommandLog::check_room(const char* function, std::uint64_t step, bool edits, std::uint32_t more) const {
    if (!remember_) return ok_status();
    const auto found = counts_.find(step);
    const std::uint64_t before = found == counts_.end() ? 0 : edits ? found->second.edits : found->second.others;
    if (before + more <= (edits ? LOG_EDITS_MOST : LOG_COMMANDS_MOST)) return ok_status();
    return error(Code::not_supported, std::string(function) + ": the command log is on, and " + too_many_text(step, edits));
}

Status CommandLog::edit(std::span<const Edit> edits) {
    if (auto status = edits_.check("wadi_world_edit", edits, edits_.stamps()); !status) return status;
    std::map<std::uint64_t, std::uint32_t> added;
    for (const Edit& edit : edits) {
        const std::uint64_t step = edit.step == 0 ? edits_.next_step() : edit.step;
        if (!remember_) break;
        if (auto status = check_room("wadi_world_edit", step, true, ++added[step]); !status) return status;
    }
    for (Edit edit : edits) {
        if (edit.step == 0) edit.step = edits_.next_step();
        note(edit);
        edits_.schedule(edit);
    }
    return ok_status();
}

Status CommandLog::set_source(SourceChange change) {
    constexpr const char* function = "wadi_world_set_source";
    if (change.step == 0) change.step = edits_.next_step();
    if (auto status = check_step(function, change.step); !status) return status;
    if (auto status = sources_.check(function, change); !status) return status;
    if (auto status = check_room(function, change.step, false, 1); !status) return status;
    note(change);
    sources_.schedule(std::move(change));
    return ok_status();
}

Status CommandLog::check_step(const char* function, std::uint64_t step) const {
    if (step >= edits_.next_step()) return ok_status();
    return error(Code::bad_argument, std::string(function) + ": source.step: " + std::to_string(step) +
                                         " has been simulated or is under way; the next one is " +
                                         std::to_string(edits_.next_step()) + ", or 0");
}

Status CommandLog::write_region(EditLayer layer, const Region& region, std::span<const float> values) {
    auto status = stepper_.finish_step();
    if (status) status = check_room("write_region", state_.steps, false, 1);
    if (status) status = wadi::write_region(state_, stepper_, layer, region, values);
    if (status && remember_) note(RegionWrite{state_.steps, layer, region, {values.begin(), values.end()}});
    return status;
}

Status CommandLog::write_values(EditLayer layer, const Region& region, const ValueSource& from) {
    if (remember_)
        return error(Code::not_supported,
                     "the command log is on and cannot remember values that the host does not see; write them "
                     "with wadi_world_write_region");
    auto status = stepper_.finish_step();
    return status ? values_.write(layer, region, from) : status;
}

Status CommandLog::trim() {
    auto status = stepper_.finish_step();
    if (status) status = check_room("trim", state_.steps, false, 1);
    if (status) status = wadi::trim(state_, stepper_);
    if (status) note(Trim{state_.steps});
    return status;
}

Status CommandLog::set_material(int key, double value) {
    if (auto status = stepper_.finish_step(); !status) return status;
    if (auto status = check_room("set_material", state_.steps, false, 1); !status) return status;
    auto status = change_material(key, value);
    if (status) note(MaterialChange{state_.steps, key, value});
    return status;
}

Status CommandLog::change_material(int key, double value) {
    if (auto status = check_material_change("set_material", state_.settings(), key, value); !status) return status;
    const Material before = state_.settings().material;
    Material material = before;
    set_material_value(material, key, value);
    auto status = stepper_.set_material(material);
    if (status && state_.steps == 0 && material != before) {
        status = balance_anew(state_); // as a level with that value begins
    } else if (status && before.young_modulus == 0 && material.young_modulus > 0) {
        status = put_in_balance(state_);
    }
    return status;
}

void CommandLog::remember(bool on) {
    remember_ = on;
    remembered_.clear();
    counts_.clear();
}

std::vector<std::byte> CommandLog::bytes() const { return write_commands(state_.level(), edits_.stamps(), remembered_); }

std::vector<std::byte> CommandLog::bytes(std::uint64_t since, std::optional<std::uint32_t> player) const {
    std::vector<Command> commands;
    std::vector<Stamp> stamps;
    std::map<std::uint32_t, std::uint32_t> number_of; // in this log, by that of the world
    for (const Command& command : remembered_) {
        if (step_of(command) < since || (player && player_of(command) != *player)) continue;
        commands.push_back(command);
        auto* const edit = std::get_if<Edit>(&commands.back());
        if (edit == nullptr || edit->kind != EditKind::stamp) continue;
        const auto [found, is_new] = number_of.try_emplace(edit->stamp, static_cast<std::uint32_t>(stamps.size() + 1));
        if (is_new) stamps.push_back(edits_.stamps()[edit->stamp - 1]);
        edit->stamp = found->second;
    }
    return write_commands(state_.level(), stamps, commands);
}

Status CommandLog::check(const CommandList& list) const {
    if (list.level != state_.level())
        return error(Code::bad_argument, "play_commands: the log is of a level with other settings");
    for (const auto& stamp : list.stamps) {
        if (auto status = check_stamp("play_commands", stamp.nx, stamp.ny, stamp.values); !status) return status;
    }
    Settings settings = state_.settings(); // as the commands before leave them
    std::map<std::uint64_t, CommandCounts> counts;
    std::vector<const Command*> by_step;
    for (const auto& command : list.commands) {
        by_step.push_back(&command);
        count(counts, command);
    }
    for (const auto& [step, of_step] : counts)
        if (of_step.edits > LOG_EDITS_MOST || of_step.others > LOG_COMMANDS_MOST)
            return error(Code::bad_argument, "play_commands: " + too_many_text(step, of_step.edits > LOG_EDITS_MOST));
    for (const auto& [step, of_step] : counts) {
        if (auto status = check_room("play_commands", step, true, of_step.edits); !status) return status;
        if (auto status = check_room("play_commands", step, false, of_step.others); !status) return status;
    }
    // A log lists its commands as they came, edits of later steps among them; they run by step.
    std::stable_sort(by_step.begin(), by_step.end(),
                     [](const Command* a, const Command* b) { return step_of(*a) < step_of(*b); });
    for (const Command* each : by_step) {
        const Command& command = *each;
        if (step_of(command) < edits_.next_step()) {
            return error(Code::bad_argument, "play_commands: the log has a command for step " + std::to_string(step_of(command)) +
                                                 ", but the world's next step is " + std::to_string(edits_.next_step()));
        }
        if (const auto* edit = std::get_if<Edit>(&command)) {
            if (auto status = edits_.check("play_commands", std::span(edit, 1), list.stamps); !status) return status;
        } else if (const auto* write = std::get_if<RegionWrite>(&command)) {
            const auto& grid = state_.settings().grid;
            if (auto status = check_region("play_commands", write->region, grid, write->values.size()); !status) return status;
            if (auto status = check_values(*write, state_.settings().method.largest_height); !status) return status;
            if (auto status = check_allowed(settings, content_written(*write)); !status)
                return error(Code::bad_argument, "play_commands: " + status.message);
        } else if (const auto* source = std::get_if<SourceChange>(&command)) {
            if (auto status = sources_.check("play_commands", *source); !status) return status;
        } else if (const auto* change = std::get_if<MaterialChange>(&command)) {
            if (auto status = check_material_change("play_commands", settings, change->key, change->value); !status)
                return status;
            set_material_value(settings.material, change->key, change->value);
        }
    }
    return ok_status();
}

Result<Cost> CommandLog::cost(std::span<const std::byte> bytes) const {
    auto list = read_commands(bytes);
    if (!list) return list.status();
    if (auto status = check(*list); !status) return status;
    Cost cost;
    cost.cells = static_cast<std::uint64_t>(state_.layout().nx) * static_cast<std::uint64_t>(state_.layout().ny);
    cost.file_bytes = bytes.size();
    cost.host_bytes = 2 * bytes.size() + 2 * list->commands.size() * sizeof(Command); // the list, and what waits for its step
    for (const auto& stamp : list->stamps) cost.device_bytes += 4 * stamp.values.size();
    std::map<std::uint64_t, CommandCounts> counts;
    for (const auto& command : list->commands) count(counts, command);
    for (const auto& [step, of_step] : counts) {
        cost.steps = step;
        cost.edits_per_step = std::max<std::uint64_t>(cost.edits_per_step, of_step.edits);
        cost.commands_per_step = std::max<std::uint64_t>(cost.commands_per_step, of_step.others);
    }
    return cost;
}

Status CommandLog::play(std::span<const std::byte> bytes) {
    auto list = read_commands(bytes);
    if (!list) return list.status();
    if (auto status = check(*list); !status) return status;
    const auto stamps = take_stamps(list->stamps);
    if (!stamps) return stamps.status();
    for (const auto& command : list->commands) {
        if (const auto* found = std::get_if<Edit>(&command)) {
            Edit edit = *found;
            if (edit.kind == EditKind::stamp) edit.stamp = (*stamps)[edit.stamp - 1];
            note(edit);
            edits_.schedule(edit);
        } else if (const auto* source = std::get_if<SourceChange>(&command)) {
            note(*source);
            sources_.schedule(*source);
        } else {
            note(command); // a log read before it runs has it, too
            played_.emplace(step_of(command), command);
        }
    }
    return stepper_.parts_done() == 0 ? at_boundary() : ok_status();
}

Result<std::vector<std::uint32_t>> CommandLog::take_stamps(std::span<const Stamp> stamps) {
    std::vector<std::uint32_t> numbers;
    for (const Stamp& stamp : stamps) {
        const auto& own = edits_.stamps();
        const auto like = std::find_if(own.begin(), own.end(), [&](const Stamp& each) { return same_image(each, stamp); });
        auto number = like != own.end() ? Result<std::uint32_t>(static_cast<std::uint32_t>(like - own.begin()) + 1)
                                        : edits_.create_stamp(stamp.nx, stamp.ny, stamp.values);
        if (!number) return number.status();
        numbers.push_back(*number);
    }
    return numbers;
}

Status CommandLog::run(const Command& command) {
    if (auto status = stepper_.finish_step(); !status) return status;
    if (const auto* write = std::get_if<RegionWrite>(&command))
        return wadi::write_region(state_, stepper_, write->layer, write->region, write->values);
    if (const auto* change = std::get_if<MaterialChange>(&command)) return change_material(change->key, change->value);
    return wadi::trim(state_, stepper_);
}

Status CommandLog::at_boundary() {
    while (!played_.empty() && played_.begin()->first <= state_.steps) {
        const Command command = std::move(played_.begin()->second);
        played_.erase(played_.begin());
        if (auto status = run(command); !status) return status;
    }
    return ok_status();
}

void CommandLog::went_to(std::uint64_t step) {
    edits_.forget();
    sources_.forget();
    played_.clear();
    std::erase_if(remembered_, [&](const Command& command) { return step_of(command) >= step; });
    counts_.erase(counts_.lower_bound(step), counts_.end());
}

} // namespace wadi
