#include "float.h"

#include "engine.h"
#include "pose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void update_warnings(void* self) {
    const Float* body = self;
    call_plain(ENGINE_Node_update_configuration_warnings, body->object);
}

static void leave(Float* body) {
    if (!body->in) return;
    for (Float** link = &body->in->floats; *link; link = &(*link)->next) {
        if (*link != body) continue;
        *link = body->next;
        break;
    }
    body->in = NULL;
    body->asked_count = body->answer_count = 0;
}

static void terrain_changed(void* self) {
    Float* body = self;
    leave(body);
    body->told = false;
    update_warnings(self);
}

#define FIELD(type, name) #type " " #name, offsetof(Float, name)
static const Property properties[] = {
    {FIELD(NodePath, terrain), HINT_NODE_PATH_TYPES, "WadiTerrain3D", terrain_changed},
    {FIELD(int, shape), HINT_ENUM, "Box,Sphere", NULL},
    {FIELD(Vector3, size), HINT_NONE, NULL, NULL},
    {FIELD(float, radius), HINT_RANGE, "0.01,100,0.01,or_greater", NULL},
    {FIELD(int, samples), HINT_RANGE, "1,16", NULL},
    {FIELD(float, water_density), HINT_RANGE, "0,2000,1,or_greater", NULL},
    {FIELD(float, gravity), HINT_RANGE, "0,20,0.01,or_greater", NULL},
    {FIELD(float, linear_drag), HINT_RANGE, "0,1000,0.1,or_greater", NULL},
    {FIELD(float, quadratic_drag), HINT_RANGE, "0,10,0.01,or_greater", NULL},
    {0},
};

static const Constant constants[] = {
    {"SHAPE_BOX", WADI_BODY_BOX, "Shape"},
    {"SHAPE_SPHERE", WADI_BODY_SPHERE, "Shape"},
    {0},
};

static void create(void* self) {
    Float* body = self;
    const wadi_body fresh = wadi_default_body();
    body->size = (Vector3){2 * fresh.half_size[0], 2 * fresh.half_size[1], 2 * fresh.half_size[2]};
    body->radius = (double)fresh.radius;
    body->samples = fresh.samples;
    body->water_density = (double)fresh.water_density;
    body->gravity = 9.8; /* the engine's default */
    body->linear_drag = (double)fresh.linear_drag;
    body->quadratic_drag = (double)fresh.quadratic_drag;
}

static void destroy(void* self) { leave(self); }

static Object rigid_body(const Float* body) {
    Object parent = NULL;
    engine_call(ENGINE_Node_get_parent, body->object, NULL, &parent);
    return cast_to(parent, "RigidBody3D");
}

static Terrain* find_terrain(const Float* body) {
    Object node = NULL;
    const GDExtensionConstTypePtr arguments[] = {&body->terrain};
    engine_call(ENGINE_Node_get_node_or_null, body->object, arguments, &node);
    return instance_of(&terrain_class, node);
}

/* Once per cause: a body that cannot float would say so at every tick. */
static void tell(Float* body, const char* what) {
    if (!body->told) log_error("WadiFloat3D: %s", what);
    body->told = true;
}

static void join(Float* body) {
    Terrain* terrain = find_terrain(body);
    if (!terrain)
        tell(body, "terrain: leads to no WadiTerrain3D");
    else if (!rigid_body(body))
        tell(body, "the parent is no RigidBody3D");
    else {
        body->in = terrain;
        body->next = terrain->floats;
        terrain->floats = body;
    }
}

static void notify(void* self, int32_t what, uint8_t reversed) {
    (void)reversed;
    Float* body = self;
    if (what == NOTIFICATION_READY && !in_editor())
        call_bool(ENGINE_Node_set_physics_process_internal, body->object, true);
    else if (what == NOTIFICATION_INTERNAL_PHYSICS_PROCESS && !body->in)
        join(body);
    else if (what == NOTIFICATION_EXIT_TREE)
        leave(body);
}

static void warnings(void* self, PackedStringArray* list) {
    const Float* body = self;
    if (!rigid_body(body)) strings_add(list, "A WadiFloat3D must be a child of a RigidBody3D.");
    if (!find_terrain(body)) strings_add(list, "A WadiFloat3D needs the path of a WadiTerrain3D in its property \"terrain\".");
}

const Class float_class = {
    .name = "WadiFloat3D",
    .parent = "Node",
    .bytes = sizeof(Float),
    .create = create,
    .destroy = destroy,
    .notify = notify,
    .warnings = warnings,
    .properties = properties,
    .constants = constants,
};

/* The body as it is now. */
static bool state_of(const Terrain* terrain, const Transform3D* pose, const Float* body, wadi_body* state) {
    const Object rigid = rigid_body(body);
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
        tell(body, wadi_get_last_error());
        return;
    }
    const Object rigid = rigid_body(body);
    const Vector3 scene_force = pose_to_scene(pose, force), scene_torque = pose_to_scene(pose, torque), middle = {0, 0, 0};
    const GDExtensionConstTypePtr force_arguments[] = {&scene_force, &middle}, torque_arguments[] = {&scene_torque};
    engine_call(ENGINE_RigidBody3D_apply_force, rigid, force_arguments, NULL);
    engine_call(ENGINE_RigidBody3D_apply_torque, rigid, torque_arguments, NULL);
}

static void take_answers(Terrain* terrain) {
    uint32_t count = 0;
    if (!terrain->body_asked) return;
    if (wadi_world_get_query(terrain->world, terrain->body_ticket, NULL, 0, &count, NULL) != WADI_OK) return;
    terrain->body_asked = false;
    wadi_query_result* all = malloc(count * sizeof *all);
    if (!all) return;
    if (wadi_world_get_query(terrain->world, terrain->body_ticket, all, count, &count, NULL) == WADI_OK) {
        for (Float* body = terrain->floats; body; body = body->next) {
            if (body->asked_first + body->asked_count > count) continue;
            memcpy(body->answers, all + body->asked_first, body->asked_count * sizeof *all);
            body->answer_count = body->asked_count;
        }
    }
    free(all);
}

static void ask(Terrain* terrain, const Transform3D* pose) {
    uint32_t bodies = 0, count = 0;
    for (Float* body = terrain->floats; body; body = body->next) ++bodies;
    float* points = malloc((size_t)bodies * 2 * MOST_POINTS * sizeof *points);
    if (!points) return;
    for (Float* body = terrain->floats; body; body = body->next) {
        wadi_body state;
        uint32_t own = MOST_POINTS;
        body->asked_count = 0;
        if (!state_of(terrain, pose, body, &state)) continue;
        if (wadi_buoyancy_points(&state, points + 2 * count, &own) != WADI_OK) {
            tell(body, wadi_get_last_error());
            continue;
        }
        bool finite = true;
        for (uint32_t n = 0; n < 2 * own; ++n) finite = finite && isfinite(points[2 * count + n]);
        if (!finite) {
            tell(body, "the body's place is not finite");
            continue;
        }
        body->asked_first = count;
        body->asked_count = own;
        count += own;
    }
    if (count > 0) terrain->body_asked = wadi_world_query(terrain->world, points, count, &terrain->body_ticket) == WADI_OK;
    free(points);
}

void floats_tick(Terrain* terrain) {
    if (!terrain->floats) return;
    Transform3D pose;
    if (!pose_of_terrain(terrain, &pose)) {
        tell(terrain->floats, "the terrain's node is scaled or sheared; bodies float only on one that is not");
        return;
    }
    take_answers(terrain);
    for (Float* body = terrain->floats; body; body = body->next) apply(body, terrain, &pose);
    if (!terrain->body_asked) ask(terrain, &pose);
}

void floats_forget(Terrain* terrain) {
    terrain->body_asked = false;
    for (Float* body = terrain->floats; body; body = body->next) body->asked_count = body->answer_count = 0;
}

void floats_leave(Terrain* terrain) {
    while (terrain->floats) leave(terrain->floats);
}
