/* The C host beside Godot: runs a scene (scene.txt) on a level and says what came out.
 *   host LEVEL_JSON SCENE FOLDER [FACTOR]
 * Prints the hash after each "step" line, writes every output to FOLDER/output_N.bin (rows from the south, without padding) and
 * the solid surface, rows from the north, to FOLDER/heights.bin. FACTOR (1) multiplies the amounts of brushes: with another the
 * hashes differ. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wadi/wadi.h>

static void check(wadi_result result, const char* what) {
    if (result == WADI_OK) return;
    fprintf(stderr, "host: %s: %s\n", what, wadi_get_last_error());
    exit(1);
}

static double middle_x, middle_y, factor = 1;

static void edit(wadi_world_id world, const char* line) {
    wadi_edit edit = wadi_default_edit();
    int layer = 0;
    double x, z, x1, z1, vx, vz;
    if (sscanf(line, "brush %d %lf %lf %lf %lf %lf", &layer, &x, &z, &edit.radius, &edit.amount, &edit.softness) == 6) {
    } else if (sscanf(line, "line %d %lf %lf %lf %lf %lf %lf %lf", &layer, &x, &z, &x1, &z1, &edit.radius, &edit.amount,
                      &edit.softness) == 8) {
        edit.capsule = 1;
        edit.x1 = middle_x + x1;
        edit.y1 = middle_y - z1;
    } else if (sscanf(line, "push %lf %lf %lf %lf %lf %lf", &x, &z, &edit.radius, &vx, &vz, &edit.strength) == 6) {
        edit.kind = WADI_EDIT_PUSH;
        edit.velocity_x = vx;
        edit.velocity_y = -vz;
    } else {
        fprintf(stderr, "host: cannot read the line: %s\n", line);
        exit(1);
    }
    edit.layer = (wadi_layer)layer;
    edit.x0 = middle_x + x;
    edit.y0 = middle_y - z;
    edit.amount *= factor;
    check(wadi_world_edit(world, &edit, 1), line);
}

/* "source INDEX LAYER X Z RADIUS DISCHARGE", "tap INDEX LAYER X Z DISCHARGE" (the cell there) and "close INDEX": whether it is
 * one. */
static int source(wadi_world_id world, const char* line) {
    static wadi_source sources[4];
    static wadi_sample discharges[4];
    unsigned n;
    int layer;
    double x, z;
    wadi_source made = wadi_default_source();
    wadi_sample discharge = {0, 0};
    if (sscanf(line, "close %u", &n) == 1 && n < 4) {
        made = sources[n];
    } else {
        if (sscanf(line, "tap %u %d %lf %lf %lf", &n, &layer, &x, &z, &discharge.value) == 5)
            made.shape = WADI_SOURCE_POINT;
        else if (sscanf(line, "source %u %d %lf %lf %lf %lf", &n, &layer, &x, &z, &made.radius, &discharge.value) != 6)
            return 0;
        made.sand = layer == WADI_LAYER_SAND;
        made.center[0] = middle_x + x;
        made.center[1] = middle_y - z;
        made.discharge_count = 1;
        if (n >= 4) return 0;
    }
    sources[n] = made;
    discharges[n] = discharge;
    sources[n].discharge = &discharges[n];
    check(wadi_world_set_source(world, n, &sources[n]), line);
    return 1;
}

static void run(wadi_world_id world, FILE* scene) {
    char line[256], name[64];
    while (fgets(line, sizeof line, scene)) {
        unsigned steps;
        double value;
        uint64_t hash;
        if (*line == '#' || *line == '\n') continue;
        if (sscanf(line, "step %u", &steps) == 1) {
            check(wadi_world_step(world, steps), line);
            check(wadi_world_get_hash(world, &hash), "hash");
            printf("%016" PRIx64 "\n", hash);
        } else if (sscanf(line, "material %63s %lf", name, &value) == 2) {
            check(wadi_world_set_material(world, name, value), line);
        } else if (!source(world, line)) {
            edit(world, line);
        }
    }
}

static void write_rows(const char* folder, const char* name, const void* data, uint64_t pitch, size_t row, int rows) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE* file = fopen(path, "wb");
    for (int j = 0; file && j < rows; ++j) fwrite((const char*)data + (size_t)j * pitch, 1, row, file);
    if (!file || fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

static size_t texel(int output) {
    if (output == WADI_OUTPUT_FLOW || output == WADI_OUTPUT_SAND_VELOCITY || output == WADI_OUTPUT_PACKED_HALF) return 8;
    return output == WADI_OUTPUT_NORMAL || output == WADI_OUTPUT_PACKED ? 16 : 4;
}

static void write_outputs(wadi_world_id world, const wadi_world_info* info, const char* folder) {
    check(wadi_world_set_host_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_COUNT) - 1), "outputs");
    const float* data;
    uint64_t pitch, hash;
    for (int n = 0; n < 3; ++n) { /* the second update finds the copy that the first one asked for */
        check(wadi_world_update(world, 0, &(wadi_frame){.struct_size = sizeof(wadi_frame)}), "update");
        check(wadi_world_get_hash(world, &hash), "hash");
    }
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        char name[32];
        snprintf(name, sizeof name, "output_%d.bin", output);
        check(wadi_world_get_host_output(world, (wadi_output)output, &data, &pitch, NULL), name);
        write_rows(folder, name, data, pitch, (size_t)info->nx * texel(output), info->ny);
    }
    check(wadi_world_get_host_output(world, WADI_OUTPUT_SAND_SURFACE, &data, &pitch, NULL), "heights");
    const char* last = (const char*)data + (size_t)(info->ny - 1) * pitch;
    float* rows = malloc((size_t)info->nx * (size_t)info->ny * 4);
    if (!rows) exit(1);
    for (int j = 0; j < info->ny; ++j)
        memcpy(rows + (size_t)j * (size_t)info->nx, last - (size_t)j * pitch, (size_t)info->nx * 4);
    write_rows(folder, "heights.bin", rows, (uint64_t)info->nx * 4, (size_t)info->nx * 4, info->ny);
    free(rows);
}

int main(int argc, char** argv) {
    FILE* scene = argc >= 4 ? fopen(argv[2], "r") : NULL;
    if (!scene) {
        fprintf(stderr, "usage: host LEVEL_JSON SCENE FOLDER [FACTOR]\n");
        return 2;
    }
    if (argc > 4) factor = atof(argv[4]);
    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    wadi_world_id world;
    check(wadi_create_world_from_level(argv[1], NULL, &options, &world), argv[1]);
    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(world, &info), "info");
    middle_x = info.nx * info.dx / 2;
    middle_y = info.ny * info.dx / 2;
    run(world, scene);
    fclose(scene);
    write_outputs(world, &info, argv[3]);
    check(wadi_destroy_world(world), "destroying the world");
    return 0;
}
