/* Order between a world of the backend "cuda" and the host's own CUDA work, without a wait of the host's. C99, needs no header of CUDA.
 *
 * A world works on a stream of its own in the primary context of its device, the one that CUDA's runtime uses. Nothing orders it with
 * the host's streams but these events, each a cudaEvent_t or CUevent of that context:
 *   cudaEventRecord(done, stream);      what the host's stream has been given so far
 *   wadi_cuda_wait(world, done);        comes ahead of what the world submits next
 *   wadi_world_update(world, ...);
 *   wadi_cuda_signal(world, written);   and what the world has submitted
 *   cudaStreamWaitEvent(stream, written, 0);   ahead of what the host's stream is given next, which may read wadi_world_get_view
 */
#ifndef WADI_CUDA_H
#define WADI_CUDA_H

#include <wadi/wadi.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The world's next submission waits on the device for the newest record of `event` ahead of this call; for nothing where there is
 *  none. The event may be recorded anew, or destroyed, from here on.
 *  Errors: BAD_ARGUMENT (NULL, or no event of the device's primary context), NOT_SUPPORTED (the world's backend is not cuda). */
WADI_API wadi_result wadi_cuda_wait(wadi_world_id world, void* event);
/** Records `event` behind everything that the world submitted so far.
 *  Errors: those of wadi_cuda_wait. */
WADI_API wadi_result wadi_cuda_signal(wadi_world_id world, void* event);

#ifdef __cplusplus
}
#endif
#endif
