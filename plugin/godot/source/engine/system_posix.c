#include "system.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h> /* mkdtemp on macOS */

SystemFunction system_function(const char* library, const char* name) {
    void* handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    SystemFunction function = NULL;
    if (handle) *(void**)&function = dlsym(handle, name);
    return function;
}

bool system_make_folder(char* path, size_t size) {
    const char* temporary = getenv("TMPDIR");
    snprintf(path, size, "%s/wadi-map-XXXXXX", temporary && *temporary ? temporary : "/tmp");
    return mkdtemp(path) != NULL;
}
