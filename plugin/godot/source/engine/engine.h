/* Calls of the engine's own classes and types. The names ENGINE_(class)_(method) and BUILTIN_(type)_(method) that the sources use
 * are found by generate.py, which takes their hashes from the engine's extension_api.json. */
#ifndef WADI_GODOT_ENGINE_H
#define WADI_GODOT_ENGINE_H

#include "engine_methods.h"
#include "values.h"

/** Calls a method with pointers to its arguments: whole numbers and enums as int64_t, bool as uint8_t, floats as double, objects
 * as pointers to Object. `object` NULL: a static method. A result that owns memory must be a value of its type beforehand. */
void engine_call(EngineMethod method, Object object, const GDExtensionConstTypePtr* arguments, void* result);
void builtin_call(BuiltinMethod method, void* value, const GDExtensionConstTypePtr* arguments, void* result, int32_t count);

/** NULL where the engine has none of that name. */
Object singleton(const char* name);
/** Makes an object of the engine; a RefCounted one waits for its first reference. */
Object construct(const char* class_name);
/** `object` where it is of that class, else NULL. */
Object cast_to(Object object, const char* class_name);

/** Emits a signal with arguments that it frees. */
void emit(Object object, const char* signal, Variant* arguments, int count);
bool has_listeners(Object object, const char* signal);
/** true in the editor, where scenes are edited and not played. */
bool in_editor(void);
/** A call without arguments that returns nothing; with one bool. */
void call_plain(EngineMethod method, Object object);
void call_bool(EngineMethod method, Object object, bool value);

#endif
