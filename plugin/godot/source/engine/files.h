/* Files through the engine, which finds them in folders, in exported packs and behind res:// and user://. */
#ifndef WADI_GODOT_FILES_H
#define WADI_GODOT_FILES_H

#include "values.h"

bool file_exists(const char* path);
/** All bytes of a file; empty where there is none. */
PackedByteArray file_bytes(const char* path);
/** The path of the system for one that begins with res:// or user://; free() it. */
char* global_path(const char* path);

#endif
