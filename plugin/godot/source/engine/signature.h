/* Signatures of methods and signals, "int query(PackedVector2Array points)", taken apart for the engine. */
#ifndef WADI_GODOT_SIGNATURE_H
#define WADI_GODOT_SIGNATURE_H

#include "classes.h"

enum { MOST_ARGUMENTS = 6 };

/* One argument, property or result with the texts that the engine's struct points to. */
typedef struct Declared {
    GDExtensionVariantType type; /* NIL: void */
    char class_text[64];         /* of objects and enums */
    char name_text[64];
    char element_text[32]; /* of typed arrays */
    bool has_default;
    double default_value;
    StringName name, class_name;
    String hint_text;
    GDExtensionPropertyInfo info;
} Declared;

typedef struct Signature {
    Declared result; /* its name is the method's */
    int count;
    Declared arguments[MOST_ARGUMENTS];
} Signature;

/** Takes a signature or a declaration without brackets apart; signature_free it. `owner` has the enums. A text that breaks the
 * grammar ends the program: it is a fault of this extension's tables. */
void signature_parse(Signature* signature, const char* text, const Class* owner);
void signature_free(Signature* signature);

#endif
