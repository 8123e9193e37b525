#include "calls.h"

Variant default_variant(GDExtensionVariantType type, double value) {
    const uint8_t as_bool = value != 0;
    const int64_t as_int = (int64_t)value;
    const void* source = type == GDEXTENSION_VARIANT_TYPE_BOOL  ? (const void*)&as_bool
                         : type == GDEXTENSION_VARIANT_TYPE_INT ? (const void*)&as_int
                                                                : (const void*)&value;
    return variant_of(type, source);
}

void call_with_pointers(void* data, GDExtensionClassInstancePtr self, const GDExtensionConstTypePtr* arguments,
                        GDExtensionTypePtr result) {
    const Bound* bound = data;
    if (bound->method) {
        bound->method->call(self, arguments, result);
        return;
    }
    char* field = (char*)self + bound->property->offset;
    if (bound->result != GDEXTENSION_VARIANT_TYPE_NIL) {
        value_assign(bound->result, result, field);
        return;
    }
    value_assign(bound->types[0], field, arguments[0]);
    if (bound->property->changed) bound->property->changed(self);
}

/* Calls with values of the right types at `arguments`, and packs the result. */
static void call_converted(Bound* bound, void* self, const GDExtensionConstTypePtr* arguments, Variant* result) {
    if (bound->result == GDEXTENSION_VARIANT_TYPE_NIL) {
        call_with_pointers(bound, self, arguments, NULL);
        api.variant_new_nil(result);
        return;
    }
    uint64_t value[8];
    value_new(bound->result, value);
    call_with_pointers(bound, self, arguments, value);
    *result = variant_of(bound->result, value);
    value_free(bound->result, value);
}

/* The address of the value inside a variant, which is converted first where its type is another. */
static const void* unpack(Variant* variant, GDExtensionVariantType type, bool* good) {
    const GDExtensionVariantType has = api.variant_get_type(variant);
    static const Object nothing = NULL;
    *good = true;
    if (has == GDEXTENSION_VARIANT_TYPE_NIL && type == GDEXTENSION_VARIANT_TYPE_OBJECT) return &nothing;
    if (has != type) {
        *good = api.variant_can_convert_strict(has, type);
        if (!*good) return NULL;
        Variant converted;
        const GDExtensionConstVariantPtr arguments[] = {variant};
        GDExtensionCallError error = {0};
        api.variant_construct(type, &converted, arguments, 1, &error);
        *good = error.error == GDEXTENSION_CALL_OK;
        if (!*good) return NULL;
        api.variant_destroy(variant);
        *variant = converted;
    }
    return api.variant_get_ptr_internal_getter(type)(variant);
}

void call_with_variants(void* data, GDExtensionClassInstancePtr self, const GDExtensionConstVariantPtr* given,
                        GDExtensionInt count, GDExtensionVariantPtr result, GDExtensionCallError* error) {
    Bound* bound = data;
    Variant variants[MOST_ARGUMENTS];
    GDExtensionConstTypePtr arguments[MOST_ARGUMENTS];
    error->error = GDEXTENSION_CALL_OK;
    if (count > bound->count || count < bound->count - bound->defaults) {
        error->error =
            count > bound->count ? GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS : GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS;
        error->expected = count > bound->count ? bound->count : bound->count - bound->defaults;
        return;
    }
    int made = 0;
    for (; made < bound->count && error->error == GDEXTENSION_CALL_OK; ++made) {
        if (made < count)
            api.variant_new_copy(&variants[made], given[made]);
        else
            variants[made] = default_variant(bound->types[made], bound->default_values[made]);
        bool good;
        arguments[made] = unpack(&variants[made], bound->types[made], &good);
        if (good) continue;
        error->error = GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT;
        error->argument = made;
        error->expected = (int32_t)bound->types[made];
    }
    if (error->error == GDEXTENSION_CALL_OK) {
        Variant value;
        call_converted(bound, self, arguments, &value);
        api.variant_destroy(result); /* the engine hands over a variant */
        *(Variant*)result = value;
    }
    for (int n = 0; n < made; ++n) api.variant_destroy(&variants[n]);
}
