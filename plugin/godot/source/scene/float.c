#include "float.h"

#include "engine/collections.h"
#include "engine/engine.h"

static void update_warnings(void* self) {
    const Float* body = self;
    call_plain(ENGINE_Node_update_configuration_warnings, body->object);
}

static void terrain_changed(void* self) {
    Float* body = self;
    float_leave(body);
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

static void destroy(void* self) { float_leave(self); }

static Terrain* find_terrain(const Float* body) {
    Object node = NULL;
    const GDExtensionConstTypePtr arguments[] = {&body->terrain};
    engine_call(ENGINE_Node_get_node_or_null, body->object, arguments, &node);
    return instance_of(&terrain_class, node);
}

static void join(Float* body) {
    Terrain* terrain = find_terrain(body);
    if (!terrain)
        float_tell(body, "terrain: leads to no WadiTerrain3D");
    else if (!float_body(body))
        float_tell(body, "the parent is no RigidBody3D");
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
        float_leave(body);
}

static void warnings(void* self, PackedStringArray* list) {
    const Float* body = self;
    if (!float_body(body)) strings_add(list, "A WadiFloat3D must be a child of a RigidBody3D.");
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
