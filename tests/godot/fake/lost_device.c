/* Who listens to a signal of a WadiTerrain3D may free the node, stop its world or start another one while the call that told it
 * is still at work: the node's sources against an engine and a library that this file plays. The library loses its device at each
 * of its calls in turn. Built with the address sanitizer: any use of a node that is gone ends the program. */
#include "engine/collections.h"
#include "engine/engine.h"
#include "float.h"
#include "level.h"
#include "shared_device.h"
#include "terrain.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- What listens, and the node ---- */

typedef enum Listener { FREES_NODE, STOPS, STARTS_ANEW, LISTENERS } Listener;
static const char* const listener_names[] = {"frees the node", "stops the world", "stops it and starts another"};
static Listener listener;
static const char* heard_of; /* the signal at which it acts; NULL: at none */
static int heard, wrong;

static Terrain* node; /* NULL once it is freed */
static int object;    /* whose address stands for the engine's object */

static void free_node(void) {
    world_stop(node);
    free(node);
    node = NULL;
}

static void expect(bool good, const char* what) {
    if (good) return;
    ++wrong;
    fprintf(stderr, "WRONG: %s\n", what);
}

/* ---- The library ---- */

static int calls, lost_at; /* the call from which on the device is lost; 0: never */
static uint32_t newest_world;
static bool alive[4096];

static wadi_result answer(wadi_world_id world) {
    if (world.index == 0 || !alive[world.index]) return WADI_ERROR_BAD_ARGUMENT;
    return lost_at > 0 && ++calls >= lost_at ? WADI_ERROR_DEVICE_LOST : WADI_OK;
}
const char* wadi_get_last_error(void) { return "what the library says"; }
wadi_result wadi_destroy_world(wadi_world_id world) {
    alive[world.index] = false;
    return WADI_OK;
}
wadi_result wadi_world_set_update_settings(wadi_world_id world, const wadi_update_settings* settings) {
    (void)settings;
    return answer(world);
}
wadi_result wadi_world_get_info(wadi_world_id world, wadi_world_info* info) {
    info->nx = info->ny = 8;
    info->dx = 1;
    return answer(world);
}
wadi_result wadi_world_update(wadi_world_id world, uint64_t nanoseconds, wadi_frame* frame) {
    frame->dropped_nanoseconds = nanoseconds / 2;
    frame->steps = 1;
    return answer(world);
}
wadi_result wadi_world_step(wadi_world_id world, uint32_t steps) {
    (void)steps;
    return answer(world);
}
wadi_result wadi_world_get_time(wadi_world_id world, double* seconds, uint64_t* steps) {
    if (seconds) *seconds = 0;
    if (steps) *steps = 1;
    return answer(world);
}
wadi_result wadi_world_set_outputs(wadi_world_id world, wadi_output_mask mask) {
    (void)mask;
    return answer(world);
}
wadi_result wadi_world_set_host_outputs(wadi_world_id world, wadi_output_mask mask) {
    (void)mask;
    return answer(world);
}
wadi_result wadi_world_get_host_output(wadi_world_id world, wadi_output output, const float** data, uint64_t* row_pitch,
                                       uint64_t* step) {
    (void)world, (void)output, (void)data, (void)row_pitch, (void)step;
    return WADI_NOT_READY;
}
wadi_result wadi_world_read_region(wadi_world_id world, wadi_field field, const wadi_region* region, float* values,
                                   size_t count) {
    (void)field, (void)region;
    memset(values, 0, count * sizeof *values);
    return answer(world);
}
wadi_result wadi_world_get_dirty_regions(wadi_world_id world, int64_t since, wadi_region* regions, uint32_t* count,
                                         uint64_t* step) {
    (void)since;
    if (regions) regions[0] = (wadi_region){0, 0, 8, 8};
    *count = 1;
    if (step) *step = 1;
    return answer(world);
}
wadi_result wadi_world_get_tiles(wadi_world_id world, wadi_tile* tiles, uint32_t* count, uint64_t* step) {
    (void)step;
    if (tiles) memset(tiles, 0, sizeof *tiles);
    *count = 1;
    return answer(world);
}
wadi_result wadi_world_query(wadi_world_id world, const float* xy, uint32_t count, uint64_t* ticket) {
    (void)xy, (void)count;
    *ticket = 1;
    return answer(world);
}
wadi_result wadi_world_get_query(wadi_world_id world, uint64_t ticket, wadi_query_result* results, uint32_t capacity,
                                 uint32_t* count, uint64_t* step) {
    (void)ticket, (void)capacity, (void)step;
    if (results) memset(results, 0, sizeof *results);
    *count = 1;
    return answer(world);
}
static wadi_result give_bytes(wadi_world_id world, void* data, size_t* size) {
    if (data) memset(data, 0, 16);
    *size = 16;
    return answer(world);
}
wadi_result wadi_world_save(wadi_world_id world, void* data, size_t* size) { return give_bytes(world, data, size); }
wadi_result wadi_world_get_commands(wadi_world_id world, void* data, size_t* size) { return give_bytes(world, data, size); }
wadi_result wadi_world_load(wadi_world_id world, const void* data, size_t size) {
    (void)data, (void)size;
    return answer(world);
}
wadi_result wadi_world_play_commands(wadi_world_id world, const void* data, size_t size) {
    (void)data, (void)size;
    return answer(world);
}
wadi_result wadi_world_begin_save(wadi_world_id world, uint64_t* ticket) {
    *ticket = 1;
    return answer(world);
}
wadi_result wadi_world_end_save(wadi_world_id world, uint64_t ticket, void* data, size_t* size) {
    (void)ticket;
    return give_bytes(world, data, size);
}
wadi_result wadi_world_set_command_log(wadi_world_id world, wadi_bool on) {
    (void)on;
    return answer(world);
}
wadi_result wadi_world_set_source(wadi_world_id world, uint32_t index, const wadi_source* source) {
    (void)index, (void)source;
    return answer(world);
}

/* ---- The engine ---- */

Api api;
static uint64_t bytes[64];

static GDObjectInstanceID id_of(const void* of) { return of == &object ? 7 : 0; }
static GDExtensionObjectPtr object_of(GDObjectInstanceID id) { return id == 7 && node ? &object : NULL; }
static void* point(const void* array, GDExtensionInt n) {
    (void)array, (void)n;
    return bytes;
}
static void destroy_variant(void* variant) { (void)variant; }

void emit(Object from, const char* signal, Variant* arguments, int count) {
    (void)arguments, (void)count;
    expect(from == &object, "a signal is the node's");
    if (!heard_of || strcmp(signal, heard_of) != 0) return;
    heard_of = NULL; /* once */
    ++heard;
    if (listener == FREES_NODE) {
        free_node();
        return;
    }
    world_stop(node);
    if (listener != STARTS_ANEW) return;
    lost_at = 0;
    node->lost = false;
    expect(world_start(node) == 0, "another world starts");
}
bool has_listeners(Object from, const char* signal) {
    (void)from, (void)signal;
    return true;
}
void engine_call(EngineMethod method, Object of, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)of, (void)arguments;
    if (method == ENGINE_Node_get_physics_process_delta_time) *(double*)result = 1.0 / 60;
}
Object singleton(const char* name) {
    (void)name;
    return bytes;
}
void log_warning(const char* format, ...) { (void)format; }
void log_error(const char* format, ...) { (void)format; }
void value_free(GDExtensionVariantType type, void* value) { (void)type, (void)value; }
void value_move(GDExtensionVariantType type, void* to, const void* from) { (void)type, (void)from, *(char*)to = 1; }
void value_assign(GDExtensionVariantType type, void* to, const void* from) { (void)type, memcpy(to, from, sizeof(Object)); }
Variant variant_of(GDExtensionVariantType type, const void* value) {
    (void)type, (void)value;
    return (Variant){{0}};
}
Variant variant_of_float(double value) {
    (void)value;
    return (Variant){{0}};
}
String string_of(const char* utf8) {
    expect(strlen(utf8) < sizeof node->message, "a text that ends");
    return (String){NULL};
}
char* string_text(const String* string) {
    (void)string;
    return NULL;
}
PackedByteArray bytes_of(const void* data, size_t size) {
    (void)data, (void)size;
    return (PackedByteArray){{0}};
}
size_t bytes_size(const PackedByteArray* array) {
    (void)array;
    return 16;
}
const void* bytes_data(const PackedByteArray* array) {
    (void)array;
    return bytes;
}
uint8_t* bytes_new(PackedByteArray* array, size_t size) {
    (void)array, (void)size;
    return (uint8_t*)bytes;
}
float* floats_new(PackedFloat32Array* array, size_t count) {
    (void)array, (void)count;
    return (float*)(void*)bytes;
}
size_t points_size(const PackedVector2Array* points) {
    (void)points;
    return 1;
}
Array array_new(GDExtensionVariantType type, size_t size) {
    (void)type, (void)size;
    return (Array){NULL};
}
void array_set(Array* array, size_t n, GDExtensionVariantType type, const void* value) {
    (void)array, (void)n, (void)type, (void)value;
}
Dictionary dictionary_new(void) { return (Dictionary){NULL}; }
void dictionary_set(Dictionary* to, const char* key, GDExtensionVariantType type, const void* value) {
    (void)to, (void)key, (void)type, (void)value;
}
void dictionary_set_float(Dictionary* to, const char* key, double value) { (void)to, (void)key, (void)value; }

/* ---- The rest of the extension ---- */

const Class level_class;
void* instance_of(const Class* class, Object of) {
    (void)class, (void)of;
    return bytes;
}
wadi_result level_create_world(const Level* level, const wadi_device_options* options, wadi_world_id* world, char* message,
                               size_t size) {
    (void)level, (void)options, (void)message, (void)size;
    world->index = ++newest_world;
    if (newest_world >= sizeof alive) abort();
    alive[world->index] = true;
    return WADI_OK;
}
SharedDevice* shared_open(char* why, size_t size) {
    (void)why, (void)size;
    return NULL;
}
const wadi_vulkan_host* shared_host(const SharedDevice* device) {
    (void)device;
    return NULL;
}
void shared_close(SharedDevice* device, Textures* textures) { (void)device, (void)textures; }
bool textures_update_shared(Textures* textures, wadi_world_id world, wadi_output_mask mask, uint64_t step) {
    (void)textures, (void)world, (void)mask, (void)step;
    return true;
}
bool textures_update_host(Textures* textures, wadi_world_id world, const wadi_world_info* info, wadi_output_mask mask,
                          uint64_t step) {
    (void)textures, (void)world, (void)info, (void)mask, (void)step;
    return true;
}
void textures_clear(Textures* textures) { memset(textures->objects, 0, sizeof textures->objects); }
void floats_forget(Terrain* terrain) { terrain->body_queries = 0; }
void floats_tick(Terrain* terrain) { (void)terrain; }
double world_x(const Terrain* terrain, double x) { return x + terrain->info.dx; }
double world_y(const Terrain* terrain, double z) { return z + terrain->info.dx; }

/* ---- Every call of the node ---- */

static void tick(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments, (void)result;
    frame_tick(self);
}
static void sync_tick(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    ((Terrain*)self)->wait_for_device = true;
    tick(self, arguments, result);
}
static void set_outputs(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments, (void)result;
    world_outputs_changed(self);
}
static void set_pace(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments, (void)result;
    world_settings_changed(self);
}
typedef struct Action {
    const char* name;
    void (*call)(void* self, const GDExtensionConstTypePtr* arguments, void* result);
} Action;
static const Action actions[] = {
    {"start", terrain_start},
    {"a tick", tick},
    {"a tick that waits", sync_tick},
    {"step", terrain_step},
    {"sync_textures", terrain_sync_textures},
    {"get_texture", terrain_get_texture},
    {"get_heights", terrain_get_heights},
    {"get_dirty_regions", terrain_get_dirty_regions},
    {"get_bounds", terrain_get_bounds},
    {"query", terrain_query},
    {"get_query", terrain_get_query},
    {"save_state", terrain_save_state},
    {"load_state", terrain_load_state},
    {"begin_save", terrain_begin_save},
    {"open_source", terrain_open_source},
    {"set_source", terrain_set_source},
    {"close_source", terrain_close_source},
    {"set_command_log", terrain_set_command_log},
    {"get_commands", terrain_get_commands},
    {"play_commands", terrain_play_commands},
    {"outputs", set_outputs},
    {"max_steps_per_frame", set_pace},
};

/* One call of a fresh node, whose device is lost at library call `at` of it; how many such calls it made. */
static int run(const Action* action, const char* signal, int at) {
    static const struct { int64_t number[4]; } argument = {{WADI_OUTPUT_NORMAL}};
    static const Rect2i region = {0, 0, 2, 2};
    static const int64_t source = 0, layer = WADI_LAYER_WATER;
    static const Vector3 middle = {0, 0, 0};
    static const double one = 1;
    const bool of_region = action->call == terrain_get_heights || action->call == terrain_get_bounds;
    const GDExtensionConstTypePtr usual[] = {of_region ? (const void*)&region : (const void*)&argument},
                                  of_source[] = {&source, &layer, &middle, &one, &one};
    const GDExtensionConstTypePtr* arguments = usual;
    if (action->call == terrain_set_source || action->call == terrain_close_source) arguments = of_source;
    if (action->call == terrain_open_source) arguments = of_source + 1;
    uint64_t result[4] = {0};
    node = calloc(1, sizeof *node);
    node->object = &object;
    node->running = true;
    node->time_scale = 1;
    node->max_steps_per_frame = 8;
    node->outputs = 1;
    node->level = bytes;
    lost_at = 0;
    heard_of = NULL;
    if (action->call != terrain_start) world_start(node);
    node->sources[0] = (OpenSource){.open = true, .radius = 1, .discharge = 1};
    calls = 0;
    lost_at = at;
    heard_of = signal;
    const int before = heard;
    action->call(node, arguments, result);
    if (heard > before && listener == FREES_NODE) expect(node == NULL, "the node is gone");
    if (heard > before && listener == STOPS) expect(!node->started, "the world is gone");
    if (heard > before && listener == STARTS_ANEW)
        expect(node->started && alive[node->world.index], "the world that the listener started runs");
    const int made = calls;
    lost_at = 0;
    heard_of = NULL;
    if (node) free_node();
    return made;
}

int main(void) {
    api.object_get_instance_id = id_of;
    api.object_get_instance_from_id = object_of;
    api.packed_vector2_array_operator_index_const = point;
    api.variant_destroy = destroy_variant;
    for (listener = FREES_NODE; listener < LISTENERS; ++listener) {
        int told = heard;
        for (size_t n = 0; n < sizeof actions / sizeof *actions; ++n) {
            const int before = heard;
            for (int at = 1; run(&actions[n], "device_lost", at) >= at;) ++at;
            if (heard == before) expect(false, actions[n].name); /* no call of it was ever told */
        }
        run(&actions[1], "time_dropped", 0);
        run(&actions[1], "world_changed", 0);
        for (size_t n = 0; n < sizeof actions / sizeof *actions; ++n)
            if (actions[n].call == terrain_load_state) run(&actions[n], "state_loaded", 0);
        printf("who hears it %s: %d times\n", listener_names[listener], heard - told);
        expect(heard - told > 30, "losses are told");
    }
    for (uint32_t n = 1; n <= newest_world; ++n) expect(!alive[n], "every world was destroyed");
    puts(wrong == 0 ? "passed" : "FAILED");
    return wrong != 0;
}
