/* What blocks of C on pages assume, when they are no whole programs: check_code.py compiles each behind this. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wadi/wadi.h>
#include <wadi/wadi_cuda.h>
#include <wadi/wadi_vulkan.h>

extern wadi_world_id world;
extern wadi_device_options options;
extern wadi_frame frame;
extern uint64_t nanoseconds, nanoseconds_since_last, nanoseconds_since_last_frame;

/* Queries and bodies. */
extern uint64_t ticket, step;
extern wadi_query_result results[16];
extern float force[3], torque[3];

/* What a host brings. */
void check(wadi_result result);
wadi_bool show_bar(void* user, double share);
extern VkImage image;
extern uint32_t nx, ny;

/* CUDA's runtime, of which Wadi needs no header. */
typedef void *cudaEvent_t, *cudaStream_t;
int cudaEventRecord(cudaEvent_t event, cudaStream_t stream);
int cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags);
extern cudaEvent_t event;
extern cudaStream_t stream;
