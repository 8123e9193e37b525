/* What a step costs a host in C: microseconds of its thread per call of wadi_world_step, the least of some rounds. */
#include <stdio.h>
#include <time.h>
#include <wadi/wadi.h>

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec * 1e-3;
}

int main(void) {
    static float water[16];
    wadi_world_arrays arrays = wadi_default_world_arrays();
    arrays.settings_json = "{'format_version': 1, 'name': 'loop', 'grid': {'nx': 4, 'ny': 4, 'dx': 1}, 'dt': 0.01}";
    arrays.nx = arrays.ny = 4;
    arrays.water = water;
    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    wadi_world_id world;
    if (wadi_create_world_from_arrays(&arrays, &options, &world) != WADI_OK) return 1;
    double least = 1e9;
    for (int round = 0; round < 8; ++round) {
        const double begin = now();
        for (int n = 0; n < 2000; ++n) {
            if (wadi_world_step(world, 1) != WADI_OK) return 1;
        }
        const double each = (now() - begin) / 2000;
        least = each < least ? each : least;
    }
    printf("%.3f\n", least);
    return 0;
}
