// Saving and restoring a world's state on the host, to the bit.
#include "engine/world.hpp"

namespace wadi {

Result<Snapshot> World::snapshot() {
    if (auto status = finish_step(); !status) return status;
    Snapshot snapshot;
    snapshot.steps = state_.steps;
    snapshot.effects = state_.plan().effects;
    snapshot.totals = stepper_.inputs().totals();
    const auto& parity = state_.parity();
    for (const auto& field : state_.plan().fields) {
        if (field.role != FieldRole::state && field.role != FieldRole::ledger) continue;
        auto& words = snapshot.fields[field.name];
        words.resize(state_.field_bytes(field) / 4);
        if (auto status =
                state_.note(state_.device().read(state_.buffer(field.name, parity), 0, std::as_writable_bytes(std::span(words))));
            !status)
            return status;
    }
    return snapshot;
}

Status World::restore(const Snapshot& snapshot) {
    if (auto status = finish_step(); !status) return status;
    if (snapshot.effects != state_.plan().effects)
        return error(Code::bad_argument, "restore: the snapshot is of a world with other effects");
    if (snapshot.totals.size() != stepper_.inputs().totals().size())
        return error(Code::bad_argument, "restore: the snapshot is of a world with other sources");
    for (const auto& field : state_.plan().fields) {
        if (field.role != FieldRole::state && field.role != FieldRole::ledger) continue;
        const auto found = snapshot.fields.find(field.name);
        if (found == snapshot.fields.end() || found->second.size() * 4 != state_.field_bytes(field)) {
            return error(Code::bad_argument, "restore: the snapshot's " + field.name + " has another size than this world's");
        }
    }
    // Even parity: the first of the two programs starts from the first buffer of every field.
    state_.set_turn(0);
    for (const auto& [name, words] : snapshot.fields) {
        if (auto status =
                state_.note(state_.device().write(state_.buffer(name, state_.parity()), 0, std::as_bytes(std::span(words))));
            !status)
            return status;
    }
    state_.steps = snapshot.steps;
    stepper_.inputs().set_totals(snapshot.totals);
    frames_.went_back();
    return ok_status();
}

} // namespace wadi
