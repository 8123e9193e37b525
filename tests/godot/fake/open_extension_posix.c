#include "open_extension.h"

#include <dlfcn.h>
#include <stdio.h>

void (*open_extension(const char* path, const char* name))(void) {
    void* library = dlopen(path, RTLD_NOW);
    void (*function)(void) = NULL;
    if (library) *(void**)&function = dlsym(library, name);
    if (!function) fprintf(stderr, "cannot open the extension: %s\n", dlerror());
    return function;
}
