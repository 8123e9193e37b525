#include "results.h"

int64_t error_of(wadi_result result) {
    switch (result) {
    case WADI_OK:
        return ERROR_OK;
    case WADI_ERROR_BAD_ARGUMENT:
        return ERROR_INVALID_PARAMETER;
    case WADI_ERROR_NOT_FOUND:
        return ERROR_FILE_NOT_FOUND;
    case WADI_ERROR_BAD_FILE:
        return ERROR_FILE_CORRUPT;
    case WADI_ERROR_NOT_SUPPORTED:
        return ERROR_UNAVAILABLE;
    case WADI_ERROR_OUT_OF_MEMORY:
        return ERROR_OUT_OF_MEMORY;
    case WADI_ERROR_DEVICE_LOST:
        return ERROR_FAILED;
    case WADI_ERROR_INTERNAL:
        return ERROR_BUG;
    case WADI_NOT_READY:
        return ERROR_BUSY;
    case WADI_CANCELLED: /* the extension gives no progress callback */
    case WADI_ERROR_BUSY:
        return ERROR_BUSY;
    }
    return ERROR_FAILED;
}
