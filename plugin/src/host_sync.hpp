// Calls that order a world's work and the host's, or bring one to the other.
#pragma once
#include "plugin/src/abi.hpp"

namespace wadi::plugin {

/// Calls what the device of a world has of the host's.
template <class Call> wadi_result on_host_sync(const char* function, wadi_world_id id, Call call) {
    return with_world(function, id, [&](HostedWorld& hosted) {
        return report(
            named(function, call(*hosted.world->device().host_sync()))); // the registry's devices are the front end's: never null
    });
}

} // namespace wadi::plugin
