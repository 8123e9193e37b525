#include "engine/collections.h"
#include "engine/engine.h"
#include "results.h"
#include "terrain.h"

#include <stdlib.h>

static void give(void* result, PackedByteArray* bytes) { value_move(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, result, bytes); }

typedef wadi_result (*Writer)(wadi_world_id world, void* data, size_t* size);

/* The bytes of a call that tells its size first. */
static void write_bytes(Terrain* terrain, const char* call, Writer writer, void* result) {
    if (!world_needed(terrain, call)) return;
    size_t size = 0;
    wadi_result outcome = writer(terrain->world, NULL, &size);
    PackedByteArray bytes;
    uint8_t* room = bytes_new(&bytes, size);
    if (outcome == WADI_OK) outcome = room ? writer(terrain->world, room, &size) : WADI_ERROR_OUT_OF_MEMORY;
    if (outcome == WADI_OK) {
        give(result, &bytes);
        return;
    }
    value_free(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &bytes);
    world_failed(terrain, call, outcome);
}

typedef wadi_result (*Reader)(wadi_world_id world, const void* data, size_t size);

static int64_t read_bytes(Terrain* terrain, const char* call, Reader reader, const PackedByteArray* bytes) {
    if (!world_needed(terrain, call)) return ERROR_UNCONFIGURED;
    const void* data = bytes_data(bytes);
    const wadi_result outcome = reader(terrain->world, data ? data : "", bytes_size(bytes));
    terrain->updates_due = 2;
    return outcome == WADI_OK ? ERROR_OK : world_failed(terrain, call, outcome);
}

void terrain_save_state(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    write_bytes(self, "save_state", wadi_world_save, result);
}

void terrain_load_state(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    *(int64_t*)result = read_bytes(terrain, "load_state", wadi_world_load, arguments[0]);
    if (*(int64_t*)result == ERROR_OK) emit(terrain->object, "state_loaded", NULL, 0);
}

void terrain_begin_save(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    Terrain* terrain = self;
    *(int64_t*)result = ERROR_UNCONFIGURED;
    if (!world_needed(terrain, "begin_save")) return;
    *(int64_t*)result = ERROR_BUSY;
    if (terrain->save_data) return; /* a worker may be filling it */
    uint64_t ticket = 0;
    wadi_result outcome = wadi_world_begin_save(terrain->world, &ticket);
    if (outcome == WADI_NOT_READY) return;
    terrain->save_bytes = 0;
    if (outcome == WADI_OK) outcome = wadi_world_end_save(terrain->world, ticket, NULL, &terrain->save_bytes);
    if (outcome == WADI_OK) {
        terrain->save_data = malloc(terrain->save_bytes);
        if (!terrain->save_data) {
            *(int64_t*)result =
                world_refused(terrain, ERROR_OUT_OF_MEMORY, "begin_save: no memory for %zu bytes", terrain->save_bytes);
            return;
        }
    }
    terrain->save_ticket = ticket;
    *(int64_t*)result = outcome == WADI_OK ? ERROR_OK : world_failed(terrain, "begin_save", outcome);
}

void terrain_end_save(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    Terrain* terrain = self;
    if (!world_needed(terrain, "end_save")) return;
    if (!terrain->save_data) {
        world_refused(terrain, 0, "end_save: no save is under way; begin_save() begins one");
        return;
    }
    size_t size = terrain->save_bytes;
    const wadi_result outcome = wadi_world_end_save(terrain->world, terrain->save_ticket, terrain->save_data, &size);
    if (outcome == WADI_NOT_READY) return;
    if (outcome != WADI_OK) {
        world_failed(terrain, "end_save", outcome); /* the memory stays: the library may go on filling it */
        return;
    }
    PackedByteArray bytes = bytes_of(terrain->save_data, size);
    give(result, &bytes);
    free(terrain->save_data);
    terrain->save_data = NULL;
}

void terrain_set_command_log(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    *(int64_t*)result = ERROR_UNCONFIGURED;
    if (!world_needed(terrain, "set_command_log")) return;
    const wadi_result outcome = wadi_world_set_command_log(terrain->world, *(const uint8_t*)arguments[0] != 0);
    *(int64_t*)result = outcome == WADI_OK ? ERROR_OK : world_failed(terrain, "set_command_log", outcome);
}

void terrain_get_commands(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    write_bytes(self, "get_commands", wadi_world_get_commands, result);
}

void terrain_play_commands(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    *(int64_t*)result = read_bytes(self, "play_commands", wadi_world_play_commands, arguments[0]);
}
