#include "engine/collections.h"
#include "engine/engine.h"
#include "textures.h"

#include <stdlib.h>
#include <string.h>

/* An output's texel: the engine's Image.Format, bytes. */
typedef struct TexelFormat {
    int64_t image_format;
    size_t bytes;
} TexelFormat;

static TexelFormat texel_format(wadi_output output) {
    enum { RF = 8, RGF = 9, RGBAF = 11, RGBAH = 15 };
    switch (output) {
    case WADI_OUTPUT_FLOW:
    case WADI_OUTPUT_SAND_VELOCITY:
        return (TexelFormat){RGF, 8};
    case WADI_OUTPUT_NORMAL:
    case WADI_OUTPUT_PACKED:
        return (TexelFormat){RGBAF, 16};
    case WADI_OUTPUT_PACKED_HALF:
        return (TexelFormat){RGBAH, 8};
    default:
        return (TexelFormat){RF, 4};
    }
}

void textures_clear(Textures* textures) {
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        value_free(GDEXTENSION_VARIANT_TYPE_OBJECT, &textures->objects[output]);
        textures->steps[output] = UINT64_MAX;
    }
}

/* An Image of the rows, which lie row_pitch bytes apart. */
static Object image_of(const void* data, uint64_t row_pitch, const wadi_world_info* info, TexelFormat format) {
    const size_t row = (size_t)info->nx * format.bytes;
    PackedByteArray bytes;
    uint8_t* room = bytes_new(&bytes, row * (size_t)info->ny);
    Object image = NULL;
    if (room) {
        for (int32_t j = 0; j < info->ny; ++j) memcpy(room + (size_t)j * row, (const char*)data + (size_t)j * row_pitch, row);
        const int64_t width = info->nx, height = info->ny;
        const uint8_t mipmaps = 0;
        const GDExtensionConstTypePtr arguments[] = {&width, &height, &mipmaps, &format.image_format, &bytes};
        engine_call(ENGINE_Image_create_from_data, NULL, arguments, &image);
    }
    value_free(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &bytes);
    return image;
}

/* The engine's renderer without a display keeps what a texture was made of and drops what it is updated with: no use to copy. */
static bool updates_are_kept(void) {
    static int kept = -1;
    if (kept < 0) {
        String name = string_of("");
        engine_call(ENGINE_DisplayServer_get_name, singleton("DisplayServer"), NULL, &name);
        char* text = string_text(&name);
        kept = text && strcmp(text, "headless") == 0 ? 0 : 1;
        free(text);
        value_free(GDEXTENSION_VARIANT_TYPE_STRING, &name);
    }
    return kept;
}

static void show(Object* texture, Object image) {
    const GDExtensionConstTypePtr arguments[] = {&image};
    if (*texture)
        engine_call(ENGINE_ImageTexture_update, *texture, arguments, NULL);
    else
        engine_call(ENGINE_ImageTexture_create_from_image, NULL, arguments, texture);
}

bool textures_update_host(Textures* textures, wadi_world_id world, const wadi_world_info* info, wadi_output_mask mask,
                          uint64_t step) {
    bool all = true;
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        if (!(mask & WADI_OUTPUT_BIT(output))) continue;
        const float* data;
        uint64_t row_pitch, shown;
        if (wadi_world_get_host_output(world, (wadi_output)output, &data, &row_pitch, &shown) != WADI_OK) {
            all = false;
            continue;
        }
        textures->steps[output] = shown;
        all = all && shown == step;
        if (textures->objects[output] && !updates_are_kept()) continue;
        Object image = image_of(data, row_pitch, info, texel_format((wadi_output)output));
        if (image) show(&textures->objects[output], image);
        value_free(GDEXTENSION_VARIANT_TYPE_OBJECT, &image);
    }
    return all;
}
