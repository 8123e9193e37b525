#include "terrain.h"

#include "engine/collections.h"
#include "engine/engine.h"
#include "float.h"
#include "level.h"

static void update_warnings(void* self) {
    const Terrain* terrain = self;
    call_plain(ENGINE_Node_update_configuration_warnings, terrain->object);
}

#define FIELD(type, name) #type " " #name, offsetof(Terrain, name)
static const Property properties[] = {
    {FIELD(WadiLevel, level), HINT_RESOURCE_TYPE, "WadiLevel", update_warnings},
    {FIELD(String, backend), HINT_ENUM_SUGGESTION, "auto,cpu,vulkan,cuda", NULL},
    {FIELD(int, threads), HINT_RANGE, "0,256", NULL},
    {FIELD(bool, share_device), HINT_NONE, NULL, NULL},
    {FIELD(bool, running), HINT_NONE, NULL, NULL},
    {FIELD(float, time_scale), HINT_RANGE, "0,10,0.01,or_greater", NULL},
    {FIELD(int, max_steps_per_frame), HINT_RANGE, "1,1024", world_settings_changed},
    {FIELD(bool, wait_for_device), HINT_NONE, NULL, world_settings_changed},
    {FIELD(int, outputs), HINT_FLAGS,
     "Terrain,Sand Surface,Surface,Sand Depth,Water Depth,Saturation,Flow,Sand Velocity,Foam,Normal,Smooth Surface,Packed,Packed "
     "Half,Wetness,Silt",
     world_outputs_changed},
    {0},
};

static const Method methods[] = {
    {"Error start()", terrain_start},
    {"void stop()", terrain_stop},
    {"bool is_started()", terrain_is_started},
    {"Error step(int count)", terrain_step},
    {"String get_hash()", terrain_get_hash},
    {"float get_time()", terrain_get_time},
    {"int get_step()", terrain_get_step},
    {"Vector2i get_cells()", terrain_get_cells},
    {"float get_cell_size()", terrain_get_cell_size},
    {"Vector2 get_extent()", terrain_get_extent},
    {"String get_last_message()", terrain_get_last_message},
    {"Dictionary get_stats()", terrain_get_stats},
    {"Texture2D get_texture(Output output)", terrain_get_texture},
    {"Error sync_textures()", terrain_sync_textures},
    {"Error brush(Layer layer, Vector3 position, float radius, float amount, float softness = 0.5)", terrain_brush},
    {"Error brush_line(Layer layer, Vector3 from, Vector3 to, float radius, float amount, float softness = 0.5)",
     terrain_brush_line},
    {"Error push(Vector3 position, float radius, Vector3 velocity, float strength = 1)", terrain_push},
    {"int open_source(Layer layer, Vector3 position, float radius, float discharge)", terrain_open_source},
    {"Error set_source(int index, Layer layer, Vector3 position, float radius, float discharge)", terrain_set_source},
    {"Error close_source(int index)", terrain_close_source},
    {"Error set_material(String name, float value)", terrain_set_material},
    {"Dictionary get_material()", terrain_get_material},
    {"int query(PackedVector2Array points)", terrain_query},
    {"Dictionary[] get_query(int ticket)", terrain_get_query},
    {"PackedFloat32Array get_heights(Rect2i region)", terrain_get_heights},
    {"Vector2 get_bounds(Rect2i region)", terrain_get_bounds},
    {"Rect2i[] get_dirty_regions(int since_step)", terrain_get_dirty_regions},
    {"int get_dirty_step()", terrain_get_dirty_step},
    {"PackedByteArray save_state()", terrain_save_state},
    {"Error load_state(PackedByteArray state)", terrain_load_state},
    {"Error begin_save()", terrain_begin_save},
    {"PackedByteArray end_save()", terrain_end_save},
    {"Error set_command_log(bool on)", terrain_set_command_log},
    {"PackedByteArray get_commands()", terrain_get_commands},
    {"Error play_commands(PackedByteArray commands)", terrain_play_commands},
    {0},
};

static const char* const signals[] = {
    "void started()",
    "void state_loaded()",
    "void time_dropped(float seconds)",
    "void device_lost(String message)",
    "void world_changed(Rect2i[] regions)",
    NULL,
};

static const Constant constants[] = {
    {"OUTPUT_TERRAIN", WADI_OUTPUT_TERRAIN, "Output"},
    {"OUTPUT_SAND_SURFACE", WADI_OUTPUT_SAND_SURFACE, "Output"},
    {"OUTPUT_SURFACE", WADI_OUTPUT_FREE_SURFACE, "Output"},
    {"OUTPUT_SAND_DEPTH", WADI_OUTPUT_SAND_DEPTH, "Output"},
    {"OUTPUT_WATER_DEPTH", WADI_OUTPUT_WATER_DEPTH, "Output"},
    {"OUTPUT_SATURATION", WADI_OUTPUT_SATURATION, "Output"},
    {"OUTPUT_FLOW", WADI_OUTPUT_FLOW, "Output"},
    {"OUTPUT_SAND_VELOCITY", WADI_OUTPUT_SAND_VELOCITY, "Output"},
    {"OUTPUT_FOAM", WADI_OUTPUT_FOAM, "Output"},
    {"OUTPUT_NORMAL", WADI_OUTPUT_NORMAL, "Output"},
    {"OUTPUT_SMOOTH_SURFACE", WADI_OUTPUT_SMOOTH_SURFACE, "Output"},
    {"OUTPUT_PACKED", WADI_OUTPUT_PACKED, "Output"},
    {"OUTPUT_PACKED_HALF", WADI_OUTPUT_PACKED_HALF, "Output"},
    {"OUTPUT_WETNESS", WADI_OUTPUT_WETNESS, "Output"},
    {"OUTPUT_SILT", WADI_OUTPUT_SILT, "Output"},
    {"LAYER_TERRAIN", WADI_LAYER_TERRAIN, "Layer"},
    {"LAYER_SAND", WADI_LAYER_SAND, "Layer"},
    {"LAYER_WATER", WADI_LAYER_WATER, "Layer"},
    {0},
};

static void create(void* self) {
    Terrain* terrain = self;
    const String automatic = string_of("auto");
    value_move(GDEXTENSION_VARIANT_TYPE_STRING, &terrain->backend, &automatic);
    terrain->running = true;
    terrain->time_scale = 1;
    terrain->max_steps_per_frame = 8;
    terrain->outputs = WADI_OUTPUT_BIT(WADI_OUTPUT_PACKED) | WADI_OUTPUT_BIT(WADI_OUTPUT_FLOW);
}

static void destroy(void* self) {
    floats_leave(self);
    world_stop(self);
}

static void notify(void* self, int32_t what, uint8_t reversed) {
    (void)reversed;
    Terrain* terrain = self;
    if (what == NOTIFICATION_READY && !in_editor()) {
        call_bool(ENGINE_Node_set_physics_process_internal, terrain->object, true);
        if (terrain->level && terrain->running && !terrain->started) world_start(terrain);
    } else if (what == NOTIFICATION_INTERNAL_PHYSICS_PROCESS) {
        frame_tick(terrain);
    }
}

static void warnings(void* self, PackedStringArray* list) {
    const Terrain* terrain = self;
    if (!instance_of(&level_class, terrain->level))
        strings_add(list, "A WadiTerrain3D needs a WadiLevel in its property \"level\".");
}

const Class terrain_class = {
    .name = "WadiTerrain3D",
    .parent = "Node3D",
    .bytes = sizeof(Terrain),
    .create = create,
    .destroy = destroy,
    .notify = notify,
    .warnings = warnings,
    .methods = methods,
    .properties = properties,
    .signals = signals,
    .constants = constants,
};
