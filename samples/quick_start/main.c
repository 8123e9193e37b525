#include <stdio.h>
#include <stdlib.h>
#include <wadi/wadi.h>

static void check(wadi_result result) {
    if (result == WADI_OK) return;
    fprintf(stderr, "%s\n", wadi_get_last_error());
    exit(1);
}

/* What follows, without this line, is the quick start of plugin/README.md (tests/plugin/quick_start.py compares them). */
int main(int argc, char** argv) {
    wadi_world_id world; /* a level file; NULL, NULL: its own settings, the best device */
    check(wadi_create_world_from_level(argc > 1 ? argv[1] : "canyon/level.json", NULL, NULL, &world));
    check(wadi_world_set_host_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_WATER_DEPTH)));
    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(world, &info));

    wadi_update_settings pace = wadi_default_update_settings();
    /* Nothing paces this loop: wait for the device where a game would drop time that it cannot follow. */
    pace.max_steps_in_flight = 0;
    check(wadi_world_set_update_settings(world, &pace));

    /* A tap 10 m north of the middle of the south side: 6 m3 of water a second for 2 s. */
    wadi_source tap = wadi_default_source();
    const wadi_sample flow[] = {{0.0, 6.0}, {2.0, 6.0}, {2.1, 0.0}};
    tap.center[0] = 0.5 * info.nx * info.dx;
    tap.center[1] = 10.0;
    tap.discharge = flow;
    tap.discharge_count = 3;
    check(wadi_world_set_source(world, (uint32_t)info.source_count, &tap)); /* one more than the level has */

    for (int image = 1; image <= 240; ++image) {
        wadi_frame frame = wadi_default_frame();
        check(wadi_world_update(world, 16666667, &frame)); /* 1/60 s; a game draws what has arrived by now, and goes on */
        if (image % 60 != 0) continue;
        const float* depth;
        uint64_t row_pitch, wet = 0;
        check(wadi_world_wait_for_outputs(world)); /* this program prints the newest instead */
        check(wadi_world_get_host_output(world, WADI_OUTPUT_WATER_DEPTH, &depth, &row_pitch, NULL));
        const uint64_t row = row_pitch / sizeof(float), nx = (uint64_t)info.nx, ny = (uint64_t)info.ny;
        for (uint64_t n = 0; n < nx * ny; ++n)
            if (depth[n / nx * row + n % nx] > 0.01f) ++wet;
        const uint64_t i = (uint64_t)(tap.center[0] / info.dx), j = (uint64_t)(tap.center[1] / info.dx);
        printf("t = %.2f s: %.3f m of water under the tap, %llu cells are wet\n", frame.time, (double)depth[j * row + i],
               (unsigned long long)wet);
    }
    check(wadi_destroy_world(world));
    return 0;
}
