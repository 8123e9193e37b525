/* Plays a scene with a built extension where no Godot is: loads it as the engine would, runs its node, and writes what came out.
 *   play_extension EXTENSION LEVEL_JSON SCENE FOLDER MAP [FACTOR]
 * Prints and writes what host.c does, from the node's get_hash, textures and get_heights. Then: ticks, a state taken and put
 * back, MAP as a level out of a pack, and that nothing was left behind. Exit status 1 says what was wrong. */
#include "open_extension.h"
#include "stand_in.h"

#include "engine/classes.h"

#include <wadi/wadi.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int wrong;
static void expect(bool good, const char* what) {
    if (good) return;
    ++wrong;
    fprintf(stderr, "WRONG: %s\n", what);
}

#define CALL(thing, method, ...)                                                                                                 \
    stand_in_call(thing, method, (int)(sizeof((Variant[]){__VA_ARGS__}) / sizeof(Variant)), (Variant[]){__VA_ARGS__})
#define ASK(thing, method) stand_in_call(thing, method, 0, NULL)

static void good(Variant error, const char* call) { expect(whole(error) == 0, call); }

static Thing* terrain_of(const char* file) {
    Thing *level = stand_in_make("WadiLevel"), *terrain = stand_in_make("WadiTerrain3D");
    if (!level || !terrain) {
        fprintf(stderr, "WRONG: the extension has no WadiLevel or no WadiTerrain3D\n");
        exit(1);
    }
    stand_in_set(level, "set_file", a_text(file));
    stand_in_set(terrain, "set_level", a_thing(level)); /* whose last reference that is */
    stand_in_set(terrain, "set_backend", a_text("cpu"));
    stand_in_set(terrain, "set_running", a_truth(false));
    return terrain;
}

static void print_hash(Thing* terrain) {
    size_t size;
    Variant hash = ASK(terrain, "get_hash");
    printf("%s\n", (const char*)content(&hash, &size));
    free_value(&hash);
}

/* Sources of the scene by its numbers: those of the node, -1 for what is not open. */
static bool act_on_source(Thing* terrain, const char* line, double factor) {
    static int64_t open[4] = {-1, -1, -1, -1};
    double v[4];
    unsigned n;
    int layer;
    if (sscanf(line, "close %u", &n) == 1 && n < 4) {
        good(CALL(terrain, "close_source", an_integer(open[n])), line);
        open[n] = -1;
        return true;
    }
    if (sscanf(line, "tap %u %d %lf %lf %lf", &n, &layer, v, v + 1, v + 3) == 5)
        v[2] = 0.01; /* holds no middle of a cell */
    else if (sscanf(line, "source %u %d %lf %lf %lf %lf", &n, &layer, v, v + 1, v + 2, v + 3) != 6)
        return false;
    if (n >= 4) return false;
    const Variant at = a_place((float)v[0], 0, (float)v[1]), discharge = a_number(v[3] * factor);
    if (open[n] >= 0) {
        good(CALL(terrain, "set_source", an_integer(open[n]), an_integer(layer), at, a_number(v[2]), discharge), line);
    } else {
        open[n] = whole(CALL(terrain, "open_source", an_integer(layer), at, a_number(v[2]), discharge));
        expect(open[n] >= 0, line);
    }
    return true;
}

static void act(Thing* terrain, const char* line, double factor) {
    double v[8];
    int layer, steps;
    char name[64];
    if (*line == '#' || *line == '\n' || *line == '\r') return;
    if (sscanf(line, "step %d", &steps) == 1) {
        good(CALL(terrain, "step", an_integer(steps)), line);
        print_hash(terrain);
    } else if (sscanf(line, "brush %d %lf %lf %lf %lf %lf", &layer, v, v + 1, v + 2, v + 3, v + 4) == 6) {
        good(CALL(terrain, "brush", an_integer(layer), a_place((float)v[0], 0, (float)v[1]), a_number(v[2]),
                  a_number(v[3] * factor), a_number(v[4])),
             line);
    } else if (sscanf(line, "line %d %lf %lf %lf %lf %lf %lf %lf", &layer, v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6) == 8) {
        good(CALL(terrain, "brush_line", an_integer(layer), a_place((float)v[0], 0, (float)v[1]),
                  a_place((float)v[2], 0, (float)v[3]), a_number(v[4]), a_number(v[5] * factor), a_number(v[6])),
             line);
    } else if (sscanf(line, "push %lf %lf %lf %lf %lf %lf", v, v + 1, v + 2, v + 3, v + 4, v + 5) == 6) {
        good(CALL(terrain, "push", a_place((float)v[0], 0, (float)v[1]), a_number(v[2]), a_place((float)v[3], 0, (float)v[4]),
                  a_number(v[5])),
             line);
    } else if (sscanf(line, "material %63s %lf", name, v) == 2) {
        good(CALL(terrain, "set_material", a_text(name), a_number(v[0])), line);
    } else if (!act_on_source(terrain, line, factor)) {
        expect(false, line);
    }
}

static void write_file(const char* folder, const char* name, Variant value) {
    char path[1024];
    size_t size;
    const void* data = content(&value, &size);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE* file = fopen(path, "wb");
    expect(file && size > 0 && fwrite(data, 1, size, file) == size, path);
    if (file) fclose(file);
    free_value(&value);
}

static void write_outputs(Thing* terrain, const char* folder) {
    good(ASK(terrain, "sync_textures"), "sync_textures");
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        char name[32];
        snprintf(name, sizeof name, "output_%d.bin", output);
        write_file(folder, name, CALL(terrain, "get_texture", an_integer(output)));
    }
    write_file(folder, "heights.bin", CALL(terrain, "get_heights", a_region(0, 0, 256, 128)));
}

/* A second of physics ticks, which the engine's notifications bring. */
static void tick(const char* level) {
    Thing* terrain = terrain_of(level);
    stand_in_set(terrain, "set_running", a_truth(true));
    stand_in_set(terrain, "set_wait_for_device", a_truth(true));
    stand_in_notify(terrain, NOTIFICATION_READY);
    expect(signals_of("started") == 2, "the node starts its world when it is ready"); /* the first was the scene's */
    for (int n = 0; n < 60; ++n) stand_in_notify(terrain, NOTIFICATION_INTERNAL_PHYSICS_PROCESS);
    const double time = number(ASK(terrain, "get_time"));
    expect(time > 0.99 && time < 1.01, "60 ticks are a second");
    expect(signals_of("world_changed") > 30, "listeners hear of changes");
    Variant stats = ASK(terrain, "get_stats");
    expect(elements(&stats) > 15, "get_stats has its numbers");
    free_value(&stats);

    Variant state = ASK(terrain, "save_state"), before = ASK(terrain, "get_hash"), after;
    good(CALL(terrain, "step", an_integer(5)), "step");
    after = ASK(terrain, "get_hash");
    size_t size;
    expect(strcmp(content(&before, &size), content(&after, &size)) != 0, "control: later is another hash");
    good(CALL(terrain, "load_state", a_copy(&state)), "load_state");
    free_value(&after);
    after = ASK(terrain, "get_hash");
    expect(strcmp(content(&before, &size), content(&after, &size)) == 0, "a state comes back");
    free_value(&after);
    free_value(&before);
    free_value(&state);
    stand_in_free(terrain);
}

static void map_of_pack(const char* map) {
    put_in_pack("res://maps/hill.png", map);
    Thing* terrain = terrain_of("res://maps/hill.png");
    good(ASK(terrain, "start"), "a map out of a pack");
    good(CALL(terrain, "step", an_integer(3)), "step");
    stand_in_free(terrain);

    const int before = messages();
    terrain = terrain_of("res://maps/none.png");
    expect(whole(ASK(terrain, "start")) != 0 && messages() == before + 1,
           "control: a map that is nowhere is refused with a line");
    stand_in_free(terrain);
}

int main(int argc, char** argv) {
    FILE* scene = argc >= 6 ? fopen(argv[3], "r") : NULL;
    if (!scene) {
        fprintf(stderr, "usage: play_extension EXTENSION LEVEL_JSON SCENE FOLDER MAP [FACTOR]\n");
        return 2;
    }
    const GDExtensionInitializationFunction start = (GDExtensionInitializationFunction)open_extension(argv[1], "wadi_godot_init");
    GDExtensionInitialization levels = {0};
    int token;
    if (!start || !start(stand_in_function, &token, &levels)) {
        fprintf(stderr, "WRONG: the extension does not start\n");
        return 1;
    }
    for (int level = GDEXTENSION_INITIALIZATION_CORE; level <= GDEXTENSION_INITIALIZATION_SCENE; ++level)
        levels.initialize(levels.userdata, (GDExtensionInitializationLevel)level);

    Thing* terrain = terrain_of(argv[2]);
    stand_in_set(terrain, "set_outputs", an_integer((1 << WADI_OUTPUT_COUNT) - 1));
    good(ASK(terrain, "start"), "start");
    char line[256];
    while (wrong == 0 && fgets(line, sizeof line, scene)) act(terrain, line, argc > 6 ? atof(argv[6]) : 1);
    fclose(scene);
    if (wrong == 0) write_outputs(terrain, argv[4]);
    expect(messages() == 0, "no warning, no error");
    stand_in_free(terrain);
    if (wrong == 0) tick(argv[2]);
    if (wrong == 0) map_of_pack(argv[5]);

    for (int level = GDEXTENSION_INITIALIZATION_SCENE; level >= GDEXTENSION_INITIALIZATION_CORE; --level)
        levels.deinitialize(levels.userdata, (GDExtensionInitializationLevel)level);
    if (values_alive() != 0) fprintf(stderr, "%ld values are alive\n", values_alive());
    expect(values_alive() == 0, "all values were freed");
    return wrong != 0;
}
