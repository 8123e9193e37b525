/* A host that is not linked to the library: wadi_loader.h opens it. Usage: loader LIBRARY */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#define WADI_LOADER_IMPLEMENTATION
#include <wadi/wadi_loader.h>

typedef void (*function)(void);

/* The library's functions but one, if `lacks` names it. */
typedef struct opened {
    void* handle;
    const char* lacks;
} opened;

static function find(void* user, const char* name) {
    const opened* const from = (const opened*)user;
    function found = NULL;
    void* const address = from->lacks && strcmp(name, from->lacks) == 0 ? NULL : dlsym(from->handle, name);
    memcpy(&found, &address, sizeof found); /* POSIX lets a data pointer hold it, C has no cast */
    return found;
}

static uint32_t other_abi(void) { return WADI_ABI_VERSION + 1; }
static function find_other(void* user, const char* name) {
    return strcmp(name, "wadi_get_abi_version") == 0 ? (function)other_abi : find(user, name);
}

static int fails(const char* what, const char* detail) {
    fprintf(stderr, "not so: %s (%s)\n", what, detail ? detail : "");
    return 1;
}

int main(int argc, char** argv) {
    opened from = {argc > 1 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL, NULL};
    if (!from.handle) return fails("the library opens", dlerror());
    wadi_functions wadi;
    const char* missing = wadi_load_functions(&wadi, find, &from);
    if (missing) return fails("all functions are found", missing);
    wadi_world_id world;
    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    if (wadi.create_world_from_level_text("{\"format_version\": 1, \"name\": \"pond\", \"grid\": {\"nx\": 8, \"ny\": 8, \"dx\": 1}, \"dt\": 0.01}", NULL, NULL,
                                          NULL, &options, &world) != WADI_OK ||
        wadi.world_step(world, 3) != WADI_OK || wadi.destroy_world(world) != WADI_OK)
        return fails("a world steps", wadi.get_last_error());
    from.lacks = "wadi_world_trim";
    missing = wadi_load_functions(&wadi, find, &from);
    if (!missing || strcmp(missing, "wadi_world_trim") != 0) return fails("a function that is missing is named", missing);
    from.lacks = NULL;
    missing = wadi_load_functions(&wadi, find_other, &from);
    if (!missing || strcmp(missing, "wadi_get_abi_version") != 0) return fails("another ABI is refused", missing);
    puts("the library was opened, used, and told from another");
    return 0;
}
