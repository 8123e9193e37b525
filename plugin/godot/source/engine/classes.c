#include "classes.h"

#include "calls.h"
#include "engine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static Bound* all_bound; /* freed when the last class goes */
static int registered;

static const GDExtensionInstanceBindingCallbacks no_callbacks = {0};

/* Calls `act` with the type and place of each field that is a property. */
static void for_fields(const Class* class, char* self, void (*act)(GDExtensionVariantType type, void* field)) {
    for (const Property* property = class->properties; property && property->declaration; ++property) {
        Signature signature;
        signature_parse(&signature, property->declaration, class);
        act(signature.result.type, self + property->offset);
        signature_free(&signature);
    }
}

static GDExtensionObjectPtr create(void* data, GDExtensionBool notify) {
    const Class* class = data;
    StringName parent = name_of(class->parent), name = name_of(class->name);
    const Object object = api.classdb_construct_object2(&parent);
    name_free(&parent);
    char* self = calloc(1, class->bytes);
    if (!self) abort(); /* the engine itself ends where memory does */
    *(Object*)(void*)self = object;
    for_fields(class, self, value_new);
    if (class->create) class->create(self);
    api.object_set_instance(object, &name, self);
    api.object_set_instance_binding(object, api.extension, self, &no_callbacks);
    name_free(&name);
    const int64_t postinitialize = 0;
    const uint8_t reversed = 0;
    const GDExtensionConstTypePtr arguments[] = {&postinitialize, &reversed};
    if (notify) engine_call(ENGINE_Object_notification, object, arguments, NULL);
    return object;
}

static void destroy(void* data, GDExtensionClassInstancePtr self) {
    const Class* class = data;
    if (class->destroy) class->destroy(self);
    for_fields(class, self, value_free);
    free(self);
}

void* instance_of(const Class* class, Object object) {
    if (!cast_to(object, class->name)) return NULL;
    return api.object_get_instance_binding(object, api.extension, &no_callbacks);
}

static void* find_virtual(void* data, GDExtensionConstStringNamePtr name, uint32_t hash) {
    (void)hash;
    const Class* class = data;
    if (!class->warnings) return NULL;
    StringName wanted = name_of("_get_configuration_warnings");
    const bool same = memcmp(&wanted, name, sizeof wanted) == 0; /* equal names are one string */
    name_free(&wanted);
    return same ? data : NULL;
}

static void call_virtual(GDExtensionClassInstancePtr self, GDExtensionConstStringNamePtr name, void* data,
                         const GDExtensionConstTypePtr* arguments, GDExtensionTypePtr result) {
    (void)name;
    (void)arguments;
    const Class* class = data;
    class->warnings(self, result);
}

static Bound* bind(const Class* class) {
    Bound* bound = calloc(1, sizeof *bound);
    if (!bound) abort();
    bound->class = class;
    bound->next = all_bound;
    all_bound = bound;
    return bound;
}

static void add_method(const Class* class, const char* text, const Method* method, const Property* property) {
    Signature signature;
    signature_parse(&signature, text, class);
    Bound* bound = bind(class);
    bound->method = method;
    bound->property = property;
    bound->result = signature.result.type;
    bound->count = signature.count;
    GDExtensionPropertyInfo infos[MOST_ARGUMENTS];
    GDExtensionClassMethodArgumentMetadata metadata[MOST_ARGUMENTS] = {GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE};
    Variant defaults[MOST_ARGUMENTS];
    GDExtensionVariantPtr default_pointers[MOST_ARGUMENTS];
    for (int n = 0; n < signature.count; ++n) {
        const Declared* argument = &signature.arguments[n];
        infos[n] = argument->info;
        bound->types[n] = argument->type;
        bound->default_values[n] = argument->default_value;
        if (!argument->has_default) continue;
        defaults[bound->defaults] = default_variant(argument->type, argument->default_value);
        default_pointers[bound->defaults] = &defaults[bound->defaults];
        ++bound->defaults;
    }
    const GDExtensionClassMethodInfo info = {
        .name = &signature.result.name,
        .method_userdata = bound,
        .call_func = call_with_variants,
        .ptrcall_func = call_with_pointers,
        .method_flags = GDEXTENSION_METHOD_FLAGS_DEFAULT,
        .has_return_value = signature.result.type != GDEXTENSION_VARIANT_TYPE_NIL,
        .return_value_info = &signature.result.info,
        .argument_count = (uint32_t)signature.count,
        .arguments_info = infos,
        .arguments_metadata = metadata,
        .default_argument_count = (uint32_t)bound->defaults,
        .default_arguments = default_pointers,
    };
    StringName class_name = name_of(class->name);
    api.classdb_register_extension_class_method(api.extension, &class_name, &info);
    name_free(&class_name);
    for (int n = 0; n < bound->defaults; ++n) api.variant_destroy(&defaults[n]);
    signature_free(&signature);
}

static void add_property(const Class* class, const Property* property) {
    Signature signature;
    signature_parse(&signature, property->declaration, class);
    const char* name = strrchr(property->declaration, ' ') + 1;
    char text[160], setter_text[80], getter_text[80];
    snprintf(setter_text, sizeof setter_text, "set_%s", name);
    snprintf(getter_text, sizeof getter_text, "get_%s", name);
    snprintf(text, sizeof text, "void %s(%s)", setter_text, property->declaration);
    add_method(class, text, NULL, property);
    snprintf(text, sizeof text, "%.*s %s()", (int)(name - property->declaration - 1), property->declaration, getter_text);
    add_method(class, text, NULL, property);

    StringName setter = name_of(setter_text), getter = name_of(getter_text), class_name = name_of(class->name);
    String hint = string_of(property->hint_text ? property->hint_text : "");
    GDExtensionPropertyInfo info = signature.result.info;
    info.hint = (uint32_t)property->hint;
    info.hint_string = &hint;
    api.classdb_register_extension_class_property(api.extension, &class_name, &info, &setter, &getter);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &hint);
    name_free(&setter);
    name_free(&getter);
    name_free(&class_name);
    signature_free(&signature);
}

static void add_signal(const Class* class, const char* text) {
    Signature signature;
    signature_parse(&signature, text, class);
    GDExtensionPropertyInfo infos[MOST_ARGUMENTS];
    for (int n = 0; n < signature.count; ++n) infos[n] = signature.arguments[n].info;
    StringName class_name = name_of(class->name);
    api.classdb_register_extension_class_signal(api.extension, &class_name, &signature.result.name, infos, signature.count);
    name_free(&class_name);
    signature_free(&signature);
}

static void add_constant(const Class* class, const Constant* constant) {
    StringName class_name = name_of(class->name), of = name_of(constant->of), name = name_of(constant->name);
    api.classdb_register_extension_class_integer_constant(api.extension, &class_name, &of, &name, constant->value, false);
    name_free(&class_name);
    name_free(&of);
    name_free(&name);
}

void register_class(const Class* class) {
    const GDExtensionClassCreationInfo4 info = {
        .is_exposed = true,
        .notification_func = class->notify,
        .create_instance_func = create,
        .free_instance_func = destroy,
        .get_virtual_call_data_func = find_virtual,
        .call_virtual_with_data_func = call_virtual,
        .class_userdata = (void*)(uintptr_t) class,
    };
    StringName name = name_of(class->name), parent = name_of(class->parent);
    api.classdb_register_extension_class4(api.extension, &name, &parent, &info);
    name_free(&name);
    name_free(&parent);
    ++registered;
    for (const Constant* constant = class->constants; constant && constant->name; ++constant) add_constant(class, constant);
    for (const Property* property = class->properties; property && property->declaration; ++property)
        add_property(class, property);
    for (const Method* method = class->methods; method && method->signature; ++method)
        add_method(class, method->signature, method, NULL);
    for (const char* const* signal = class->signals; signal && *signal; ++signal) add_signal(class, *signal);
}

void unregister_class(const Class* class) {
    StringName name = name_of(class->name);
    api.classdb_unregister_extension_class(api.extension, &name);
    name_free(&name);
    if (--registered > 0) return;
    while (all_bound) {
        Bound* next = all_bound->next;
        free(all_bound);
        all_bound = next;
    }
}
