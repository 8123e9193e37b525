/* The engine's methods that the scene's sources call in these tests; generate.py writes the file of the real engine. */
typedef enum EngineMethod {
    ENGINE_Node_get_parent,
    ENGINE_Node_get_physics_process_delta_time,
    ENGINE_Node3D_get_global_transform,
    ENGINE_OS_delay_usec,
    ENGINE_RigidBody3D_apply_force,
    ENGINE_RigidBody3D_apply_torque,
    ENGINE_RigidBody3D_get_angular_velocity,
    ENGINE_RigidBody3D_get_linear_velocity
} EngineMethod;
typedef enum BuiltinMethod { BUILTIN_none } BuiltinMethod;
