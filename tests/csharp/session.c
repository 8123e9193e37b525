/* A whole session as a C host plays it; Session.cs makes the same calls and must print the same. Usage: session LEVEL
 * SNAPSHOT_FILE */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wadi/wadi.h>

#define NX 64
#define NY 32

static void check(wadi_result result) {
    if (result == WADI_OK) return;
    fprintf(stderr, "session.c: %s\n", wadi_get_last_error());
    exit(1);
}

static unsigned long long digest(const void* data, size_t size) { /* FNV-1a */
    unsigned long long value = 14695981039346656037ull;
    for (size_t n = 0; n < size; ++n) value = (value ^ ((const unsigned char*)data)[n]) * 1099511628211ull;
    return value;
}

static void tell(const char* name, unsigned long long value) { printf("%s %016llx\n", name, value); }

static void tell_hash(const char* name, wadi_world_id world) {
    uint64_t hash;
    check(wadi_world_get_hash(world, &hash));
    tell(name, hash);
}

static wadi_world_id create(const char* level) {
    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 2;
    wadi_level_overrides overrides = wadi_default_level_overrides();
    overrides.nx = NX;
    overrides.ny = NY;
    wadi_world_id world;
    check(wadi_create_world_from_level(level, &overrides, &options, &world));
    wadi_update_settings pace = wadi_default_update_settings();
    pace.max_steps_in_flight = 0;
    pace.max_steps_per_update = 64;
    check(wadi_world_set_update_settings(world, &pace));
    return world;
}

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    wadi_world_id world = create(argv[1]);
    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(world, &info));
    printf("%s %d x %d dx %.17g dt %.17g on %s, exact %d\n", info.name, (int)info.nx, (int)info.ny, info.dx, info.dt,
           info.backend, (int)info.exact_float);
    check(wadi_world_set_command_log(world, 1));
    check(wadi_world_set_host_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_PACKED)));
    check(wadi_world_set_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_FLOW) | WADI_OUTPUT_TILES_BIT));
    check(wadi_world_set_rollback(world, 4, 8));

    const float image[6] = {0, 1, 0.5f, 1, 0, 0.25f};
    uint32_t stamp;
    check(wadi_world_create_stamp(world, 3, 2, image, &stamp));
    wadi_edit edits[3];
    for (int n = 0; n < 3; ++n) edits[n] = wadi_default_edit();
    edits[0].layer = WADI_LAYER_WATER;
    edits[0].x0 = 20;
    edits[0].y0 = 6;
    edits[0].radius = 3;
    edits[0].amount = 0.4;
    edits[1].kind = WADI_EDIT_STAMP;
    edits[1].layer = WADI_LAYER_SAND;
    edits[1].x0 = 30;
    edits[1].y0 = 10;
    edits[1].x1 = 40;
    edits[1].y1 = 16;
    edits[1].amount = 0.75;
    edits[1].stamp = stamp;
    edits[2].kind = WADI_EDIT_PUSH;
    edits[2].capsule = 1;
    edits[2].step = 12;
    edits[2].x0 = 4;
    edits[2].y0 = 4;
    edits[2].x1 = 9;
    edits[2].y1 = 8;
    edits[2].velocity_x = 2.5;
    edits[2].velocity_y = -0.5;
    check(wadi_world_edit(world, edits, 3));
    for (int image_number = 0; image_number < 30; ++image_number) {
        wadi_frame frame = wadi_default_frame();
        check(wadi_world_update(world, 16666667, &frame));
        if (image_number % 10 == 9)
            printf("frame %u %llu %.17g %.17g %llu\n", (unsigned)frame.steps, (unsigned long long)frame.total_steps, frame.time,
                   frame.interpolation, (unsigned long long)frame.dropped_nanoseconds_total);
    }
    check(wadi_world_set_material(world, "friction", 0.3));

    const float points[6] = {5, 5, 20.5f, 7.25f, 1000, 0};
    uint64_t ticket, step;
    uint32_t count = 0;
    wadi_query_result results[3];
    check(wadi_world_query(world, points, 3, &ticket));
    wadi_result ready;
    while ((ready = wadi_world_get_query(world, ticket, results, 3, &count, &step)) == WADI_NOT_READY) {
    }
    check(ready);
    printf("query %u at %llu, inside %d %d %d, %.9g %.9g %.9g\n", (unsigned)count, (unsigned long long)step,
           (int)results[0].inside, (int)results[1].inside, (int)results[2].inside, (double)results[0].surface,
           (double)results[1].normal[2], (double)results[0].velocity[0]);
    tell("query", digest(results, sizeof results));

    static float values[NX * NY], packed[4 * NX * NY];
    for (int field = 0; field < WADI_FIELD_COUNT; ++field) {
        check(wadi_world_read_field(world, (wadi_field)field, values, NX * NY));
        tell(wadi_field_name((wadi_field)field), digest(values, sizeof values));
    }
    const float* output;
    uint64_t row_pitch, newest;
    check(wadi_world_get_time(world, NULL, &newest));
    do { /* until the copy of the newest step has arrived */
        wadi_frame frame = wadi_default_frame();
        check(wadi_world_update(world, 0, &frame));
        check(wadi_world_get_host_output(world, WADI_OUTPUT_PACKED, &output, &row_pitch, &step));
    } while (step != newest);
    for (int j = 0; j < NY; ++j)
        memcpy(packed + (size_t)j * 4 * NX, (const char*)output + (size_t)j * row_pitch, 4 * NX * sizeof(float));
    printf("packed of step %llu ", (unsigned long long)step);
    tell("", digest(packed, sizeof packed));

    wadi_region region = {3, 4, 5, 6};
    check(wadi_world_read_region(world, WADI_FIELD_SAND_DEPTH, &region, values, 30));
    for (int n = 0; n < 30; ++n) values[n] += 0.125f;
    check(wadi_world_write_region(world, WADI_FIELD_SAND_DEPTH, &region, values, 30));
    tell_hash("hash", world);
    wadi_world_stats stats = wadi_default_world_stats();
    check(wadi_world_get_stats(world, &stats));
    printf("stats %.17g %.17g %.17g %lld %lld\n", stats.sand_volume, stats.water_volume, stats.largest_water_speed,
           (long long)stats.sand_drift_quanta, (long long)stats.water_drift_quanta);

    size_t size = 0;
    check(wadi_world_save(world, NULL, &size));
    void* snapshot = malloc(size);
    check(wadi_world_save(world, snapshot, &size));
    tell("snapshot", digest(snapshot, size));
    check(wadi_world_begin_save(world, &ticket));
    size_t later = 0;
    while ((ready = wadi_world_end_save(world, ticket, NULL, &later)) == WADI_NOT_READY) {
    }
    check(ready);
    void* fetched = malloc(later);
    while ((ready = wadi_world_end_save(world, ticket, fetched, &later)) == WADI_NOT_READY) {
    }
    check(ready);
    printf("fetched %s\n", later == size && memcmp(fetched, snapshot, size) == 0 ? "equal" : "other");
    check(wadi_world_save_file(world, argv[2]));
    check(wadi_world_step(world, 7));
    tell_hash("after", world);
    check(wadi_world_load(world, snapshot, size));
    check(wadi_world_step(world, 7));
    tell_hash("again", world);
    check(wadi_world_load_file(world, argv[2]));
    tell_hash("loaded", world);

    size_t log_size = 0;
    check(wadi_world_get_commands(world, NULL, &log_size));
    void* commands = malloc(log_size);
    check(wadi_world_get_commands(world, commands, &log_size));
    tell("commands", digest(commands, log_size));
    uint64_t steps;
    check(wadi_world_get_time(world, NULL, &steps));
    wadi_world_id second = create(argv[1]);
    check(wadi_world_play_commands(second, commands, log_size));
    check(wadi_world_step(second, (uint32_t)steps));
    tell_hash("played", second);
    check(wadi_world_set_rollback(second, 4, 8));
    check(wadi_world_step(second, 40));
    uint64_t kept[4], reached;
    count = 4;
    check(wadi_world_get_rollback_steps(second, kept, &count));
    check(wadi_world_roll_back(second, kept[1] + 3, &reached));
    printf("kept %u from %llu, reached %llu\n", (unsigned)count, (unsigned long long)kept[0], (unsigned long long)reached);
    tell_hash("back", second);
    check(wadi_destroy_world(second));
    check(wadi_destroy_world(world));
    free(snapshot);
    free(fetched);
    free(commands);
    return 0;
}
