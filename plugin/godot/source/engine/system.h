/* What is asked of a system itself: system_posix.c (Linux, macOS) and system_windows.c, of which a build takes one. */
#ifndef WADI_GODOT_SYSTEM_H
#define WADI_GODOT_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

/** A function of a shared library, which is loaded by its name and stays; NULL where there is no such library or function. */
typedef void (*SystemFunction)(void);
SystemFunction system_function(const char* library, const char* name);

/** Makes a new folder among the temporary files and writes its path, or the one that could not be made, to `path`. */
bool system_make_folder(char* path, size_t size);

#endif
