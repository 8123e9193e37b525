/* An engine of a few hundred lines in the place of Godot: it gives a built extension the functions of the interface, and keeps
 * values, objects and the classes that the extension registers. stand_in.c; play_extension.c plays a scene with it. */
#ifndef STAND_IN_H
#define STAND_IN_H

#include "engine/values.h"

typedef struct Thing Thing; /* an object */

GDExtensionInterfaceFunctionPtr stand_in_function(const char* name);

/** A new object of a class of the extension, or of any other name; NULL where it cannot be made. */
Thing* stand_in_make(const char* class_name);
void stand_in_free(Thing* thing);
void stand_in_notify(Thing* thing, int32_t what);

/** An argument. */
Variant a_number(double value);
Variant an_integer(int64_t value);
Variant a_truth(bool value);
Variant a_text(const char* text);
Variant a_place(float x, float y, float z);
Variant a_region(int x, int y, int width, int height);
Variant a_thing(Thing* thing);
Variant a_copy(const Variant* value);

/** Calls a method of the extension as a script does, frees the arguments and gives the result; ends the program where the
 * extension refuses the call. */
Variant stand_in_call(Thing* thing, const char* method, int count, Variant* arguments);
/** The same by pointers, as compiled callers do: one argument, no result. */
void stand_in_set(Thing* thing, const char* method, Variant value);

void free_value(Variant* value);
int64_t whole(Variant value);
double number(Variant value);
/** Bytes of a text, a packed array or a texture's image, which stay with the value. */
const void* content(const Variant* value, size_t* size);
size_t elements(const Variant* dictionary_or_array);

/** What the extension emitted under that name so far. */
int signals_of(const char* name);
/** Warnings and errors of the extension so far. */
int messages(void);
/** Values and objects that nobody has freed. */
long values_alive(void);
/** A file that the engine has, and no path of the system leads to, as in an exported game's pack. */
void put_in_pack(const char* path, const char* from);

#endif
