#include "engine/engine.h"
#include "results.h"
#include "terrain.h"

#include <stdarg.h>
#include <stdio.h>

static void lose(Terrain* terrain) {
    if (terrain->lost) return;
    terrain->lost = true;
    String text = string_of(terrain->message);
    Variant argument = variant_of(GDEXTENSION_VARIANT_TYPE_STRING, &text);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &text);
    emit(terrain->object, "device_lost", &argument, 1);
}

int64_t world_failed(Terrain* terrain, const char* call, wadi_result result) {
    snprintf(terrain->message, sizeof terrain->message, "%s: %s", call, wadi_get_last_error());
    if (!terrain->lost) log_error("%s", terrain->message); /* a lost device fails every tick */
    if (result == WADI_ERROR_DEVICE_LOST) lose(terrain);
    return error_of(result);
}

int64_t world_refused(Terrain* terrain, int64_t error, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(terrain->message, sizeof terrain->message, format, arguments);
    va_end(arguments);
    log_error("%s", terrain->message);
    return error;
}

bool world_needed(Terrain* terrain, const char* call) {
    if (terrain->started) return true;
    world_refused(terrain, ERROR_UNCONFIGURED, "%s: there is no world yet; start() makes it", call);
    return false;
}
