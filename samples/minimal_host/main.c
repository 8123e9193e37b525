/* The smallest host: a dam break from arrays, 60 steps, depths of water and the state's hash. Only wadi.h and the C library. */
#include <stdio.h>
#include <stdlib.h>
#include <wadi/wadi.h>

#define NX 128
#define NY 32

static const char* const settings = "{ \"format_version\": 1, \"name\": \"dam_break\","
                                    "  \"grid\": { \"nx\": 128, \"ny\": 32, \"dx\": 0.078125 }, \"dt\": 0.01 }";

static void check(wadi_result result, const char* what) {
    if (result == WADI_OK) return;
    fprintf(stderr, "minimal host: %s: %s\n", what, wadi_get_last_error());
    exit(1);
}

int main(void) {
    if (wadi_get_abi_version() != WADI_ABI_VERSION) {
        fprintf(stderr, "minimal host: the loaded library has another ABI version\n");
        return 1;
    }
    static float water[NX * NY]; /* depth [m], row 0 = south */
    for (int j = 0; j < NY; ++j) {
        for (int i = 0; i < NX / 2; ++i) water[j * NX + i] = 1.0f;
    }

    wadi_world_arrays arrays = wadi_default_world_arrays();
    arrays.settings_json = settings;
    arrays.nx = NX;
    arrays.ny = NY;
    arrays.water = water;
    const wadi_device_options options = wadi_default_device_options();
    wadi_world_id world;
    check(wadi_create_world_from_arrays(&arrays, &options, &world), "creating the world");

    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(world, &info), "describing the world");
    printf("%s, %d x %d cells, on %s: %s\n", info.name, (int)info.nx, (int)info.ny, info.backend, info.device_name);

    for (int frame = 0; frame < 60; ++frame) check(wadi_world_step(world, 1), "stepping");

    check(wadi_world_read_field(world, WADI_FIELD_TOTAL_WATER_DEPTH, water, NX * NY), "reading the water");
    float least = water[0], most = water[0];
    for (int k = 1; k < NX * NY; ++k) {
        least = water[k] < least ? water[k] : least;
        most = water[k] > most ? water[k] : most;
    }
    wadi_world_stats stats = wadi_default_world_stats();
    check(wadi_world_get_stats(world, &stats), "reading the statistics");
    printf("t = %.3f s: water from %.6f m to %.6f m, hash %016llx\n", stats.time, (double)least, (double)most,
           (unsigned long long)stats.hash);
    check(wadi_destroy_world(world), "destroying the world");
    return 0;
}
