#include "engine/engine.h"
#include "float.h"
#include "pose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void float_leave(Float* body) {
    if (!body->in) return;
    for (Float** link = &body->in->floats; *link; link = &(*link)->next) {
        if (*link != body) continue;
        *link = body->next;
        break;
    }
    body->in = NULL;
    body->asked_count = body->answer_count = 0;
}

Object float_body(const Float* body) {
    Object parent = NULL;
    engine_call(ENGINE_Node_get_parent, body->object, NULL, &parent);
    return cast_to(parent, "RigidBody3D");
}

void float_tell(Float* body, const char* what) {
    if (!body->told) log_error("WadiFloat3D: %s", what);
    body->told = true;
}

/* The body as it is now. */
static bool state_of(const Terrain* terrain, const Transform3D* pose, const Float* body, wadi_body* state) {
    const Object rigid = float_body(body);
    if (!rigid) return false;
    Transform3D place;
    Vector3 velocity, turning;
    engine_call(ENGINE_Node3D_get_global_transform, rigid, NULL, &place);
    engine_call(ENGINE_RigidBody3D_get_linear_velocity, rigid, NULL, &velocity);
    engine_call(ENGINE_RigidBody3D_get_angular_velocity, rigid, NULL, &turning);
    *state = wadi_default_body();
    state->shape = (wadi_body_shape)body->shape;
    pose_point(terrain, pose, place.origin, state->position);
    pose_orientation(pose, place.rows, state->orientation);
    pose_to_world(pose, velocity, state->velocity);
    pose_to_world(pose, turning, state->angular_velocity);
    state->half_size[0] = body->size.x / 2;
    state->half_size[1] = body->size.z / 2;
    state->half_size[2] = body->size.y / 2;
    state->radius = (float)body->radius;
    state->water_density = (float)body->water_density;
    state->gravity = (float)body->gravity;
    state->linear_drag = (float)body->linear_drag;
    state->quadratic_drag = (float)body->quadratic_drag;
    state->samples = body->samples >= 0 && body->samples <= MOST_SAMPLES ? (int32_t)body->samples : -1;
    return true;
}

static void apply(Float* body, const Terrain* terrain, const Transform3D* pose) {
    wadi_body state;
    float force[3], torque[3];
    if (body->answer_count == 0 || !state_of(terrain, pose, body, &state)) return;
    if (wadi_buoyancy_force(&state, body->answers, body->answer_count, force, torque) != WADI_OK) {
        float_tell(body, wadi_get_last_error());
        return;
    }
    const Object rigid = float_body(body);
    const Vector3 scene_force = pose_to_scene(pose, force), scene_torque = pose_to_scene(pose, torque), middle = {0, 0, 0};
    const GDExtensionConstTypePtr force_arguments[] = {&scene_force, &middle}, torque_arguments[] = {&scene_torque};
    engine_call(ENGINE_RigidBody3D_apply_force, rigid, force_arguments, NULL);
    engine_call(ENGINE_RigidBody3D_apply_torque, rigid, torque_arguments, NULL);
}

static void take_query(Terrain* terrain, uint32_t query) {
    uint32_t count = 0;
    if (wadi_world_get_query(terrain->world, terrain->body_tickets[query], NULL, 0, &count, NULL) != WADI_OK) return;
    wadi_query_result* all = malloc(count * sizeof *all);
    if (!all) return;
    if (wadi_world_get_query(terrain->world, terrain->body_tickets[query], all, count, &count, NULL) == WADI_OK) {
        for (Float* body = terrain->floats; body; body = body->next) {
            if (body->asked_query != query || body->asked_first + body->asked_count > count) continue;
            memcpy(body->answers, all + body->asked_first, body->asked_count * sizeof *all);
            body->answer_count = body->asked_count;
        }
    }
    free(all);
}

/* Of all queries, once the last of them is answered; none of those that made room for the scene's own. */
static void take_answers(Terrain* terrain) {
    uint32_t count = 0;
    for (uint32_t query = 0; query < terrain->body_queries; ++query)
        if (wadi_world_get_query(terrain->world, terrain->body_tickets[query], NULL, 0, &count, NULL) == WADI_NOT_READY) return;
    for (uint32_t query = 0; query < terrain->body_queries; ++query) take_query(terrain, query);
    terrain->body_queries = 0;
}

/* The points of a body, MOST_POINTS at most, from `to` on; how many. */
static uint32_t points_of(const Terrain* terrain, const Transform3D* pose, Float* body, float* to) {
    wadi_body state;
    uint32_t own = MOST_POINTS;
    if (!state_of(terrain, pose, body, &state)) return 0;
    if (wadi_buoyancy_points(&state, to, &own) != WADI_OK) {
        float_tell(body, wadi_get_last_error());
        return 0;
    }
    bool finite = true;
    for (uint32_t n = 0; n < 2 * own; ++n) finite = finite && isfinite(to[n]);
    if (finite) return own;
    float_tell(body, "the body's place is not finite");
    return 0;
}

static bool send(Terrain* terrain, const float* points, uint32_t count, Float* first) {
    if (count == 0) return true;
    const wadi_result result = wadi_world_query(terrain->world, points, count, &terrain->body_tickets[terrain->body_queries]);
    if (result == WADI_OK) ++terrain->body_queries;
    if (result != WADI_OK && result != WADI_NOT_READY) float_tell(first, wadi_get_last_error());
    return result == WADI_OK;
}

static void ask(Terrain* terrain, const Transform3D* pose) {
    size_t room = 0;
    for (Float* body = terrain->floats; body && room < MOST_QUERY_POINTS; body = body->next) room += MOST_POINTS;
    float* points = malloc(room * 2 * sizeof *points);
    if (!points) return;
    uint32_t count = 0;
    bool asking = true; /* a query that is refused, or one too many, ends it for this tick */
    Float* first = terrain->floats;
    for (Float* body = terrain->floats; body; body = body->next) {
        body->asked_count = 0;
        if (asking && count + MOST_POINTS > MOST_QUERY_POINTS) {
            asking = send(terrain, points, count, first);
            count = 0;
            first = body;
        }
        if (asking && terrain->body_queries == MOST_BODY_QUERIES) {
            asking = false;
            float_tell(body, "more than 262144 points of bodies in one terrain: this body and those behind it do not float");
        }
        if (!asking) {
            body->answer_count = 0;
            continue;
        }
        body->asked_query = terrain->body_queries;
        body->asked_first = count;
        body->asked_count = points_of(terrain, pose, body, points + 2 * count);
        count += body->asked_count;
    }
    if (asking) send(terrain, points, count, first);
    free(points);
}

void floats_tick(Terrain* terrain) {
    if (!terrain->floats) return;
    Transform3D pose;
    if (!pose_of_terrain(terrain, &pose)) {
        float_tell(terrain->floats, "the terrain's node is scaled or sheared; bodies float only on one that is not");
        return;
    }
    take_answers(terrain);
    for (Float* body = terrain->floats; body; body = body->next) apply(body, terrain, &pose);
    if (terrain->body_queries == 0) ask(terrain, &pose);
}

void floats_forget(Terrain* terrain) {
    terrain->body_queries = 0;
    for (Float* body = terrain->floats; body; body = body->next) body->asked_count = body->answer_count = 0;
}

void floats_leave(Terrain* terrain) {
    while (terrain->floats) float_leave(terrain->floats);
}
