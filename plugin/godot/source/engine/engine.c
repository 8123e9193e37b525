#include "engine.h"

typedef struct Entry {
    const char* owner; /* class or type */
    const char* method;
    int64_t hash;
} Entry;
static const Entry engine_entries[] = {ENGINE_METHODS};
static const Entry builtin_entries[] = {BUILTIN_METHODS};
static const GDExtensionVariantType builtin_types[] = {BUILTIN_TYPES};

void engine_call(EngineMethod method, Object object, const GDExtensionConstTypePtr* arguments, void* result) {
    static GDExtensionMethodBindPtr binds[ENGINE_METHOD_COUNT];
    if (!binds[method]) {
        const Entry* entry = &engine_entries[method];
        StringName owner = name_of(entry->owner), name = name_of(entry->method);
        binds[method] = api.classdb_get_method_bind(&owner, &name, entry->hash);
        name_free(&owner);
        name_free(&name);
        if (!binds[method]) {
            log_error("this engine has no %s.%s as the extension was built for", entry->owner, entry->method);
            return;
        }
    }
    api.object_method_bind_ptrcall(binds[method], object, arguments, result);
}

void builtin_call(BuiltinMethod method, void* value, const GDExtensionConstTypePtr* arguments, void* result, int32_t count) {
    static GDExtensionPtrBuiltInMethod methods[BUILTIN_METHOD_COUNT];
    if (!methods[method]) {
        const Entry* entry = &builtin_entries[method];
        StringName name = name_of(entry->method);
        methods[method] = api.variant_get_ptr_builtin_method(builtin_types[method], &name, entry->hash);
        name_free(&name);
        if (!methods[method]) {
            log_error("this engine has no %s.%s as the extension was built for", entry->owner, entry->method);
            return;
        }
    }
    methods[method](value, arguments, result, count);
}

Object singleton(const char* name) {
    StringName string_name = name_of(name);
    const Object object = api.global_get_singleton(&string_name);
    name_free(&string_name);
    return object;
}

Object construct(const char* class_name) {
    StringName name = name_of(class_name);
    const Object object = api.classdb_construct_object2(&name);
    name_free(&name);
    const int64_t postinitialize = 0;
    const uint8_t reversed = 0;
    const GDExtensionConstTypePtr arguments[] = {&postinitialize, &reversed};
    if (object) engine_call(ENGINE_Object_notification, object, arguments, NULL);
    return object;
}

Object cast_to(Object object, const char* class_name) {
    if (!object) return NULL;
    StringName name = name_of(class_name);
    void* tag = api.classdb_get_class_tag(&name);
    name_free(&name);
    return tag ? api.object_cast_to(object, tag) : NULL;
}

void emit(Object object, const char* signal, Variant* arguments, int count) {
    static GDExtensionMethodBindPtr bind;
    if (!bind) {
        const Entry* entry = &engine_entries[ENGINE_Object_emit_signal];
        StringName owner = name_of(entry->owner), name = name_of(entry->method);
        bind = api.classdb_get_method_bind(&owner, &name, entry->hash);
        name_free(&owner);
        name_free(&name);
    }
    StringName name = name_of(signal);
    Variant first = variant_of(GDEXTENSION_VARIANT_TYPE_STRING_NAME, &name), result;
    GDExtensionConstVariantPtr all[4] = {&first};
    for (int n = 0; n < count; ++n) all[n + 1] = &arguments[n];
    GDExtensionCallError error;
    api.object_method_bind_call(bind, object, all, count + 1, &result, &error);
    api.variant_destroy(&result);
    api.variant_destroy(&first);
    for (int n = 0; n < count; ++n) api.variant_destroy(&arguments[n]);
    name_free(&name);
}

bool has_listeners(Object object, const char* signal) {
    StringName name = name_of(signal);
    uint8_t listening = 0;
    const GDExtensionConstTypePtr arguments[] = {&name};
    engine_call(ENGINE_Object_has_connections, object, arguments, &listening);
    name_free(&name);
    return listening;
}

bool in_editor(void) {
    uint8_t editor = 0;
    engine_call(ENGINE_Engine_is_editor_hint, singleton("Engine"), NULL, &editor);
    return editor;
}

void call_plain(EngineMethod method, Object object) { engine_call(method, object, NULL, NULL); }

void call_bool(EngineMethod method, Object object, bool value) {
    const uint8_t argument = value;
    const GDExtensionConstTypePtr arguments[] = {&argument};
    engine_call(method, object, arguments, NULL);
}
