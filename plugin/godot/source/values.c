#include "values.h"

#include "engine.h"

#include <stdlib.h>
#include <string.h>

static const size_t sizes[GDEXTENSION_VARIANT_TYPE_VARIANT_MAX] = {
    [GDEXTENSION_VARIANT_TYPE_BOOL] = 1,
    [GDEXTENSION_VARIANT_TYPE_INT] = 8,
    [GDEXTENSION_VARIANT_TYPE_FLOAT] = 8,
    [GDEXTENSION_VARIANT_TYPE_STRING] = sizeof(String),
    [GDEXTENSION_VARIANT_TYPE_VECTOR2] = sizeof(Vector2),
    [GDEXTENSION_VARIANT_TYPE_VECTOR2I] = sizeof(Vector2i),
    [GDEXTENSION_VARIANT_TYPE_RECT2I] = sizeof(Rect2i),
    [GDEXTENSION_VARIANT_TYPE_VECTOR3] = sizeof(Vector3),
    [GDEXTENSION_VARIANT_TYPE_STRING_NAME] = sizeof(StringName),
    [GDEXTENSION_VARIANT_TYPE_NODE_PATH] = sizeof(NodePath),
    [GDEXTENSION_VARIANT_TYPE_OBJECT] = sizeof(Object),
    [GDEXTENSION_VARIANT_TYPE_DICTIONARY] = sizeof(Dictionary),
    [GDEXTENSION_VARIANT_TYPE_ARRAY] = sizeof(Array),
    [GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY] = sizeof(PackedByteArray),
    [GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY] = sizeof(PackedFloat32Array),
    [GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY] = sizeof(PackedStringArray),
    [GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY] = sizeof(PackedVector2Array),
};

size_t value_size(GDExtensionVariantType type) { return sizes[type]; }

/* Types without memory of their own have no destructor. */
static GDExtensionPtrDestructor destructor_of(GDExtensionVariantType type) {
    return type == GDEXTENSION_VARIANT_TYPE_OBJECT ? NULL : api.variant_get_ptr_destructor(type);
}

void value_new(GDExtensionVariantType type, void* to) {
    memset(to, 0, value_size(type));
    if (destructor_of(type)) api.variant_get_ptr_constructor(type, 0)(to, NULL);
}

void value_copy(GDExtensionVariantType type, void* to, const void* from) {
    if (!destructor_of(type)) {
        memcpy(to, from, value_size(type));
        return;
    }
    const GDExtensionConstTypePtr arguments[] = {from};
    api.variant_get_ptr_constructor(type, 1)(to, arguments); /* constructor 1 of every such type copies */
}

void value_free(GDExtensionVariantType type, void* value) {
    if (type == GDEXTENSION_VARIANT_TYPE_OBJECT) {
        if (*(Object*)value) api.ref_set_object(value, NULL);
        return;
    }
    const GDExtensionPtrDestructor destructor = destructor_of(type);
    if (destructor) destructor(value);
}

void value_assign(GDExtensionVariantType type, void* to, const void* from) {
    if (type == GDEXTENSION_VARIANT_TYPE_OBJECT) {
        if (*(Object*)to != *(const Object*)from) api.ref_set_object(to, *(const Object*)from);
        return;
    }
    uint64_t copy[8];
    value_copy(type, copy, from);
    value_move(type, to, copy);
}

void value_move(GDExtensionVariantType type, void* to, const void* from) {
    value_free(type, to);
    memcpy(to, from, value_size(type));
}

Variant variant_of(GDExtensionVariantType type, const void* value) {
    Variant variant;
    uint64_t copy[8]; /* the engine's pointer is to what could change */
    memcpy(copy, value, value_size(type));
    api.get_variant_from_type_constructor(type)(&variant, copy);
    return variant;
}

Variant variant_of_float(double value) { return variant_of(GDEXTENSION_VARIANT_TYPE_FLOAT, &value); }
Variant variant_of_int(int64_t value) { return variant_of(GDEXTENSION_VARIANT_TYPE_INT, &value); }

String string_of(const char* utf8) {
    String string;
    api.string_new_with_utf8_chars(&string, utf8);
    return string;
}

char* string_text(const String* string) {
    const GDExtensionInt length = api.string_to_utf8_chars(string, NULL, 0);
    char* text = malloc((size_t)length + 1);
    if (!text) return NULL;
    api.string_to_utf8_chars(string, text, length);
    text[length] = 0;
    return text;
}

bool string_is_empty(const String* string) { return api.string_to_utf8_chars(string, NULL, 0) == 0; }

StringName name_of(const char* utf8) {
    StringName name;
    api.string_name_new_with_utf8_chars(&name, utf8);
    return name;
}

void name_free(StringName* name) { value_free(GDEXTENSION_VARIANT_TYPE_STRING_NAME, name); }

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
