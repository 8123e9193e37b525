/* A host that uses every struct that can grow, compiled with this library's header, the first of its ABI version and one from the future
 * (versions.py). Prints the state's hash. SET_UNKNOWN: sets a field that the library does not know, and wants to be refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wadi/wadi.h>

static void expect(int holds, const char* what) {
    if (holds) return;
    fprintf(stderr, "not so: %s (%s)\n", what, wadi_get_last_error());
    exit(1);
}

/* Whatever a call writes, it must not write past the host's struct. */
typedef struct guarded_stats {
    wadi_world_stats stats;
    unsigned char behind[64];
} guarded_stats;

int main(void) {
    wadi_device_info devices[8];
    uint32_t count = 8;
    for (int n = 0; n < 8; ++n) devices[n] = wadi_default_device_info();
    expect(wadi_list_devices(devices, &count, NULL, 0) == WADI_OK && count > 0 && strcmp(devices[0].backend, "cpu") == 0, "the CPU is listed first");
    for (uint32_t n = 0; n < count && n < 8; ++n) expect(devices[n].backend[0] != 0 && devices[n].name[0] != 0, "each device has a name");

    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 1;
    wadi_level_overrides overrides = wadi_default_level_overrides();
    overrides.dt = 0.02;
    const char* const json = "{\"format_version\": 1, \"name\": \"pond\", \"grid\": {\"nx\": 16, \"ny\": 12, \"dx\": 0.5}, \"dt\": 0.01,"
                             " \"water\": [{\"shape\": \"cylinder\", \"center\": [3, 3], \"radius\": 2, \"height\": 1}]}";
    wadi_world_id world;
#ifdef SET_UNKNOWN
    overrides.grown = 1;
    expect(wadi_create_world_from_level_text(json, NULL, NULL, &overrides, &options, &world) == WADI_ERROR_BAD_ARGUMENT &&
               strstr(wadi_get_last_error(), "does not know") != NULL,
           "a field that is not known is refused");
    puts("refused");
    return 0;
#endif
    expect(wadi_create_world_from_level_text(json, NULL, NULL, &overrides, &options, &world) == WADI_OK, "a world is made");
    wadi_world_info info = wadi_default_world_info();
    expect(wadi_world_get_info(world, &info) == WADI_OK && info.nx == 16 && info.dt == 0.02 && info.struct_size == sizeof info, "it is as asked for");

    wadi_update_settings pace = wadi_default_update_settings();
    pace.max_steps_in_flight = 0;
    pace.max_steps_per_update = 20;
    expect(wadi_world_set_update_settings(world, &pace) == WADI_OK, "frames are set");
    wadi_edit edits[2];
    for (int n = 0; n < 2; ++n) {
        edits[n] = wadi_default_edit();
        edits[n].layer = WADI_LAYER_SAND;
        edits[n].x0 = 2 + 4 * n;
        edits[n].y0 = 3;
        edits[n].amount = 0.25;
    }
    expect(wadi_world_edit(world, edits, 2) == WADI_OK, "two edits are taken");
    expect(wadi_world_set_host_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE)) == WADI_OK, "an output is asked for");
    expect(wadi_world_set_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE)) == WADI_OK, "on the device too");
    wadi_frame frame = wadi_default_frame();
    expect(wadi_world_update(world, 200000000, &frame) == WADI_OK && frame.total_steps == 10 && frame.struct_size == sizeof frame, "ten steps are done");
    wadi_output_view view = wadi_default_output_view();
    expect(wadi_world_get_view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT, &view) == WADI_OK && view.nx == 16, "the output has a view");
    wadi_body body = wadi_default_body();
    body.position[0] = body.position[1] = 3;
    expect(wadi_buoyancy_points(&body, NULL, &count) == WADI_OK && count == 16, "a body has its points");

    guarded_stats guarded;
    memset(&guarded, 0xA5, sizeof guarded);
    guarded.stats = wadi_default_world_stats();
    expect(wadi_world_get_stats(world, &guarded.stats) == WADI_OK && guarded.stats.sand_volume > 0.3, "both edits poured sand");
    for (int n = 0; n < 64; ++n) expect(guarded.behind[n] == 0xA5, "nothing is written behind a struct");
    printf("%016llx\n", (unsigned long long)guarded.stats.hash);
    expect(wadi_destroy_world(world) == WADI_OK, "the world goes");
    return 0;
}
