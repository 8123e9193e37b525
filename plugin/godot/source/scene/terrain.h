/* WadiTerrain3D: a world in the scene. Wadi's x is the node's x, y is -z, heights are y; the grid is centred on the node. */
#ifndef WADI_GODOT_TERRAIN_H
#define WADI_GODOT_TERRAIN_H

#include "engine/classes.h"
#include "textures.h"

#include <wadi/wadi.h>

typedef struct Float Float;

/* Of 65536 points each: 1024 bodies with the most samples. A world answers eight at a time, and the scene may ask, too. */
enum { MOST_BODY_QUERIES = 4, MOST_QUERY_POINTS = 65536 };
/* Of a world, its level's among them (wadi_world_set_source). */
enum { MOST_SOURCES = 32 };

/* A source as the scene set it last, in the world's axes. */
typedef struct OpenSource {
    bool open, sand;
    double x, y, radius, discharge;
} OpenSource;

typedef struct Terrain {
    Object object;
    /* properties */
    Object level; /* a reference to a WadiLevel, or NULL */
    String backend;
    int64_t threads, max_steps_per_frame, outputs;
    double time_scale;
    uint8_t running, share_device, wait_for_device;
    /* the world, while started */
    bool started, lost;
    wadi_world_id world;
    wadi_world_info info;
    double nanoseconds_left; /* below one, of physics ticks so far */
    bool heights_asked;      /* copies of the solid surface come to the host */
    int updates_due;         /* that textures still want where no time goes on */
    uint64_t dirty_step;     /* of the newest get_dirty_regions */
    uint64_t told_step;      /* up to which world_changed told */
    Textures textures;
    uint64_t save_ticket; /* 0 = none under way */
    void* save_data;
    size_t save_bytes;
    uint64_t body_tickets[MOST_BODY_QUERIES]; /* of the queries for all bodies */
    uint32_t body_queries;                    /* how many are under way */
    Float* floats;                            /* a list */
    OpenSource sources[MOST_SOURCES];         /* by their numbers; none of the level */
    char message[512];
} Terrain;

extern const Class terrain_class;

/* world.c: one world's life. Functions named terrain_... are methods and have the engine's pointers. */
void terrain_start(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_stop(void* self, const GDExtensionConstTypePtr* arguments, void* result);
int64_t world_start(Terrain* terrain);
void world_stop(Terrain* terrain);
void world_settings_changed(void* self);
void world_outputs_changed(void* self);

/* report.c */
/** Keeps and logs the text of an error that `call` met; the engine's error. A lost device is told by its signal. */
int64_t world_failed(Terrain* terrain, const char* call, wadi_result result);
/** The same for an error of the extension's own. */
int64_t world_refused(Terrain* terrain, int64_t error, const char* format, ...) __attribute__((format(printf, 3, 4)));
/** Whether there is a world; where not it logs that `call` needs one. */
bool world_needed(Terrain* terrain, const char* call);

/* outputs.c */
/** Tells the library what to publish. */
wadi_result world_set_outputs(Terrain* terrain);

/* frame.c */
void frame_tick(Terrain* terrain);
/** Waits until the textures show the present state. */
wadi_result frame_sync(Terrain* terrain);
void terrain_step(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_sync_textures(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_texture(void* self, const GDExtensionConstTypePtr* arguments, void* result);

/* edits.c */
void terrain_brush(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_brush_line(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_push(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_set_material(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_material(void* self, const GDExtensionConstTypePtr* arguments, void* result);

/* sources.c */
void terrain_open_source(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_set_source(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_close_source(void* self, const GDExtensionConstTypePtr* arguments, void* result);

/* reads.c */
void terrain_is_started(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_hash(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_time(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_step(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_cells(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_cell_size(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_extent(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_last_message(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_stats(void* self, const GDExtensionConstTypePtr* arguments, void* result);

/* surface.c */
void terrain_query(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_query(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_heights(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_bounds(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_dirty_regions(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_dirty_step(void* self, const GDExtensionConstTypePtr* arguments, void* result);
/** The rectangles that changed after step `since` (-1 = ever) as Array[Rect2i], and the step that they are of. */
wadi_result surface_dirty_regions(Terrain* terrain, int64_t since, Array* regions, size_t* count, uint64_t* step);

/* saves.c */
void terrain_save_state(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_load_state(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_begin_save(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_end_save(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_set_command_log(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_get_commands(void* self, const GDExtensionConstTypePtr* arguments, void* result);
void terrain_play_commands(void* self, const GDExtensionConstTypePtr* arguments, void* result);

#endif
