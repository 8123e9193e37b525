#include "level.h"

#include "engine/collections.h"
#include "engine/engine.h"
#include "engine/files.h"
#include "engine/system.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FIELD(type, name) #type " " #name, offsetof(Level, name)
static void changed(void* self) {
    const Level* level = self;
    call_plain(ENGINE_Resource_emit_changed, level->object);
}

static const Property properties[] = {
    {FIELD(String, file), HINT_FILE, "*.json,*.png,*.r16,*.npy,*.asc", changed},
    {FIELD(String, variant), HINT_NONE, NULL, changed},
    {FIELD(String, method), HINT_ENUM_SUGGESTION, "robust,published", changed},
    {FIELD(String, accuracy), HINT_ENUM_SUGGESTION, "draft,balanced,accurate,fine", changed},
    {FIELD(Vector2i, cells), HINT_NONE, NULL, changed},
    {FIELD(bool, drifting_foam), HINT_NONE, NULL, changed},
    {FIELD(String, settings), HINT_MULTILINE, NULL, changed},
    {FIELD(PackedFloat32Array, terrain), HINT_NONE, NULL, changed},
    {FIELD(PackedFloat32Array, sand), HINT_NONE, NULL, changed},
    {FIELD(PackedFloat32Array, water), HINT_NONE, NULL, changed},
    {0},
};

const Class level_class = {.name = "WadiLevel", .parent = "Resource", .bytes = sizeof(Level), .properties = properties};

/* The files beside a level, for the library's two calls for each: size, then bytes. */
typedef struct Reader {
    char folder[1024]; /* with its "/" */
    char name[1024];   /* of the file in `bytes` */
    PackedByteArray bytes;
} Reader;

static wadi_bool read_file(void* user, const char* name, void* data, size_t* size) {
    Reader* reader = user;
    if (strcmp(name, reader->name) != 0) {
        char path[2048];
        snprintf(path, sizeof path, "%s%s", reader->folder, name);
        if (strlen(name) >= sizeof reader->name || !file_exists(path)) return 0;
        strcpy(reader->name, name);
        PackedByteArray bytes = file_bytes(path);
        value_move(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &reader->bytes, &bytes);
    }
    const size_t has = bytes_size(&reader->bytes);
    if (data) {
        if (has > *size) return 0;
        if (has > 0) memcpy(data, bytes_data(&reader->bytes), has);
    }
    *size = has;
    return 1;
}

static wadi_result from_text(const char* path, const wadi_level_overrides* overrides, const wadi_device_options* options,
                             wadi_world_id* world) {
    PackedByteArray bytes = file_bytes(path);
    const size_t size = bytes_size(&bytes);
    char* text = malloc(size + 1);
    if (text) {
        if (size > 0) memcpy(text, bytes_data(&bytes), size);
        text[size] = 0;
    }
    value_free(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &bytes);
    if (!text) return WADI_ERROR_OUT_OF_MEMORY;

    Reader reader = {0};
    const char* slash = strrchr(path, '/');
    snprintf(reader.folder, sizeof reader.folder, "%.*s", slash ? (int)(slash - path + 1) : 0, path);
    value_new(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &reader.bytes);
    const wadi_result result = wadi_create_world_from_level_text(text, read_file, &reader, overrides, options, world);
    value_free(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &reader.bytes);
    free(text);
    return result;
}

/* A map alone, which the library reads from the disk itself: where only the engine has it, in an exported game's pack, by way of
 * a folder of its own. The map keeps its name there, which is the level's. */
static wadi_result from_map(const char* path, const wadi_level_overrides* overrides, const wadi_device_options* options,
                            wadi_world_id* world, char* message, size_t size) {
    char* global = global_path(path);
    if (global && access(global, R_OK) == 0) {
        const wadi_result result = wadi_create_world_from_level(global, overrides, options, world);
        free(global);
        return result;
    }
    free(global);
    const char* slash = strrchr(path, '/');
    char folder[1024], file[2048];
    if (!system_make_folder(folder, sizeof folder)) {
        snprintf(message, size, "level.file: \"%s\" is in a pack, and no folder \"%s\" can be made to read it from", path,
                 folder);
        return WADI_ERROR_BAD_FILE;
    }
    snprintf(file, sizeof file, "%s/%s", folder, slash ? slash + 1 : path);
    PackedByteArray bytes = file_bytes(path);
    const size_t has = bytes_size(&bytes);
    FILE* out = fopen(file, "wb");
    const bool written = out && (has == 0 || fwrite(bytes_data(&bytes), 1, has, out) == has);
    const bool closed = out && fclose(out) == 0;
    value_free(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &bytes);
    wadi_result result = WADI_ERROR_BAD_FILE;
    if (written && closed)
        result = wadi_create_world_from_level(file, overrides, options, world);
    else
        snprintf(message, size, "level.file: \"%s\" is in a pack and cannot be written to \"%s\" to read it from", path, file);
    unlink(file);
    rmdir(folder);
    return result;
}

static bool ends_in(const char* text, const char* end) {
    const size_t length = strlen(text), wanted = strlen(end);
    return length >= wanted && strcmp(text + length - wanted, end) == 0;
}

static wadi_result from_file(const Level* level, const char* path, const wadi_device_options* options, wadi_world_id* world,
                             char* message, size_t size) {
    char *variant = string_text(&level->variant), *method = string_text(&level->method),
         *accuracy = string_text(&level->accuracy);
    wadi_level_overrides overrides = wadi_default_level_overrides();
    overrides.nx = level->cells.x;
    overrides.ny = level->cells.y;
    overrides.variant = variant && *variant ? variant : NULL;
    overrides.method = method && *method ? method : NULL;
    overrides.accuracy = accuracy && *accuracy ? accuracy : NULL;
    overrides.draws = level->drifting_foam ? WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM) : 0;
    wadi_result result;
    if (!file_exists(path)) {
        snprintf(message, size, "level.file: there is no file \"%s\"", path);
        result = WADI_ERROR_NOT_FOUND;
    } else if (ends_in(path, ".json")) {
        result = from_text(path, &overrides, options, world);
    } else {
        result = from_map(path, &overrides, options, world, message, size);
    }
    free(variant);
    free(method);
    free(accuracy);
    return result;
}

static const float* field(const PackedFloat32Array* floats, const char* name, size_t cells, bool* good, char* message,
                          size_t size) {
    const size_t has = floats_size(floats);
    if (has == 0) return NULL;
    if (has != cells && *good) {
        snprintf(message, size, "level.%s: has %zu values; cells.x * cells.y are %zu", name, has, cells);
        *good = false;
    }
    return api.packed_float32_array_operator_index_const(floats, 0);
}

static wadi_result from_arrays(const Level* level, const wadi_device_options* options, wadi_world_id* world, char* message,
                               size_t size) {
    if (level->cells.x < 1 || level->cells.y < 1) {
        snprintf(message, size, "level.cells: (%d, %d); with settings it is the grid's nx and ny, 1 or more", level->cells.x,
                 level->cells.y);
        return WADI_ERROR_BAD_ARGUMENT;
    }
    const size_t cells = (size_t)level->cells.x * (size_t)level->cells.y;
    bool good = true;
    wadi_world_arrays arrays = wadi_default_world_arrays();
    arrays.nx = level->cells.x;
    arrays.ny = level->cells.y;
    arrays.terrain = field(&level->terrain, "terrain", cells, &good, message, size);
    arrays.sand = field(&level->sand, "sand", cells, &good, message, size);
    arrays.water = field(&level->water, "water", cells, &good, message, size);
    if (!good) return WADI_ERROR_BAD_ARGUMENT;
    char* settings = string_text(&level->settings);
    arrays.settings_json = settings;
    const wadi_result result = wadi_create_world_from_arrays(&arrays, options, world);
    free(settings);
    return result;
}

wadi_result level_create_world(const Level* level, const wadi_device_options* options, wadi_world_id* world, char* message,
                               size_t size) {
    *message = 0;
    wadi_result result;
    if (!string_is_empty(&level->settings)) {
        result = from_arrays(level, options, world, message, size);
    } else if (!string_is_empty(&level->file)) {
        char* path = string_text(&level->file);
        result = path ? from_file(level, path, options, world, message, size) : WADI_ERROR_OUT_OF_MEMORY;
        free(path);
    } else {
        snprintf(message, size, "level: has neither a file nor settings");
        result = WADI_ERROR_BAD_ARGUMENT;
    }
    if (result != WADI_OK && !*message) snprintf(message, size, "%s", wadi_get_last_error());
    return result;
}
