// Saving and restoring a world's state on the host, to the bit.
#include "engine/world.hpp"

namespace wadi {

Result<Snapshot> World::snapshot() {
    if (!lost_) return lost_;
    Snapshot snapshot;
    snapshot.steps = steps_;
    snapshot.effects = plan_.effects;
    snapshot.totals = inputs_.totals();
    const auto& parity = start_parity_[static_cast<std::size_t>(parity_)];
    for (const auto& field : plan_.fields) {
        if (field.role != FieldRole::state && field.role != FieldRole::ledger) continue;
        auto& words = snapshot.fields[field.name];
        words.resize(field_bytes(field) / 4);
        if (auto status = note(device_->read(buffer(field.name, parity), 0, std::as_writable_bytes(std::span(words)))); !status)
            return status;
    }
    return snapshot;
}

Status World::restore(const Snapshot& snapshot) {
    if (!lost_) return lost_;
    if (snapshot.effects != plan_.effects)
        return error(Code::bad_argument, "restore: the snapshot is of a world with other effects");
    if (snapshot.totals.size() != inputs_.totals().size())
        return error(Code::bad_argument, "restore: the snapshot is of a world with other sources");
    for (const auto& field : plan_.fields) {
        if (field.role != FieldRole::state && field.role != FieldRole::ledger) continue;
        const auto found = snapshot.fields.find(field.name);
        if (found == snapshot.fields.end() || found->second.size() * 4 != field_bytes(field)) {
            return error(Code::bad_argument, "restore: the snapshot's " + field.name + " has another size than this world's");
        }
    }
    // Even parity: the first of the two programs starts from the first buffer of every field.
    parity_ = 0;
    for (const auto& [name, words] : snapshot.fields) {
        if (auto status = note(device_->write(buffer(name, start_parity_[0]), 0, std::as_bytes(std::span(words)))); !status)
            return status;
    }
    steps_ = snapshot.steps;
    inputs_.set_totals(snapshot.totals);
    return ok_status();
}

} // namespace wadi
