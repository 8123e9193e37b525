/* The engine's values: opaque storage of the right size, their making, copying and freeing. */
#ifndef WADI_GODOT_VALUES_H
#define WADI_GODOT_VALUES_H

#include "api.h"

#include <stddef.h>

/* Sizes of builds with 32-bit floats on 64-bit systems, which wadi.gdextension asks for. */
typedef struct {
    void* opaque;
} String, StringName, NodePath, Array, Dictionary;
typedef struct {
    void* opaque[2];
} PackedByteArray, PackedFloat32Array, PackedStringArray, PackedVector2Array;
typedef struct {
    uint64_t opaque[3];
} Variant;
typedef struct {
    float x, y;
} Vector2;
typedef struct {
    int32_t x, y;
} Vector2i;
typedef struct {
    int32_t x, y, width, height;
} Rect2i;
typedef struct {
    float x, y, z;
} Vector3;
typedef struct {
    Vector3 rows[3], origin;
} Transform3D;        /* v -> rows * v + origin */
typedef void* Object; /* the engine's pointer; in a Ref it holds a reference */

/** Bytes of a value of that type. */
size_t value_size(GDExtensionVariantType type);
/** Makes a value at `to`: without arguments, or a copy. */
void value_new(GDExtensionVariantType type, void* to);
void value_copy(GDExtensionVariantType type, void* to, const void* from);
void value_free(GDExtensionVariantType type, void* value);
/** Frees what is at `to` and puts a copy of `from` there. Objects are references. */
void value_assign(GDExtensionVariantType type, void* to, const void* from);
/** The same, but `from` itself goes there and is not a value any more. */
void value_move(GDExtensionVariantType type, void* to, const void* from);

/** A variant that holds a copy of the value. */
Variant variant_of(GDExtensionVariantType type, const void* value);
Variant variant_of_float(double value);
Variant variant_of_int(int64_t value);

String string_of(const char* utf8);
/** Copies a string's UTF-8 text; free() it. NULL where memory ends. */
char* string_text(const String* string);
bool string_is_empty(const String* string);
StringName name_of(const char* utf8);
void name_free(StringName* name);

#endif
