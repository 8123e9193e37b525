#include "pose.h"

#include "engine/engine.h"

#include <math.h>

double world_x(const Terrain* terrain, double x) { return x + terrain->info.nx * terrain->info.dx / 2; }
double world_y(const Terrain* terrain, double z) { return terrain->info.ny * terrain->info.dx / 2 - z; }

/* Column c of a basis. */
static Vector3 column(const Vector3 rows[3], int c) {
    const float* values = &rows[0].x;
    return (Vector3){values[c], values[3 + c], values[6 + c]};
}

static float dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

bool pose_of_terrain(const Terrain* terrain, Transform3D* pose) {
    engine_call(ENGINE_Node3D_get_global_transform, terrain->object, NULL, pose);
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b <= a; ++b) {
            if (fabsf(dot(column(pose->rows, a), column(pose->rows, b)) - (a == b ? 1.0f : 0.0f)) > 1e-3f) return false;
        }
    }
    return true;
}

/* In the terrain's own axes: the transpose turns back. */
static Vector3 local(const Transform3D* terrain, Vector3 v) {
    return (Vector3){dot(column(terrain->rows, 0), v), dot(column(terrain->rows, 1), v), dot(column(terrain->rows, 2), v)};
}

void pose_to_world(const Transform3D* terrain, Vector3 scene, float world[3]) {
    const Vector3 v = local(terrain, scene);
    world[0] = v.x;
    world[1] = -v.z;
    world[2] = v.y;
}

Vector3 pose_to_scene(const Transform3D* terrain, const float world[3]) {
    const Vector3 v = {world[0], world[2], -world[1]};
    return (Vector3){dot(terrain->rows[0], v), dot(terrain->rows[1], v), dot(terrain->rows[2], v)};
}

void pose_point(const Terrain* terrain, const Transform3D* pose, Vector3 scene, float world[3]) {
    const Vector3 from = {scene.x - pose->origin.x, scene.y - pose->origin.y, scene.z - pose->origin.z};
    const Vector3 point = local(pose, from);
    world[0] = (float)world_x(terrain, point.x);
    world[1] = (float)world_y(terrain, point.z);
    world[2] = point.y;
}

/* The quaternion of a rotation by its columns, from its largest part. */
static void quaternion(const Vector3 c[3], float q[4]) {
    const float m[3][3] = {{c[0].x, c[1].x, c[2].x}, {c[0].y, c[1].y, c[2].y}, {c[0].z, c[1].z, c[2].z}};
    const float trace = m[0][0] + m[1][1] + m[2][2];
    if (trace > 0) {
        const float s = sqrtf(trace + 1) * 2;
        q[3] = s / 4;
        q[0] = (m[2][1] - m[1][2]) / s;
        q[1] = (m[0][2] - m[2][0]) / s;
        q[2] = (m[1][0] - m[0][1]) / s;
        return;
    }
    int i = 0;
    if (m[1][1] > m[0][0]) i = 1;
    if (m[2][2] > m[i][i]) i = 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const float s = sqrtf(m[i][i] - m[j][j] - m[k][k] + 1) * 2;
    q[i] = s / 4;
    q[j] = (m[j][i] + m[i][j]) / s;
    q[k] = (m[k][i] + m[i][k]) / s;
    q[3] = (m[k][j] - m[j][k]) / s;
}

void pose_orientation(const Transform3D* terrain, const Vector3 rows[3], float orientation[4]) {
    Vector3 columns[3];
    for (int c = 0; c < 3; ++c) {
        const Vector3 own = local(terrain, column(rows, c));
        const float length = sqrtf(dot(own, own));
        columns[c] = (Vector3){own.x / length, own.y / length, own.z / length};
    }
    float q[4];
    quaternion(columns, q);
    const float norm = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    orientation[0] = q[0] / norm; /* the axes change by a rotation, which turns the vector part */
    orientation[1] = -q[2] / norm;
    orientation[2] = q[1] / norm;
    orientation[3] = q[3] / norm;
}
