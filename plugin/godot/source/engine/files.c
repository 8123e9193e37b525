#include "files.h"

#include "engine.h"

bool file_exists(const char* path) {
    String text = string_of(path);
    uint8_t exists = 0;
    const GDExtensionConstTypePtr arguments[] = {&text};
    engine_call(ENGINE_FileAccess_file_exists, NULL, arguments, &exists);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &text);
    return exists;
}

PackedByteArray file_bytes(const char* path) {
    String text = string_of(path);
    PackedByteArray bytes;
    value_new(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &bytes);
    const GDExtensionConstTypePtr arguments[] = {&text};
    engine_call(ENGINE_FileAccess_get_file_as_bytes, NULL, arguments, &bytes);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &text);
    return bytes;
}

char* global_path(const char* path) {
    String text = string_of(path), global = string_of("");
    const GDExtensionConstTypePtr arguments[] = {&text};
    engine_call(ENGINE_ProjectSettings_globalize_path, singleton("ProjectSettings"), arguments, &global);
    char* result = string_text(&global);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &text);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &global);
    return result;
}
