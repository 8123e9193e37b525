/* Results of the library as the engine's errors. */
#ifndef WADI_GODOT_RESULTS_H
#define WADI_GODOT_RESULTS_H

#include <stdint.h>
#include <wadi/wadi.h>

/* The engine's Error values that the extension returns. */
enum {
    ERROR_OK = 0,
    ERROR_FAILED = 1,
    ERROR_UNAVAILABLE = 2,
    ERROR_UNCONFIGURED = 3,
    ERROR_OUT_OF_MEMORY = 6,
    ERROR_FILE_NOT_FOUND = 7,
    ERROR_FILE_CORRUPT = 16,
    ERROR_ALREADY_IN_USE = 22,
    ERROR_INVALID_PARAMETER = 31,
    ERROR_BUSY = 44,
    ERROR_BUG = 47
};

/** The engine's error for a result. */
int64_t error_of(wadi_result result);

#endif
