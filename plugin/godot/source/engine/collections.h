/* Packed arrays, Array and Dictionary. */
#ifndef WADI_GODOT_COLLECTIONS_H
#define WADI_GODOT_COLLECTIONS_H

#include "values.h"

PackedByteArray bytes_of(const void* data, size_t size);
size_t bytes_size(const PackedByteArray* bytes);
/** NULL where there are none. */
const void* bytes_data(const PackedByteArray* bytes);
/** Makes room for `size` bytes whose address is returned; NULL where the engine refuses. */
uint8_t* bytes_new(PackedByteArray* bytes, size_t size);
float* floats_new(PackedFloat32Array* floats, size_t count);
size_t floats_size(const PackedFloat32Array* floats);
size_t points_size(const PackedVector2Array* points);

void strings_add(PackedStringArray* strings, const char* text);

/** An array whose elements have one type (class_name "" but for objects). */
Array array_new(GDExtensionVariantType type, size_t size);
/** Puts a value at n; the array takes a copy. */
void array_set(Array* array, size_t n, GDExtensionVariantType type, const void* value);
Dictionary dictionary_new(void);
void dictionary_set(Dictionary* dictionary, const char* key, GDExtensionVariantType type, const void* value);
void dictionary_set_float(Dictionary* dictionary, const char* key, double value);
void dictionary_set_int(Dictionary* dictionary, const char* key, int64_t value);
void dictionary_set_text(Dictionary* dictionary, const char* key, const char* value);

#endif
