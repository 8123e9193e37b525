/* A host that opens the library, uses it, closes it and ends. Usage: open_and_close LIBRARY LEVEL */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <wadi/wadi.h>

#define CALL(name) (*(__typeof__(&name)*)address(library, #name))

static void* address(void* library, const char* name) {
    static void* found;
    found = dlsym(library, name);
    return &found;
}

int main(int argc, char** argv) {
    void* library = argc > 2 ? dlopen(argv[1], RTLD_NOW) : NULL;
    if (!library) {
        fprintf(stderr, "open_and_close: %s\n", argc > 2 ? dlerror() : "LIBRARY LEVEL");
        return 1;
    }
    wadi_world_id world;
    if (CALL(wadi_create_world_from_level)(argv[2], NULL, NULL, &world) != WADI_OK ||
        CALL(wadi_world_step)(world, 3) != WADI_OK || CALL(wadi_destroy_world)(world) != WADI_OK) {
        return 1;
    }
    printf("opened, stepped, closed: %d\n", dlclose(library));
    return 0;
}
