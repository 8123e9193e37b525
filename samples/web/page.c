#include "page.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wadi/wadi.h>

enum { MOST_FILES = 8 };
struct file {
    char name[64];
    size_t bytes;
    void* data;
};
struct kept {
    size_t room, bytes;
    void* data;
};

static struct file files[MOST_FILES];
static int file_count;
static wadi_world_id worlds[2];
static struct kept slots[PAGE_SLOTS];
static void* memory;
static size_t memory_bytes;
static char error_text[512];

static const wadi_output outputs[PAGE_OUTPUTS] = {WADI_OUTPUT_SAND_SURFACE,  WADI_OUTPUT_SAND_DEPTH, WADI_OUTPUT_WATER_DEPTH,
                                                  WADI_OUTPUT_SATURATION,    WADI_OUTPUT_FOAM,       WADI_OUTPUT_FLOW,
                                                  WADI_OUTPUT_SAND_VELOCITY, WADI_OUTPUT_WETNESS,    WADI_OUTPUT_SILT};

const char* page_error(void) { return error_text; }

static int failed(const char* why) {
    snprintf(error_text, sizeof(error_text), "%s", why);
    return -1;
}

static int done(wadi_result result) { return result == WADI_OK ? 0 : failed(wadi_get_last_error()); }

void* page_memory(size_t bytes) {
    if (bytes > memory_bytes) {
        void* larger = realloc(memory, bytes);
        if (larger == NULL) return NULL;
        memory = larger;
        memory_bytes = bytes;
    }
    return memory;
}

void page_forget_files(void) {
    while (file_count > 0) free(files[--file_count].data);
}

int page_add_file(const char* name, size_t bytes) {
    struct file* file = &files[file_count];
    if (file_count == MOST_FILES || strlen(name) >= sizeof(file->name)) return failed("too many files, or too long a name");
    file->data = malloc(bytes);
    if (file->data == NULL) return failed("no memory for a file of the level");
    memcpy(file->data, memory, bytes);
    strcpy(file->name, name);
    file->bytes = bytes;
    ++file_count;
    return 0;
}

static wadi_bool read_file(void* user, const char* name, void* data, size_t* size) {
    (void)user;
    for (int n = 0; n < file_count; ++n) {
        if (strcmp(files[n].name, name) != 0) continue;
        if (data != NULL) memcpy(data, files[n].data, files[n].bytes);
        *size = files[n].bytes;
        return 1;
    }
    return 0;
}

int page_close(int which) {
    if (worlds[which].generation == 0) return 0;
    const wadi_world_id world = worlds[which];
    memset(&worlds[which], 0, sizeof(worlds[which]));
    return done(wadi_destroy_world(world));
}

static uint32_t mask_of_outputs(void) {
    uint32_t mask = 0;
    for (int n = 0; n < PAGE_OUTPUTS; ++n) mask |= WADI_OUTPUT_BIT(outputs[n]);
    return mask;
}

int page_open(int which, const char* json, const char* variant, const char* accuracy, int draws, int threads) {
    wadi_level_overrides overrides = wadi_default_level_overrides();
    overrides.variant = variant[0] != 0 ? variant : NULL;
    overrides.accuracy = accuracy;
    const wadi_output drawn[] = {WADI_OUTPUT_FOAM, WADI_OUTPUT_WETNESS, WADI_OUTPUT_SILT};
    for (int n = 0; n < 3; ++n) overrides.draws |= (draws >> n & 1) != 0 ? WADI_OUTPUT_BIT(drawn[n]) : 0u;
    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = threads;
    wadi_world_id world;
    if (page_close(which) != 0 ||
        done(wadi_create_world_from_level_text(json, read_file, NULL, &overrides, &options, &world)) != 0)
        return -1;
    worlds[which] = world;
    if (which != 0) return 0;
    wadi_update_settings settings = wadi_default_update_settings();
    settings.max_steps_in_flight = 0;
    wadi_frame frame = wadi_default_frame();
    if (done(wadi_world_set_update_settings(world, &settings)) != 0 || done(wadi_world_set_command_log(world, 1)) != 0 ||
        done(wadi_world_set_outputs(world, mask_of_outputs())) != 0 || done(wadi_world_update(world, 0, &frame)) != 0)
        return -1;
    return done(wadi_world_wait_for_outputs(world));
}

const double* page_numbers(void) {
    static double numbers[PAGE_NUMBERS];
    wadi_world_info info = wadi_default_world_info();
    uint64_t steps = 0;
    if (done(wadi_world_get_info(worlds[0], &info)) != 0 ||
        done(wadi_world_get_time(worlds[0], &numbers[PAGE_TIME], &steps)) != 0)
        return NULL;
    numbers[PAGE_NX] = info.nx;
    numbers[PAGE_NY] = info.ny;
    numbers[PAGE_DX] = info.dx;
    numbers[PAGE_DT] = info.dt;
    numbers[PAGE_DURATION] = info.duration;
    numbers[PAGE_STEPS] = (double)steps;
    return numbers;
}

int page_advance(double seconds, int most) {
    wadi_update_settings settings = wadi_default_update_settings();
    settings.max_steps_in_flight = 0;
    settings.max_steps_per_update = (uint32_t)most;
    wadi_frame frame = wadi_default_frame();
    if (done(wadi_world_set_update_settings(worlds[0], &settings)) != 0 ||
        done(wadi_world_update(worlds[0], (uint64_t)(seconds * 1e9), &frame)) != 0 ||
        done(wadi_world_wait_for_outputs(worlds[0])) != 0)
        return -1;
    return (int)frame.steps;
}

int page_step(int which, int steps) {
    uint64_t now = 0;
    if (done(wadi_world_step(worlds[which], (uint32_t)steps)) != 0) return -1;
    if (which == 0) { /* to be drawn */
        wadi_frame frame = wadi_default_frame();
        if (done(wadi_world_update(worlds[0], 0, &frame)) != 0) return -1;
        return done(wadi_world_wait_for_outputs(worlds[0]));
    }
    const wadi_region one = {0, 0, 1, 1};
    float depth;
    if (done(wadi_world_get_time(worlds[which], NULL, &now)) != 0) return -1;
    return done(wadi_world_read_region(worlds[which], WADI_FIELD_SAND_DEPTH, &one, &depth, 1)); /* which waits */
}

static wadi_output_view view_of(int n) {
    wadi_output_view view = wadi_default_output_view();
    if (done(wadi_world_get_view(worlds[0], outputs[n], WADI_OUTPUT_CURRENT, &view)) != 0) view.handle = 0;
    return view;
}

const float* page_output(int n) {
    const wadi_output_view view = view_of(n);
    return view.handle == 0 ? NULL : (const float*)(uintptr_t)(view.handle + view.offset);
}

int page_row_floats(int n) { return (int)(view_of(n).row_pitch / sizeof(float)); }

int page_brush(int layer, double x0, double y0, double x1, double y1, double radius, double softness, double amount) {
    wadi_edit edit = wadi_default_edit();
    edit.layer = (wadi_layer)layer;
    edit.capsule = 1;
    edit.x0 = x0;
    edit.y0 = y0;
    edit.x1 = x1;
    edit.y1 = y1;
    edit.radius = radius;
    edit.softness = softness;
    edit.amount = amount;
    return done(wadi_world_edit(worlds[0], &edit, 1));
}

int page_make_stamp(int nx, int ny) {
    uint32_t stamp = 0;
    return done(wadi_world_create_stamp(worlds[0], nx, ny, memory, &stamp)) == 0 ? (int)stamp : -1;
}

int page_press(int stamp, int layer, double x0, double y0, double x1, double y1, double amount) {
    wadi_edit edit = wadi_default_edit();
    edit.kind = WADI_EDIT_STAMP;
    edit.layer = (wadi_layer)layer;
    edit.stamp = (uint32_t)stamp;
    edit.x0 = x0;
    edit.y0 = y0;
    edit.x1 = x1;
    edit.y1 = y1;
    edit.amount = amount;
    return done(wadi_world_edit(worlds[0], &edit, 1));
}

double page_material(const char* name) {
    wadi_material_info infos[64];
    uint32_t count = 64;
    if (done(wadi_world_get_material(worlds[0], infos, &count)) != 0) return NAN;
    for (uint32_t n = 0; n < count; ++n)
        if (strcmp(infos[n].name, name) == 0) return infos[n].value;
    failed("the material has no such number");
    return NAN;
}

int page_set_material(int which, const char* name, double value) {
    return done(wadi_world_set_material(worlds[which], name, value));
}

const char* page_hash(int which) {
    static char text[17];
    uint64_t hash = 0;
    if (done(wadi_world_get_hash(worlds[which], &hash)) != 0) return NULL;
    snprintf(text, sizeof(text), "%016llx", (unsigned long long)hash);
    return text;
}

int page_log(void) {
    size_t size = 0;
    if (done(wadi_world_get_commands(worlds[0], NULL, &size)) != 0) return -1;
    if (page_memory(size) == NULL) return failed("no memory for the log");
    return done(wadi_world_get_commands(worlds[0], memory, &size)) == 0 ? (int)size : -1;
}

int page_play(size_t bytes) { return done(wadi_world_play_commands(worlds[0], memory, bytes)); }

int page_keep(int slot) {
    struct kept* kept = &slots[slot];
    size_t size = 0;
    if (done(wadi_world_save(worlds[0], NULL, &size)) != 0) return -1;
    if (size > kept->room) {
        void* larger = realloc(kept->data, size);
        if (larger == NULL) return failed("no memory for the state");
        kept->data = larger;
        kept->room = size;
    }
    kept->bytes = kept->room;
    return done(wadi_world_save(worlds[0], kept->data, &kept->bytes));
}

int page_back(int which, int slot) {
    if (done(wadi_world_load(worlds[which], slots[slot].data, slots[slot].bytes)) != 0) return -1;
    return which == 0 ? page_step(0, 0) : 0;
}
