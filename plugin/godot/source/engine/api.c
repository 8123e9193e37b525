#include "api.h"

#include <stdarg.h>
#include <stdio.h>

Api api;

bool load_api(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library) {
    api.get_proc_address = get_proc_address;
    api.extension = library;
#define API_LOAD(name, type)                                                                                                     \
    api.name = (GDExtensionInterface##type)(void (*)(void))get_proc_address(#name);                                              \
    if (!api.name) {                                                                                                             \
        fprintf(stderr, "Wadi: this engine has no function " #name "; Godot 4.4 or later is needed\n");                          \
        return false;                                                                                                            \
    }
    API_FUNCTIONS(API_LOAD)
#undef API_LOAD
    return true;
}

typedef void (*Printer)(const char* description, const char* function, const char* file, int32_t line, GDExtensionBool notify);

static void write_line(Printer printer, const char* format, va_list arguments) {
    char text[1024] = "Wadi: ";
    vsnprintf(text + 6, sizeof text - 6, format, arguments);
    printer(text, "wadi", "wadi", 0, false);
}

void log_warning(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    write_line(api.print_warning, format, arguments);
    va_end(arguments);
}

void log_error(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    write_line(api.print_error, format, arguments);
    va_end(arguments);
}
