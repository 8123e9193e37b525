/* Classes of the extension as tables: what a class has, and its registration with the engine. */
#ifndef WADI_GODOT_CLASSES_H
#define WADI_GODOT_CLASSES_H

#include "values.h"

/** A method. `signature` is parsed: "int query(PackedVector2Array points)", "void brush(Layer layer, float softness = 0.5)".
 *  Types: void, bool, int, float, String, NodePath, Vector2, Vector2i, Vector3, Rect2i, Dictionary, PackedByteArray,
 * PackedFloat32Array, PackedStringArray, PackedVector2Array; Rect2i[] and Dictionary[]; Error and the class's own enums; any
 * other is a class. Defaults are numbers. Arguments and result are pointers as in engine_call; the result is a value already. */
typedef struct Method {
    const char* signature;
    void (*call)(void* self, const GDExtensionConstTypePtr* arguments, void* result);
} Method;

/** A property that is a field of the instance, with set_NAME and get_NAME. */
typedef struct Property {
    const char* declaration; /* "String backend" */
    size_t offset;           /* of a value of that type: uint8_t, int64_t, double, String ... in the instance */
    int hint;                /* PropertyHint */
    const char* hint_text;
    void (*changed)(void* self); /* after it was set; may be NULL */
} Property;

typedef struct Constant {
    const char* name;
    int64_t value;
    const char* of; /* its enum */
} Constant;

typedef struct Class {
    const char *name, *parent;
    size_t bytes;               /* of an instance, which begins with the Object */
    void (*create)(void* self); /* after all bytes are zero and all properties empty */
    void (*destroy)(void* self);
    void (*notify)(void* self, int32_t what, uint8_t reversed); /* may be NULL */
    void (*warnings)(void* self, PackedStringArray* warnings);  /* what the scene tree warns about; may be NULL */
    const Method* methods;                                      /* each table ends with an entry of zeroes; may be NULL */
    const Property* properties;
    const char* const* signals; /* signatures */
    const Constant* constants;
} Class;

/** Registers a class; its tables must last until unregister_class. */
void register_class(const Class* class);
void unregister_class(const Class* class);

/** The instance behind an object of that class or of one that extends it, NULL for any other object and for NULL. */
void* instance_of(const Class* class, Object object);

/* PropertyHint */
enum {
    HINT_NONE = 0,
    HINT_RANGE = 1,
    HINT_ENUM = 2,
    HINT_ENUM_SUGGESTION = 3,
    HINT_FLAGS = 6,
    HINT_FILE = 13,
    HINT_RESOURCE_TYPE = 17,
    HINT_MULTILINE = 18,
    HINT_NODE_PATH_TYPES = 26
};
/* Notifications of nodes */
enum {
    NOTIFICATION_ENTER_TREE = 10,
    NOTIFICATION_EXIT_TREE = 11,
    NOTIFICATION_READY = 13,
    NOTIFICATION_INTERNAL_PHYSICS_PROCESS = 26
};

#endif
