#include "system.h"

#include <direct.h>
#include <errno.h>
#include <process.h>
#include <stdio.h>
#include <windows.h>

SystemFunction system_function(const char* library, const char* name) {
    const HMODULE handle = LoadLibraryA(library);
    return handle ? (SystemFunction)(void*)GetProcAddress(handle, name) : NULL;
}

bool system_make_folder(char* path, size_t size) {
    char temporary[MAX_PATH + 1]; /* with its "\" */
    const DWORD length = GetTempPathA(sizeof temporary, temporary);
    int error = EEXIST;
    for (unsigned n = 0; error == EEXIST && length < sizeof temporary; ++n) {
        snprintf(path, size, "%swadi-map-%d-%u", temporary, _getpid(), n);
        error = _mkdir(path) == 0 ? 0 : errno;
    }
    return error == 0;
}
