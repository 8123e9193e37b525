/* Any number of bodies floats, or is told that it does not: the node's sources against an engine that this file plays and the
 * library itself. A query takes 65 536 points, a world eight queries at a time. */
#include "engine/engine.h"
#include "float.h"
#include "pose.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { QUERIES = 8 };

/* ---- The engine: a node, the body above it ---- */

typedef struct Rigid {
    Float node;
    Vector3 place, force;
    int forces;
} Rigid;

static int terrain_object, wrong, told;
static char newest[256];

static void expect(bool good, const char* what, int count) {
    if (good) return;
    ++wrong;
    fprintf(stderr, "WRONG: %s (%d bodies)\n", what, count);
}

void engine_call(EngineMethod method, Object of, const GDExtensionConstTypePtr* arguments, void* result) {
    Rigid* body = of;
    switch (method) {
    case ENGINE_Node_get_parent:
        *(Object*)result = of;
        break;
    case ENGINE_Node3D_get_global_transform:
        *(Transform3D*)result =
            (Transform3D){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, of == &terrain_object ? (Vector3){0, 0, 0} : body->place};
        break;
    case ENGINE_RigidBody3D_get_linear_velocity:
    case ENGINE_RigidBody3D_get_angular_velocity:
        *(Vector3*)result = (Vector3){0, 0, 0};
        break;
    case ENGINE_RigidBody3D_apply_force:
        body->force = *(const Vector3*)arguments[0];
        ++body->forces;
        break;
    default:
        break;
    }
}
Object cast_to(Object object, const char* class_name) {
    (void)class_name;
    return object;
}
void log_error(const char* format, ...) {
    va_list values;
    va_start(values, format);
    vsnprintf(newest, sizeof newest, format, values);
    va_end(values);
    ++told;
}

/* ---- Bodies in a pond ---- */

static Terrain terrain;

static void tick(Rigid* bodies, int count) {
    for (int n = 0; n < count; ++n) bodies[n].forces = 0;
    floats_tick(&terrain);
    uint64_t hash = 0; /* waits, so that what was asked is answered */
    expect(wadi_world_step(terrain.world, 1) == WADI_OK && wadi_world_get_hash(terrain.world, &hash) == WADI_OK, "a step", count);
}

static Rigid* add(int count, int samples) {
    Rigid* bodies = calloc((size_t)count, sizeof *bodies);
    if (!bodies) abort();
    terrain.floats = NULL;
    for (int n = count; n-- > 0;) {
        Float* node = &bodies[n].node;
        node->object = &bodies[n];
        node->shape = WADI_BODY_BOX;
        node->size = (Vector3){1, 1, 1};
        node->samples = samples;
        node->water_density = 1000;
        node->gravity = 10;
        bodies[n].place = (Vector3){(float)(n % 7) - 3, 2, (float)(n % 5) - 2};
        node->in = &terrain;
        node->next = terrain.floats;
        terrain.floats = node;
    }
    told = 0;
    return bodies;
}

static void remove_all(Rigid* bodies) {
    floats_forget(&terrain);
    floats_leave(&terrain);
    free(bodies);
}

/* Half of a cubic metre is under water. */
static bool floats(const Rigid* body) { return body->forces == 1 && body->force.y > 4990 && body->force.y < 5010; }

static void pond(int count, int samples, int afloat) {
    Rigid* bodies = add(count, samples);
    tick(bodies, count);
    int early = 0;
    for (int n = 0; n < count; ++n) early += bodies[n].forces;
    expect(early == 0, "a force ahead of any answer", count);
    for (int again = 0; again < 3; ++again) {
        tick(bodies, count);
        int good = 0, none = 0;
        for (int n = 0; n < count; ++n) {
            good += n < afloat && floats(&bodies[n]) ? 1 : 0;
            none += n >= afloat && bodies[n].forces == 0 ? 1 : 0;
        }
        expect(good == afloat, "each has its buoyancy at every tick", count);
        expect(none == count - afloat, "those behind the most have none", count);
    }
    expect(told == (afloat < count ? 1 : 0), told > 0 ? newest : "nothing is told of bodies that do not float", count);
    expect(afloat == count || strstr(newest, "do not float"), "what is told says what happens", count);
    remove_all(bodies);
}

/* A scene that asks so much that the bodies' own answers make room for its: they ask again, and float. */
static void pond_of_a_scene_that_asks(int count) {
    Rigid* bodies = add(count, 16);
    tick(bodies, count);
    const float point[2] = {8, 8};
    for (int n = 0; n < QUERIES; ++n) {
        uint64_t ticket = 0;
        expect(wadi_world_query(terrain.world, point, 1, &ticket) == WADI_OK, "a query of the scene's own", count);
    }
    for (int again = 0; again < 3; ++again) tick(bodies, count);
    int good = 0;
    for (int n = 0; n < count; ++n) good += floats(&bodies[n]) ? 1 : 0;
    expect(good == count, "each floats again", count);
    remove_all(bodies);
}

int main(void) {
    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 2;
    terrain.object = &terrain_object;
    terrain.info = wadi_default_world_info();
    const char* level =
        "{ \"format_version\": 1, \"name\": \"pond\", \"dt\": 0.01, \"grid\": { \"nx\": 16, \"ny\": 16, \"dx\": 1 },"
        "\"water\": [ { \"shape\": \"plane\", \"height\": 2 } ] }";
    if (wadi_create_world_from_level_text(level, NULL, NULL, NULL, &options, &terrain.world) != WADI_OK ||
        wadi_world_get_info(terrain.world, &terrain.info) != WADI_OK) {
        fprintf(stderr, "WRONG: %s\n", wadi_get_last_error());
        return 1;
    }
    static const int counts[] = {1, 255, 256, 257, 512, 600, 1023, 1024};
    for (size_t n = 0; n < sizeof counts / sizeof *counts; ++n) pond(counts[n], 16, counts[n]);
    pond(1025, 16, 1024);
    pond(1300, 16, 1024);
    pond(1000, 3, 1000);
    pond_of_a_scene_that_asks(300);
    expect(wadi_destroy_world(terrain.world) == WADI_OK, "the end", 0);
    puts(wrong == 0 ? "passed" : "FAILED");
    return wrong != 0;
}
