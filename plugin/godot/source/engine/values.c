#include "values.h"

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
