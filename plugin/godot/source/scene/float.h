/* WadiFloat3D: the water's forces on the RigidBody3D that is its parent. */
#ifndef WADI_GODOT_FLOAT_H
#define WADI_GODOT_FLOAT_H

#include "terrain.h"

enum { MOST_SAMPLES = 16, MOST_POINTS = MOST_SAMPLES * MOST_SAMPLES };

struct Float {
    Object object;
    /* properties */
    NodePath terrain;
    int64_t shape, samples;
    Vector3 size;
    double radius, water_density, gravity, linear_drag, quadratic_drag;
    /* in the list of its terrain */
    Terrain* in;
    Float* next;
    bool told;                                      /* what keeps it from floating was logged */
    uint32_t asked_query, asked_first, asked_count; /* its points in one of the terrain's queries */
    uint32_t answer_count;
    wadi_query_result answers[MOST_POINTS];
};

extern const Class float_class;

/* floats.c: the bodies of a terrain. */
/** The RigidBody3D that floats, or NULL. */
Object float_body(const Float* body);
/** Logs what keeps it from floating, once per cause: it would be said at every tick. */
void float_tell(Float* body, const char* what);
/** Takes it from the list of its terrain. */
void float_leave(Float* body);

/** Gives each body of the terrain the force of the newest answers, and asks anew. */
void floats_tick(Terrain* terrain);
/** Forgets answers of a world that ends. */
void floats_forget(Terrain* terrain);
/** Takes all bodies from a terrain that goes. */
void floats_leave(Terrain* terrain);

#endif
