// Saving, loading, roll-back and the hash.
#include "engine/saves/snapshot_file.hpp"
#include "engine/saves/snapshot_format.hpp"
#include "plugin/src/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

namespace {

std::span<std::byte> bytes_at(void* data, size_t size) { return {static_cast<std::byte*>(data), size}; }

/// A step that was begun in parts is finished first: that may end in the middle, a load may not.
/// What passes the host's own limits is refused with its header read and no more.
Status load(HostedWorld& hosted, std::span<const std::byte> from) {
    if (hosted.most) {
        const auto cost = hosted.world->snapshots().cost(from);
        if (!cost) return cost.status();
        if (auto status = check_cost("snapshot", *cost, *hosted.most); !status) return status;
    }
    return hosted.world->snapshots().load(from);
}

template <class Call> wadi_result load_at_boundary(HostedWorld& hosted, Call call) {
    if (auto status = hosted.world->step(0); !status) return report(status);
    return or_unchanged("wadi_world_load", [&] { return report(call()); });
}

} // namespace

extern "C" {

wadi_result wadi_world_save(wadi_world_id id, void* data, size_t* size) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (size == nullptr) return bad_argument("wadi_world_save: size is NULL");
        const size_t capacity = *size;
        *size = in_memory(hosted.world->snapshots().bytes());
        return report(data == nullptr ? ok_status() : hosted.world->snapshots().save(bytes_at(data, capacity)));
    });
}

wadi_result wadi_world_load(wadi_world_id id, const void* data, size_t size) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (data == nullptr) return bad_argument("wadi_world_load: data is NULL");
        return load_at_boundary(hosted, [&] { return load(hosted, {static_cast<const std::byte*>(data), size}); });
    });
}

wadi_result wadi_world_save_file(wadi_world_id id, const char* path) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (path == nullptr) return bad_argument("wadi_world_save_file: path is NULL");
        std::vector<std::byte> bytes(in_memory(hosted.world->snapshots().bytes()));
        if (auto status = hosted.world->snapshots().save(bytes); !status) return report(status);
        return report(write_snapshot_file(path, bytes));
    });
}

wadi_result wadi_world_load_file(wadi_world_id id, const char* path) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (path == nullptr) return bad_argument("wadi_world_load_file: path is NULL");
        return load_at_boundary(hosted, [&] {
            auto bytes = read_snapshot_file(path, hosted.world->snapshots().most_bytes());
            return bytes ? load(hosted, *bytes) : bytes.status();
        });
    });
}

wadi_result wadi_world_begin_save(wadi_world_id id, uint64_t* ticket) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (ticket == nullptr) return bad_argument("wadi_world_begin_save: ticket is NULL");
        auto begun = hosted.world->snapshots().begin_save();
        if (begun) *ticket = *begun;
        return report(begun.status());
    });
}

wadi_result wadi_world_end_save(wadi_world_id id, uint64_t ticket, void* data, size_t* size) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (size == nullptr) return bad_argument("wadi_world_end_save: size is NULL");
        const size_t capacity = *size;
        auto needed = hosted.world->snapshots().saved_bytes(ticket);
        if (!needed) return report(needed.status());
        *size = in_memory(*needed);
        return report(data == nullptr ? ok_status() : hosted.world->snapshots().end_save(ticket, bytes_at(data, capacity)));
    });
}

wadi_result wadi_world_set_rollback(wadi_world_id id, uint32_t frames, uint32_t interval_steps) {
    return with_world(__func__, id,
                      [&](HostedWorld& hosted) { return report(hosted.world->roll_back().set(frames, interval_steps)); });
}

wadi_result wadi_world_get_rollback_steps(wadi_world_id id, uint64_t* steps, uint32_t* count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument("wadi_world_get_rollback_steps: count is NULL");
        const auto kept = hosted.world->roll_back().steps();
        const uint32_t capacity = steps != nullptr ? *count : 0;
        *count = static_cast<uint32_t>(kept.size());
        std::copy_n(kept.begin(), std::min(capacity, *count), steps);
        return report(ok_status());
    });
}

wadi_result wadi_world_roll_back(wadi_world_id id, uint64_t step, uint64_t* reached) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        auto to = hosted.world->roll_back().go_back(step);
        if (to && reached != nullptr) *reached = *to;
        return report(to.status());
    });
}

wadi_result wadi_world_get_hash(wadi_world_id id, uint64_t* hash) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (hash == nullptr) return bad_argument("wadi_world_get_hash: hash is NULL");
        auto now = hosted.world->reader().hash();
        if (now) *hash = *now;
        return report(now.status());
    });
}

} // extern "C"
