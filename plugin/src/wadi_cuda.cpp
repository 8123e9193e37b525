// The order between a world in CUDA and the host's own streams. There in every build: without the backend cuda no world takes
// events.
#include "plugin/include/wadi/wadi_cuda.h"
#include "plugin/src/host_sync.hpp"

using namespace wadi;
using namespace wadi::plugin;

extern "C" {

wadi_result wadi_cuda_wait(wadi_world_id id, void* event) {
    return on_host_sync(__func__, id, [&](compute::HostSync& sync) { return sync.wait_event(event); });
}

wadi_result wadi_cuda_signal(wadi_world_id id, void* event) {
    return on_host_sync(__func__, id, [&](compute::HostSync& sync) { return sync.record_event(event); });
}

} // extern "C"
