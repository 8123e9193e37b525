#include "collections.h"

#include "engine.h"

#include <string.h>

/* Methods of all packed arrays and of Array: size() and resize(). */
static size_t size_of(BuiltinMethod method, const void* array) {
    int64_t size = 0;
    builtin_call(method, (void*)(uintptr_t)array, NULL, &size, 0);
    return (size_t)size;
}

static bool resize(BuiltinMethod method, void* array, size_t size) {
    const int64_t wanted = (int64_t)size;
    int64_t error = 0;
    const GDExtensionConstTypePtr arguments[] = {&wanted};
    builtin_call(method, array, arguments, &error, 1);
    return error == 0;
}

uint8_t* bytes_new(PackedByteArray* bytes, size_t size) {
    value_new(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, bytes);
    if (size == 0 || !resize(BUILTIN_PackedByteArray_resize, bytes, size)) return NULL;
    return api.packed_byte_array_operator_index(bytes, 0);
}

PackedByteArray bytes_of(const void* data, size_t size) {
    PackedByteArray bytes;
    uint8_t* room = bytes_new(&bytes, size);
    if (room) memcpy(room, data, size);
    return bytes;
}

size_t bytes_size(const PackedByteArray* bytes) { return size_of(BUILTIN_PackedByteArray_size, bytes); }

const void* bytes_data(const PackedByteArray* bytes) {
    return bytes_size(bytes) > 0 ? api.packed_byte_array_operator_index_const(bytes, 0) : NULL;
}

float* floats_new(PackedFloat32Array* floats, size_t count) {
    value_new(GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, floats);
    if (count == 0 || !resize(BUILTIN_PackedFloat32Array_resize, floats, count)) return NULL;
    return api.packed_float32_array_operator_index(floats, 0);
}

size_t floats_size(const PackedFloat32Array* floats) { return size_of(BUILTIN_PackedFloat32Array_size, floats); }
size_t points_size(const PackedVector2Array* points) { return size_of(BUILTIN_PackedVector2Array_size, points); }

void strings_add(PackedStringArray* strings, const char* text) {
    String string = string_of(text);
    const GDExtensionConstTypePtr arguments[] = {&string};
    uint8_t failed = 0;
    builtin_call(BUILTIN_PackedStringArray_push_back, strings, arguments, &failed, 1);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &string);
}

Array array_new(GDExtensionVariantType type, size_t size) {
    Array array;
    value_new(GDEXTENSION_VARIANT_TYPE_ARRAY, &array);
    StringName class_name = name_of("");
    Variant script;
    api.variant_new_nil(&script);
    api.array_set_typed(&array, type, &class_name, &script);
    name_free(&class_name);
    resize(BUILTIN_Array_resize, &array, size);
    return array;
}

static void replace(Variant* place, GDExtensionVariantType type, const void* value) {
    if (!place) return;
    const Variant variant = variant_of(type, value);
    api.variant_destroy(place);
    *place = variant;
}

void array_set(Array* array, size_t n, GDExtensionVariantType type, const void* value) {
    replace(api.array_operator_index(array, (GDExtensionInt)n), type, value);
}

Dictionary dictionary_new(void) {
    Dictionary dictionary;
    value_new(GDEXTENSION_VARIANT_TYPE_DICTIONARY, &dictionary);
    return dictionary;
}

void dictionary_set(Dictionary* dictionary, const char* key, GDExtensionVariantType type, const void* value) {
    String text = string_of(key);
    Variant name = variant_of(GDEXTENSION_VARIANT_TYPE_STRING, &text);
    replace(api.dictionary_operator_index(dictionary, &name), type, value);
    api.variant_destroy(&name);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &text);
}

void dictionary_set_float(Dictionary* dictionary, const char* key, double value) {
    dictionary_set(dictionary, key, GDEXTENSION_VARIANT_TYPE_FLOAT, &value);
}

void dictionary_set_int(Dictionary* dictionary, const char* key, int64_t value) {
    dictionary_set(dictionary, key, GDEXTENSION_VARIANT_TYPE_INT, &value);
}

void dictionary_set_text(Dictionary* dictionary, const char* key, const char* value) {
    String text = string_of(value);
    dictionary_set(dictionary, key, GDEXTENSION_VARIANT_TYPE_STRING, &text);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &text);
}
