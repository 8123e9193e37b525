/* Places and vectors between the scene's axes, a terrain's own and Wadi's. */
#ifndef WADI_GODOT_POSE_H
#define WADI_GODOT_POSE_H

#include "terrain.h"

/* A point of the node's space in metres from the grid's south-west corner. */
double world_x(const Terrain* terrain, double x);
double world_y(const Terrain* terrain, double z);

/** A terrain's node in the scene. Scaled nodes are not supported: false. */
bool pose_of_terrain(const Terrain* terrain, Transform3D* pose);

/** Directions and velocities. */
void pose_to_world(const Transform3D* terrain, Vector3 scene, float world[3]);
Vector3 pose_to_scene(const Transform3D* terrain, const float world[3]);
/** A point of the scene in metres from the grid's south-west corner, and up. */
void pose_point(const Terrain* terrain, const Transform3D* pose, Vector3 scene, float world[3]);
/** A basis of the scene as a unit quaternion x, y, z, w of the world; its scale is left out. */
void pose_orientation(const Transform3D* terrain, const Vector3 rows[3], float orientation[4]);

#endif
