/* How the engine's calls reach the functions of a class's table. */
#ifndef WADI_GODOT_CALLS_H
#define WADI_GODOT_CALLS_H

#include "signature.h"

/* What the engine keeps for one method or accessor and passes back with each call. */
typedef struct Bound {
    const Class* class;
    const Method* method;     /* or */
    const Property* property; /* its setter or getter */
    GDExtensionVariantType result;
    int count;
    GDExtensionVariantType types[MOST_ARGUMENTS];
    int defaults; /* the last so many arguments have them */
    double default_values[MOST_ARGUMENTS];
    struct Bound* next;
} Bound;

void call_with_pointers(void* bound, GDExtensionClassInstancePtr self, const GDExtensionConstTypePtr* arguments,
                        GDExtensionTypePtr result);
void call_with_variants(void* bound, GDExtensionClassInstancePtr self, const GDExtensionConstVariantPtr* arguments,
                        GDExtensionInt count, GDExtensionVariantPtr result, GDExtensionCallError* error);

/** A default as a variant of the argument's type: bool, int or float. */
Variant default_variant(GDExtensionVariantType type, double value);

#endif
