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
    check(wadi_world_set_host_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE)));

    wadi_update_settings pace = wadi_default_update_settings();
    pace.max_steps_in_flight = 0; /* nothing paces this loop: wait for the device where a game would drop time that it cannot follow */
    check(wadi_world_set_update_settings(world, &pace));

    wadi_edit spring = wadi_default_edit(); /* a brush that pours water at (30, 20) m */
    spring.layer = WADI_LAYER_WATER;
    spring.x0 = 30;
    spring.y0 = 20;
    spring.amount = 0.02;
    for (int image = 0; image < 120; ++image) {
        wadi_frame frame = wadi_default_frame();
        check(wadi_world_edit(world, &spring, 1));
        check(wadi_world_update(world, 16666667, &frame)); /* 1/60 s; then a host draws */
        const float* surface;
        uint64_t row_pitch, step;
        if (wadi_world_get_host_output(world, WADI_OUTPUT_FREE_SURFACE, &surface, &row_pitch, &step) == WADI_OK &&
            image % 30 == 29)
            printf("t = %.2f s, step %llu: the surface at the south-west corner is %.3f m high\n", frame.time,
                   (unsigned long long)step, (double)surface[0]);
    }
    check(wadi_destroy_world(world));
    return 0;
}
