#include "stand_in.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static long alive;
static void* take(size_t bytes) {
    void* data = calloc(1, bytes > 0 ? bytes : 1);
    if (!data) abort();
    ++alive;
    return data;
}
static void give(void* data) {
    if (!data) return;
    --alive;
    free(data);
}
long values_alive(void) { return alive; }

static void end(const char* why, const char* what) {
    fprintf(stderr, "stand-in: %s %s\n", why, what);
    exit(1);
}

/* ---- Texts: a String is a pointer to its own copy, a StringName one to the only copy ---- */

static const char* intern(const char* text) {
    static char* names[2048];
    static int count;
    for (int n = 0; n < count; ++n)
        if (strcmp(names[n], text) == 0) return names[n];
    if (count == 2048) end("too many names at", text);
    names[count] = malloc(strlen(text) + 1);
    strcpy(names[count], text);
    return names[count++];
}

static const char* text_of(const void* string) { return ((const String*)string)->opaque ? ((const String*)string)->opaque : ""; }

static void string_new_with_utf8_chars(GDExtensionUninitializedStringPtr to, const char* text) {
    String* string = to;
    string->opaque = *text ? strcpy(take(strlen(text) + 1), text) : NULL;
}
static GDExtensionInt string_to_utf8_chars(GDExtensionConstStringPtr string, char* to, GDExtensionInt room) {
    const size_t length = strlen(text_of(string));
    if (to) memcpy(to, text_of(string), (size_t)room < length ? (size_t)room : length);
    return (GDExtensionInt)length;
}
static void string_name_new_with_utf8_chars(GDExtensionUninitializedStringNamePtr to, const char* text) {
    ((StringName*)to)->opaque = (void*)(uintptr_t)intern(text);
}

/* ---- Packed arrays own a block; Array and Dictionary share one ---- */

typedef struct Block {
    size_t size; /* bytes */
    char data[];
} Block;
typedef struct List {
    int owners;
    size_t count;
    Variant* keys; /* of a Dictionary */
    Variant* values;
} List;

static size_t element_size(GDExtensionVariantType type) {
    switch (type) {
    case GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY:
        return 1;
    case GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY:
        return sizeof(float);
    case GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY:
        return sizeof(Vector2);
    case GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY:
        return sizeof(String);
    default:
        return 0;
    }
}
static Block* block_of(const void* array) { return ((const PackedByteArray*)array)->opaque[1]; }
static void* element(const void* array, size_t offset) { return block_of(array) ? block_of(array)->data + offset : NULL; }
static void set_bytes(void* array, const void* data, size_t size) {
    Block* block = size > 0 ? take(sizeof(Block) + size) : NULL;
    Block* old = block_of(array);
    if (block) {
        block->size = size;
        const size_t kept = data ? size : old && old->size < size ? old->size : old ? size : 0;
        if (kept > 0) memcpy(block->data, data ? data : old->data, kept);
    }
    ((PackedByteArray*)array)->opaque[1] = block;
    give(old);
}

static List* list_of(void* value) {
    void** place = value;
    if (!*place) {
        List* list = take(sizeof *list);
        list->owners = 1;
        *place = list;
    }
    return *place;
}
static void list_resize(List* list, size_t count) {
    Variant* values = take(count * sizeof *values);
    for (size_t n = 0; n < count && n < list->count; ++n) values[n] = list->values[n];
    for (size_t n = count; n < list->count; ++n) free_value(&list->values[n]);
    give(list->values);
    list->values = values;
    list->count = count;
}
static void list_drop(List* list) {
    if (!list || --list->owners > 0) return;
    for (size_t n = 0; n < list->count; ++n) {
        free_value(&list->values[n]);
        if (list->keys) free_value(&list->keys[n]);
    }
    give(list->values);
    give(list->keys);
    give(list);
}

/* ---- Objects ---- */

typedef struct ExtensionClass {
    const char *name, *parent;
    GDExtensionClassCreationInfo4 info;
} ExtensionClass;

struct Thing {
    const char* class_name; /* of the engine */
    const ExtensionClass* extension;
    void *instance, *binding;
    int references; /* of RefCounted ones */
    uint64_t id;
    PackedByteArray image; /* the pixels of an image or a texture */
};
static Thing* things[4096];
static uint64_t newest_thing;

static ExtensionClass classes[16];
static int class_count;
static const ExtensionClass* class_named(const char* name) {
    for (int n = 0; n < class_count; ++n)
        if (classes[n].name == name) return &classes[n];
    return NULL;
}

static GDExtensionObjectPtr classdb_construct_object2(GDExtensionConstStringNamePtr name) {
    Thing* thing = take(sizeof *thing);
    thing->class_name = ((const StringName*)name)->opaque;
    if (++newest_thing == sizeof things / sizeof *things) end("too many objects at a", thing->class_name);
    thing->id = newest_thing;
    return things[thing->id] = thing;
}
Thing* stand_in_make(const char* class_name) {
    const ExtensionClass* class = class_named(intern(class_name));
    return class ? class->info.create_instance_func(class->info.class_userdata, true) : NULL;
}
void stand_in_free(Thing* thing) {
    if (thing->extension) thing->extension->info.free_instance_func(thing->extension->info.class_userdata, thing->instance);
    set_bytes(&thing->image, NULL, 0);
    things[thing->id] = NULL;
    give(thing);
}
void stand_in_notify(Thing* thing, int32_t what) {
    if (thing->extension && thing->extension->info.notification_func)
        thing->extension->info.notification_func(thing->instance, what, false);
}
static void object_set_instance(GDExtensionObjectPtr object, GDExtensionConstStringNamePtr name,
                                GDExtensionClassInstancePtr instance) {
    ((Thing*)object)->extension = class_named(((const StringName*)name)->opaque);
    ((Thing*)object)->instance = instance;
}
static void* object_get_instance_binding(GDExtensionObjectPtr object, void* token,
                                         const GDExtensionInstanceBindingCallbacks* callbacks) {
    (void)token, (void)callbacks;
    return ((Thing*)object)->binding;
}
static void object_set_instance_binding(GDExtensionObjectPtr object, void* token, void* binding,
                                        const GDExtensionInstanceBindingCallbacks* callbacks) {
    (void)token, (void)callbacks;
    ((Thing*)object)->binding = binding;
}
static GDObjectInstanceID object_get_instance_id(GDExtensionConstObjectPtr object) { return ((const Thing*)object)->id; }
static GDExtensionObjectPtr object_get_instance_from_id(GDObjectInstanceID id) { return id <= newest_thing ? things[id] : NULL; }
static void* classdb_get_class_tag(GDExtensionConstStringNamePtr name) { return ((const StringName*)name)->opaque; }
static GDExtensionObjectPtr object_cast_to(GDExtensionConstObjectPtr object, void* tag) {
    const Thing* thing = object;
    const bool is = tag == (const void*)thing->class_name || (thing->extension && tag == (const void*)thing->extension->name);
    return is ? (void*)(uintptr_t)thing : NULL;
}
static GDExtensionObjectPtr ref_get_object(GDExtensionConstRefPtr ref) { return *(void* const*)ref; }
static void ref_set_object(GDExtensionRefPtr ref, GDExtensionObjectPtr object) {
    Thing **place = ref, *old = *place;
    *place = object;
    if (object) ++((Thing*)object)->references;
    if (old && --old->references == 0) stand_in_free(old);
}
static GDExtensionObjectPtr global_get_singleton(GDExtensionConstStringNamePtr name) {
    static Thing singletons[16];
    static int count;
    const char* wanted = ((const StringName*)name)->opaque;
    for (int n = 0; n < count; ++n)
        if (singletons[n].class_name == wanted) return &singletons[n];
    singletons[count].class_name = wanted;
    return &singletons[count++];
}

/* ---- Values of any type ---- */

static size_t plain_size(GDExtensionVariantType type) {
    switch (type) {
    case GDEXTENSION_VARIANT_TYPE_BOOL:
        return 1;
    case GDEXTENSION_VARIANT_TYPE_VECTOR3:
        return 12;
    case GDEXTENSION_VARIANT_TYPE_RECT2I:
        return 16;
    default:
        return 8;
    }
}

static void new_value(GDExtensionVariantType type, void* to, const void* from) {
    static const size_t words = sizeof(PackedByteArray);
    if (element_size(type) > 0) {
        memset(to, 0, words);
        if (!from || !block_of(from)) return;
        set_bytes(to, block_of(from)->data, block_of(from)->size);
        if (type == GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY)
            for (size_t n = 0; n < block_of(to)->size; n += sizeof(String))
                string_new_with_utf8_chars(element(to, n), text_of(element(from, n)));
        return;
    }
    switch (type) {
    case GDEXTENSION_VARIANT_TYPE_STRING:
    case GDEXTENSION_VARIANT_TYPE_NODE_PATH:
        string_new_with_utf8_chars(to, from ? text_of(from) : "");
        break;
    case GDEXTENSION_VARIANT_TYPE_STRING_NAME:
        string_name_new_with_utf8_chars(to, from ? text_of(from) : "");
        break;
    case GDEXTENSION_VARIANT_TYPE_ARRAY:
    case GDEXTENSION_VARIANT_TYPE_DICTIONARY:
        *(void**)to = NULL;
        if (from) ++list_of((void*)(uintptr_t)from)->owners, *(void**)to = *(void* const*)from;
        break;
    case GDEXTENSION_VARIANT_TYPE_OBJECT:
        *(void**)to = NULL;
        if (from) ref_set_object(to, *(void* const*)from);
        break;
    default:
        memcpy(to, from, plain_size(type));
    }
}
static void free_of(GDExtensionVariantType type, void* value) {
    if (type == GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY && block_of(value))
        for (size_t n = 0; n < block_of(value)->size; n += sizeof(String)) give(((String*)element(value, n))->opaque);
    if (element_size(type) > 0) set_bytes(value, NULL, 0);
    if (type == GDEXTENSION_VARIANT_TYPE_STRING || type == GDEXTENSION_VARIANT_TYPE_NODE_PATH) give(((String*)value)->opaque);
    if (type == GDEXTENSION_VARIANT_TYPE_ARRAY || type == GDEXTENSION_VARIANT_TYPE_DICTIONARY) list_drop(*(List**)value);
    if (type == GDEXTENSION_VARIANT_TYPE_OBJECT) ref_set_object(value, NULL);
}

/* A Variant: its type, and a pointer to a value. */
static GDExtensionVariantType type_of(const void* variant) {
    return (GDExtensionVariantType)((const Variant*)variant)->opaque[0];
}
static void* value_in(const void* variant) { return (void*)(uintptr_t)((const Variant*)variant)->opaque[1]; }
static Variant packed(GDExtensionVariantType type, const void* from) {
    void* value = type == GDEXTENSION_VARIANT_TYPE_NIL ? NULL : take(32);
    if (value) new_value(type, value, from);
    return (Variant){{(uint64_t)type, (uint64_t)(uintptr_t)value, 0}};
}
void free_value(Variant* value) {
    if (value_in(value)) free_of(type_of(value), value_in(value));
    give(value_in(value));
    *value = (Variant){{0}};
}

static void variant_new_nil(GDExtensionUninitializedVariantPtr to) { *(Variant*)to = (Variant){{0}}; }
static void variant_new_copy(GDExtensionUninitializedVariantPtr to, GDExtensionConstVariantPtr from) {
    *(Variant*)to = packed(type_of(from), value_in(from));
}
static void variant_destroy(GDExtensionVariantPtr variant) { free_value(variant); }
static GDExtensionVariantType variant_get_type(GDExtensionConstVariantPtr variant) { return type_of(variant); }
static GDExtensionBool variant_can_convert_strict(GDExtensionVariantType from, GDExtensionVariantType to) {
    return from == GDEXTENSION_VARIANT_TYPE_INT && to == GDEXTENSION_VARIANT_TYPE_FLOAT;
}
static void variant_construct(GDExtensionVariantType type, GDExtensionUninitializedVariantPtr to,
                              const GDExtensionConstVariantPtr* from, int32_t count, GDExtensionCallError* error) {
    (void)type, (void)count;
    const double value = (double)*(const int64_t*)value_in(from[0]);
    *(Variant*)to = packed(GDEXTENSION_VARIANT_TYPE_FLOAT, &value);
    error->error = GDEXTENSION_CALL_OK;
}

/* The interface asks for one function of a type, which is not told its type: one of each for the types in use. */
#define TYPES(X)                                                                                                                 \
    X(BOOL)                                                                                                                      \
    X(INT) X(FLOAT) X(STRING) X(VECTOR2) X(VECTOR2I) X(RECT2I) X(VECTOR3) X(STRING_NAME) X(NODE_PATH) X(OBJECT) X(DICTIONARY)    \
        X(ARRAY) X(PACKED_BYTE_ARRAY) X(PACKED_FLOAT32_ARRAY) X(PACKED_STRING_ARRAY) X(PACKED_VECTOR2_ARRAY)
#define FUNCTIONS(TYPE)                                                                                                          \
    static void pack_##TYPE(GDExtensionUninitializedVariantPtr to, GDExtensionTypePtr from) {                                    \
        *(Variant*)to = packed(GDEXTENSION_VARIANT_TYPE_##TYPE, from);                                                           \
    }                                                                                                                            \
    static void empty_##TYPE(GDExtensionUninitializedTypePtr to, const GDExtensionConstTypePtr* from) {                          \
        (void)from;                                                                                                              \
        new_value(GDEXTENSION_VARIANT_TYPE_##TYPE, to, NULL);                                                                    \
    }                                                                                                                            \
    static void copy_##TYPE(GDExtensionUninitializedTypePtr to, const GDExtensionConstTypePtr* from) {                           \
        new_value(GDEXTENSION_VARIANT_TYPE_##TYPE, to, from[0]);                                                                 \
    }                                                                                                                            \
    static void free_##TYPE(GDExtensionTypePtr value) { free_of(GDEXTENSION_VARIANT_TYPE_##TYPE, value); }
TYPES(FUNCTIONS)

static GDExtensionVariantFromTypeConstructorFunc get_variant_from_type_constructor(GDExtensionVariantType type) {
#define CASE(TYPE)                                                                                                               \
    if (type == GDEXTENSION_VARIANT_TYPE_##TYPE) return pack_##TYPE;
    TYPES(CASE)
#undef CASE
    return NULL;
}
static GDExtensionPtrConstructor variant_get_ptr_constructor(GDExtensionVariantType type, int32_t which) {
#define CASE(TYPE)                                                                                                               \
    if (type == GDEXTENSION_VARIANT_TYPE_##TYPE) return which == 0 ? empty_##TYPE : copy_##TYPE;
    TYPES(CASE)
#undef CASE
    return NULL;
}
static GDExtensionPtrDestructor variant_get_ptr_destructor(GDExtensionVariantType type) {
    if (type < GDEXTENSION_VARIANT_TYPE_STRING ||
        (type > GDEXTENSION_VARIANT_TYPE_STRING && type < GDEXTENSION_VARIANT_TYPE_STRING_NAME))
        return NULL; /* plain numbers */
#define CASE(TYPE)                                                                                                               \
    if (type == GDEXTENSION_VARIANT_TYPE_##TYPE) return free_##TYPE;
    TYPES(CASE)
#undef CASE
    return NULL;
}
static void* inside(GDExtensionVariantPtr variant) { return value_in(variant); }
static GDExtensionVariantGetInternalPtrFunc variant_get_ptr_internal_getter(GDExtensionVariantType type) {
    (void)type;
    return inside;
}

static uint8_t* packed_byte_array_operator_index(GDExtensionTypePtr array, GDExtensionInt n) { return element(array, (size_t)n); }
static const uint8_t* packed_byte_array_operator_index_const(GDExtensionConstTypePtr array, GDExtensionInt n) {
    return element(array, (size_t)n);
}
static float* packed_float32_array_operator_index(GDExtensionTypePtr array, GDExtensionInt n) {
    return element(array, 4 * (size_t)n);
}
static const float* packed_float32_array_operator_index_const(GDExtensionConstTypePtr array, GDExtensionInt n) {
    return element(array, 4 * (size_t)n);
}
static GDExtensionTypePtr packed_vector2_array_operator_index_const(GDExtensionConstTypePtr array, GDExtensionInt n) {
    return element(array, 8 * (size_t)n);
}
static GDExtensionVariantPtr array_operator_index(GDExtensionTypePtr array, GDExtensionInt n) {
    return &list_of(array)->values[n];
}
static void array_set_typed(GDExtensionTypePtr array, GDExtensionVariantType type, GDExtensionConstStringNamePtr class_name,
                            GDExtensionConstVariantPtr script) {
    (void)array, (void)type, (void)class_name, (void)script;
}
static GDExtensionVariantPtr dictionary_operator_index(GDExtensionTypePtr dictionary, GDExtensionConstVariantPtr key) {
    List* list = list_of(dictionary);
    for (size_t n = 0; n < list->count; ++n)
        if (strcmp(text_of(value_in(&list->keys[n])), text_of(value_in(key))) == 0) return &list->values[n];
    list_resize(list, list->count + 1);
    Variant* keys = take(list->count * sizeof *keys);
    if (list->keys) memcpy(keys, list->keys, (list->count - 1) * sizeof *keys);
    give(list->keys);
    list->keys = keys;
    variant_new_copy(&keys[list->count - 1], key);
    return &list->values[list->count - 1];
}

#define SIZED(NAME, TYPE)                                                                                                        \
    static void size_##NAME(GDExtensionTypePtr array, const GDExtensionConstTypePtr* arguments, GDExtensionTypePtr result,       \
                            int32_t count) {                                                                                     \
        (void)arguments, (void)count;                                                                                            \
        *(int64_t*)result = block_of(array) ? (int64_t)(block_of(array)->size / element_size(TYPE)) : 0;                         \
    }                                                                                                                            \
    static void resize_##NAME(GDExtensionTypePtr array, const GDExtensionConstTypePtr* arguments, GDExtensionTypePtr result,     \
                              int32_t count) {                                                                                   \
        (void)count;                                                                                                             \
        set_bytes(array, NULL, (size_t) * (const int64_t*)arguments[0] * element_size(TYPE));                                    \
        *(int64_t*)result = 0;                                                                                                   \
    }
SIZED(bytes, GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY)
SIZED(floats, GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY)
SIZED(points, GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY)
static void resize_array(GDExtensionTypePtr array, const GDExtensionConstTypePtr* arguments, GDExtensionTypePtr result,
                         int32_t count) {
    (void)count;
    list_resize(list_of(array), (size_t) * (const int64_t*)arguments[0]);
    *(int64_t*)result = 0;
}
static void add_string(GDExtensionTypePtr array, const GDExtensionConstTypePtr* arguments, GDExtensionTypePtr result,
                       int32_t count) {
    (void)count;
    const size_t old = block_of(array) ? block_of(array)->size : 0;
    set_bytes(array, NULL, old + sizeof(String));
    string_new_with_utf8_chars(element(array, old), text_of(arguments[0]));
    *(uint8_t*)result = 0;
}
static GDExtensionPtrBuiltInMethod variant_get_ptr_builtin_method(GDExtensionVariantType type, GDExtensionConstStringNamePtr name,
                                                                  GDExtensionInt hash) {
    static const struct {
        GDExtensionVariantType type;
        const char* name;
        GDExtensionPtrBuiltInMethod method;
    } methods[] = {
        {GDEXTENSION_VARIANT_TYPE_ARRAY, "resize", resize_array},
        {GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, "size", size_bytes},
        {GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, "resize", resize_bytes},
        {GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, "size", size_floats},
        {GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, "resize", resize_floats},
        {GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY, "size", size_points},
        {GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY, "resize", resize_points},
        {GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY, "push_back", add_string},
    };
    (void)hash;
    for (size_t n = 0; n < sizeof methods / sizeof *methods; ++n)
        if (methods[n].type == type && strcmp(methods[n].name, text_of(name)) == 0) return methods[n].method;
    return NULL;
}

/* ---- Methods of the engine's classes ---- */

typedef void (*EngineFunction)(Thing* self, const GDExtensionConstTypePtr* arguments, void* result);

static char pack_path[256], pack_from[1024];
void put_in_pack(const char* path, const char* from) {
    snprintf(pack_path, sizeof pack_path, "%s", path);
    snprintf(pack_from, sizeof pack_from, "%s", from);
}
static const char* file_of(const void* path) { return strcmp(text_of(path), pack_path) == 0 ? pack_from : text_of(path); }

static void nothing(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self, (void)arguments, (void)result;
}
static void no(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self, (void)arguments;
    *(uint8_t*)result = 0;
}
static void none(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self, (void)arguments;
    *(void**)result = NULL;
}
static void yes(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self, (void)arguments;
    *(uint8_t*)result = 1;
}
static void notification(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)result;
    stand_in_notify(self, (int32_t) * (const int64_t*)arguments[0]);
}
static void tick_seconds(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self, (void)arguments;
    *(double*)result = 1.0 / 60;
}
static void own_name(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    free_of(GDEXTENSION_VARIANT_TYPE_STRING, result);
    string_new_with_utf8_chars(result, self->class_name);
}
static void same_path(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self;
    free_of(GDEXTENSION_VARIANT_TYPE_STRING, result);
    string_new_with_utf8_chars(result, text_of(arguments[0]));
}
static void file_exists(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self;
    FILE* file = fopen(file_of(arguments[0]), "rb");
    *(uint8_t*)result = file != NULL;
    if (file) fclose(file);
}
static void file_bytes(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self;
    FILE* file = fopen(file_of(arguments[0]), "rb");
    char part[65536];
    for (size_t size = 0, got; file && (got = fread(part, 1, sizeof part, file)) > 0; size += got) {
        set_bytes(result, NULL, size + got);
        memcpy(element(result, size), part, got);
    }
    if (file) fclose(file);
}
static void image_of(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self;
    StringName name;
    string_name_new_with_utf8_chars(&name, "Image");
    Thing* image = classdb_construct_object2(&name);
    new_value(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &image->image, arguments[4]);
    ref_set_object(result, image);
}
static void texture_update(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)result;
    const Thing* image = *(Thing* const*)arguments[0];
    set_bytes(&self->image, block_of(&image->image)->data, block_of(&image->image)->size);
}
static void texture_of(Thing* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)self;
    StringName name;
    string_name_new_with_utf8_chars(&name, "ImageTexture");
    Thing* texture = classdb_construct_object2(&name);
    texture_update(texture, arguments, NULL);
    ref_set_object(result, texture);
}

static struct {
    const char *owner, *name;
    EngineFunction function;
} engine_methods[] = {
    {"Object", "notification", notification},
    {"Object", "has_connections", yes},
    {"Object", "emit_signal", nothing}, /* comes with variants, below */
    {"Resource", "emit_changed", nothing},
    {"Engine", "is_editor_hint", no},
    {"Node", "set_physics_process_internal", nothing},
    {"Node", "update_configuration_warnings", nothing},
    {"Node", "get_physics_process_delta_time", tick_seconds},
    {"OS", "delay_usec", nothing},
    {"ProjectSettings", "globalize_path", same_path},
    {"FileAccess", "file_exists", file_exists},
    {"FileAccess", "get_file_as_bytes", file_bytes},
    {"DisplayServer", "get_name", own_name},
    {"RenderingServer", "get_rendering_device", none},
    {"RenderingServer", "is_on_render_thread", yes},
    {"Image", "create_from_data", image_of},
    {"ImageTexture", "create_from_image", texture_of},
    {"ImageTexture", "update", texture_update},
};

static GDExtensionMethodBindPtr classdb_get_method_bind(GDExtensionConstStringNamePtr owner, GDExtensionConstStringNamePtr name,
                                                        GDExtensionInt hash) {
    (void)hash;
    for (size_t n = 0; n < sizeof engine_methods / sizeof *engine_methods; ++n) {
        if (strcmp(engine_methods[n].owner, text_of(owner)) != 0 || strcmp(engine_methods[n].name, text_of(name)) != 0) continue;
        return &engine_methods[n];
    }
    return NULL;
}
static void object_method_bind_ptrcall(GDExtensionMethodBindPtr bind, GDExtensionObjectPtr object,
                                       const GDExtensionConstTypePtr* arguments, GDExtensionTypePtr result) {
    engine_methods[((const char*)bind - (const char*)engine_methods) / (long)sizeof *engine_methods].function(object, arguments,
                                                                                                              result);
}

static const char* emitted[4096];
static int emissions;
int signals_of(const char* name) {
    int count = 0;
    for (int n = 0; n < emissions; ++n) count += strcmp(emitted[n], name) == 0;
    return count;
}
static void object_method_bind_call(GDExtensionMethodBindPtr bind, GDExtensionObjectPtr object,
                                    const GDExtensionConstVariantPtr* arguments, GDExtensionInt count,
                                    GDExtensionUninitializedVariantPtr result, GDExtensionCallError* error) {
    (void)bind, (void)object, (void)count; /* the only one is Object.emit_signal */
    if (emissions < 4096) emitted[emissions++] = text_of(value_in(arguments[0]));
    variant_new_nil(result);
    error->error = GDEXTENSION_CALL_OK;
}

/* ---- Classes of the extension ---- */

static struct ExtensionMethod {
    const char *owner, *name;
    GDExtensionClassMethodInfo info;
    GDExtensionVariantType first; /* argument */
} extension_methods[512];
static int extension_method_count;

static void classdb_register_extension_class4(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr name,
                                              GDExtensionConstStringNamePtr parent, const GDExtensionClassCreationInfo4* info) {
    (void)library;
    classes[class_count++] = (ExtensionClass){((const StringName*)name)->opaque, ((const StringName*)parent)->opaque, *info};
}
static void classdb_register_extension_class_method(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr owner,
                                                    const GDExtensionClassMethodInfo* info) {
    (void)library;
    extension_methods[extension_method_count++] =
        (struct ExtensionMethod){((const StringName*)owner)->opaque, ((const StringName*)info->name)->opaque, *info,
                                 info->argument_count > 0 ? info->arguments_info[0].type : 0};
}
static void classdb_register_extension_class_integer_constant(GDExtensionClassLibraryPtr library,
                                                              GDExtensionConstStringNamePtr owner,
                                                              GDExtensionConstStringNamePtr of,
                                                              GDExtensionConstStringNamePtr name, GDExtensionInt value,
                                                              GDExtensionBool is_bitfield) {
    (void)library, (void)owner, (void)of, (void)name, (void)value, (void)is_bitfield;
}
static void classdb_register_extension_class_property(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr owner,
                                                      const GDExtensionPropertyInfo* info, GDExtensionConstStringNamePtr setter,
                                                      GDExtensionConstStringNamePtr getter) {
    (void)library, (void)owner, (void)info, (void)setter, (void)getter;
}
static void classdb_register_extension_class_signal(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr owner,
                                                    GDExtensionConstStringNamePtr name, const GDExtensionPropertyInfo* arguments,
                                                    GDExtensionInt count) {
    (void)library, (void)owner, (void)name, (void)arguments, (void)count;
}
static void classdb_unregister_extension_class(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr name) {
    (void)library, (void)name;
}

static const struct ExtensionMethod* method_of(const Thing* thing, const char* name) {
    for (int n = 0; n < extension_method_count; ++n) {
        const struct ExtensionMethod* method = &extension_methods[n];
        if (method->owner == thing->extension->name && strcmp(method->name, name) == 0) return method;
    }
    end("the extension has no method", name);
    return NULL;
}
Variant stand_in_call(Thing* thing, const char* name, int count, Variant* arguments) {
    const struct ExtensionMethod* method = method_of(thing, name);
    GDExtensionConstVariantPtr pointers[8] = {0};
    for (int n = 0; n < count; ++n) pointers[n] = &arguments[n];
    Variant result = {{0}};
    GDExtensionCallError error = {0};
    method->info.call_func(method->info.method_userdata, thing->instance, pointers, count, &result, &error);
    if (error.error != GDEXTENSION_CALL_OK) end("the extension refuses the call of", name);
    for (int n = 0; n < count; ++n) free_value(&arguments[n]);
    return result;
}
void stand_in_set(Thing* thing, const char* name, Variant value) {
    const struct ExtensionMethod* method = method_of(thing, name);
    if (method->first != type_of(&value)) end("another type wants", name);
    const GDExtensionConstTypePtr arguments[] = {value_in(&value)};
    method->info.ptrcall_func(method->info.method_userdata, thing->instance, arguments, NULL);
    free_value(&value);
}

/* ---- Arguments and results ---- */

Variant a_number(double value) { return packed(GDEXTENSION_VARIANT_TYPE_FLOAT, &value); }
Variant an_integer(int64_t value) { return packed(GDEXTENSION_VARIANT_TYPE_INT, &value); }
Variant a_truth(bool value) { return packed(GDEXTENSION_VARIANT_TYPE_BOOL, &(uint8_t){value}); }
Variant a_place(float x, float y, float z) { return packed(GDEXTENSION_VARIANT_TYPE_VECTOR3, &(Vector3){x, y, z}); }
Variant a_region(int x, int y, int width, int height) {
    return packed(GDEXTENSION_VARIANT_TYPE_RECT2I, &(Rect2i){x, y, width, height});
}
Variant a_thing(Thing* thing) { return packed(GDEXTENSION_VARIANT_TYPE_OBJECT, &thing); }
Variant a_copy(const Variant* value) { return packed(type_of(value), value_in(value)); }
Variant a_text(const char* text) {
    const String string = {(void*)(uintptr_t)text};
    return packed(GDEXTENSION_VARIANT_TYPE_STRING, &string);
}
int64_t whole(Variant value) {
    if (type_of(&value) != GDEXTENSION_VARIANT_TYPE_INT) end("a result is no", "int");
    const int64_t result = *(const int64_t*)value_in(&value);
    free_value(&value);
    return result;
}
double number(Variant value) {
    if (type_of(&value) != GDEXTENSION_VARIANT_TYPE_FLOAT) end("a result is no", "float");
    const double result = *(const double*)value_in(&value);
    free_value(&value);
    return result;
}
const void* content(const Variant* value, size_t* size) {
    const GDExtensionVariantType type = type_of(value);
    const void* of = value_in(value);
    if (type == GDEXTENSION_VARIANT_TYPE_OBJECT && *(Thing* const*)of) of = &(*(Thing* const*)of)->image;
    if (type == GDEXTENSION_VARIANT_TYPE_STRING) {
        *size = strlen(text_of(of));
        return text_of(of);
    }
    *size = of && block_of(of) ? block_of(of)->size : 0;
    return *size > 0 ? block_of(of)->data : NULL;
}
size_t elements(const Variant* value) { return list_of(value_in(value))->count; }

/* ---- The interface ---- */

static int told;
int messages(void) { return told; }
static void print_error(const char* text, const char* function, const char* file, int32_t line, GDExtensionBool notify) {
    (void)function, (void)file, (void)line, (void)notify;
    ++told;
    fprintf(stderr, "%s\n", text);
}
static void print_warning(const char* text, const char* function, const char* file, int32_t line, GDExtensionBool notify) {
    print_error(text, function, file, line, notify);
}
static void get_godot_version(GDExtensionGodotVersion* version) { *version = (GDExtensionGodotVersion){.major = 4, .minor = 4}; }

GDExtensionInterfaceFunctionPtr stand_in_function(const char* name) {
#define FIND(function, type)                                                                                                     \
    const GDExtensionInterface##type at_##function = function; /* of the type that the interface has it with */                  \
    if (strcmp(name, #function) == 0) return (void (*)(void))at_##function;
    API_FUNCTIONS(FIND)
#undef FIND
    return NULL;
}
