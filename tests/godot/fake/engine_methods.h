/* The engine's methods that the scene's sources call in this test; generate.py writes the file of the real engine. */
typedef enum EngineMethod { ENGINE_Node_get_physics_process_delta_time, ENGINE_OS_delay_usec } EngineMethod;
typedef enum BuiltinMethod { BUILTIN_none } BuiltinMethod;
