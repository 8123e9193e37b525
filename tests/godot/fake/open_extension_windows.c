#include "open_extension.h"

#include <stdio.h>
#include <windows.h>

/* As the engine does on Windows: the extension's folder is searched beside those of the system. */
void (*open_extension(const char* path, const char* name))(void) {
    wchar_t given[MAX_PATH], file[MAX_PATH], folder[MAX_PATH], *end = NULL;
    MultiByteToWideChar(CP_UTF8, 0, path, -1, given, MAX_PATH);
    GetFullPathNameW(given, MAX_PATH, file, NULL);
    if (GetFullPathNameW(given, MAX_PATH, folder, &end) && end) *end = 0;
    AddDllDirectory(folder);
    const HMODULE library = LoadLibraryExW(file, NULL, LOAD_LIBRARY_SEARCH_DEFAULT_DIRS);
    if (!library) fprintf(stderr, "cannot open the extension: error %lu of Windows\n", GetLastError());
    return library ? (void (*)(void))(void*)GetProcAddress(library, name) : NULL;
}
