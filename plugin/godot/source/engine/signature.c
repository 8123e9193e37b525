#include "signature.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char* text;
    GDExtensionVariantType type;
} type_names[] = {
    {"void", GDEXTENSION_VARIANT_TYPE_NIL},
    {"bool", GDEXTENSION_VARIANT_TYPE_BOOL},
    {"int", GDEXTENSION_VARIANT_TYPE_INT},
    {"float", GDEXTENSION_VARIANT_TYPE_FLOAT},
    {"String", GDEXTENSION_VARIANT_TYPE_STRING},
    {"NodePath", GDEXTENSION_VARIANT_TYPE_NODE_PATH},
    {"Vector2", GDEXTENSION_VARIANT_TYPE_VECTOR2},
    {"Vector2i", GDEXTENSION_VARIANT_TYPE_VECTOR2I},
    {"Vector3", GDEXTENSION_VARIANT_TYPE_VECTOR3},
    {"Rect2i", GDEXTENSION_VARIANT_TYPE_RECT2I},
    {"Dictionary", GDEXTENSION_VARIANT_TYPE_DICTIONARY},
    {"PackedByteArray", GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY},
    {"PackedFloat32Array", GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY},
    {"PackedStringArray", GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY},
    {"PackedVector2Array", GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY},
};

enum { USAGE_DEFAULT = 6, USAGE_CLASS_IS_ENUM = 1 << 16, HINT_ARRAY_TYPE = 31 };

static void refuse(const char* text, const char* at) {
    fprintf(stderr, "Wadi: signature \"%s\" is wrong at \"%s\"\n", text, at);
    abort();
}

static const char* word(const char* at, char* to, size_t room) {
    while (*at == ' ') ++at;
    size_t length = 0;
    while ((isalnum((unsigned char)*at) || *at == '_' || *at == '.') && length + 1 < room) to[length++] = *at++;
    to[length] = 0;
    return at;
}

static bool is_enum_of(const char* name, const Class* owner) {
    for (const Constant* constant = owner->constants; constant && constant->name; ++constant) {
        if (strcmp(constant->of, name) == 0) return true;
    }
    return false;
}

static void set_type(Declared* declared, const char* text, const Class* owner) {
    declared->info.usage = USAGE_DEFAULT;
    for (size_t n = 0; n < sizeof type_names / sizeof *type_names; ++n) {
        if (strcmp(text, type_names[n].text) != 0) continue;
        declared->type = type_names[n].type;
        return;
    }
    if (strcmp(text, "Error") == 0 || is_enum_of(text, owner)) {
        declared->type = GDEXTENSION_VARIANT_TYPE_INT;
        declared->info.usage |= USAGE_CLASS_IS_ENUM;
        if (strcmp(text, "Error") == 0)
            strcpy(declared->class_text, text);
        else
            snprintf(declared->class_text, sizeof declared->class_text, "%s.%.24s", owner->name, text);
        return;
    }
    declared->type = GDEXTENSION_VARIANT_TYPE_OBJECT;
    snprintf(declared->class_text, sizeof declared->class_text, "%s", text);
}

/* TYPE[] NAME = NUMBER */
static const char* declare(Declared* declared, const char* at, const char* text, const Class* owner) {
    char type[40];
    at = word(at, type, sizeof type);
    if (!*type) refuse(text, at);
    set_type(declared, type, owner);
    if (strncmp(at, "[]", 2) == 0) {
        at += 2;
        snprintf(declared->element_text, sizeof declared->element_text, "%.30s", type);
        declared->type = GDEXTENSION_VARIANT_TYPE_ARRAY;
        declared->info.hint = HINT_ARRAY_TYPE;
    }
    at = word(at, declared->name_text, sizeof declared->name_text);
    if (!*declared->name_text) refuse(text, at);
    if (strncmp(at, " = ", 3) == 0) {
        char* end;
        declared->has_default = true;
        declared->default_value = strtod(at + 3, &end);
        at = end;
    }
    return at;
}

static void fill(Declared* declared) {
    declared->name = name_of(declared->name_text);
    declared->class_name = name_of(declared->class_text);
    declared->hint_text = string_of(declared->element_text);
    declared->info.type = declared->type;
    declared->info.name = &declared->name;
    declared->info.class_name = &declared->class_name;
    declared->info.hint_string = &declared->hint_text;
}

void signature_parse(Signature* signature, const char* text, const Class* owner) {
    memset(signature, 0, sizeof *signature);
    const char* at = declare(&signature->result, text, text, owner);
    if (*at == '(') {
        ++at;
        while (*at != ')') {
            if (signature->count == MOST_ARGUMENTS) refuse(text, at);
            at = declare(&signature->arguments[signature->count++], at, text, owner);
            if (*at == ',')
                ++at;
            else if (*at != ')')
                refuse(text, at);
        }
    } else if (*at) {
        refuse(text, at);
    }
    fill(&signature->result);
    for (int n = 0; n < signature->count; ++n) fill(&signature->arguments[n]);
}

static void empty(Declared* declared) {
    name_free(&declared->name);
    name_free(&declared->class_name);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &declared->hint_text);
}

void signature_free(Signature* signature) {
    empty(&signature->result);
    for (int n = 0; n < signature->count; ++n) empty(&signature->arguments[n]);
}
