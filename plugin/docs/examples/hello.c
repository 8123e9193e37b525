#include <stdio.h>
#include <stdlib.h>
#include <wadi/wadi.h>

static void check(wadi_result result) {
    if (result == WADI_OK) return;
    fprintf(stderr, "%s\n", wadi_get_last_error());
    exit(1);
}

int main(int argc, char** argv) {
    wadi_world_id world;
    check(wadi_create_world_from_level(argc > 1 ? argv[1] : "level.json", NULL, NULL, &world));
    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(world, &info));

    const uint64_t cells = (uint64_t)info.nx * (uint64_t)info.ny;
    float* depth = malloc(cells * sizeof(float));
    if (!depth) return 1;
    for (int line = 0; line <= 12; ++line) {
        check(wadi_world_read_field(world, WADI_FIELD_TOTAL_WATER_DEPTH, depth, cells)); /* waits for the steps below */
        const float* row = depth + (uint64_t)(info.ny / 4) * (uint64_t)info.nx;
        printf("%4.1f s  |", 0.5 * line);
        for (int x = 0; x < 64; ++x) {
            const float metres = row[x * info.nx / 64];
            putchar(metres < 0.01f ? ' ' : metres < 0.5f ? '.' : metres < 1 ? '-' : metres < 2 ? '=' : metres < 4 ? '+' : '#');
        }
        printf("|\n");
        check(wadi_world_step(world, (uint32_t)(0.5 / info.dt))); /* a game calls wadi_world_update once per frame instead */
    }
    free(depth);
    check(wadi_destroy_world(world));
    return 0;
}
