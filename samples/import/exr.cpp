#include "exr.hpp"
#include "request.hpp"
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <tinyexr.h>

namespace import_map {
namespace {

/// What the library allocates of a file.
struct Picture {
    EXRVersion version{};
    EXRHeader header{};
    EXRImage image{};
    Picture() {
        InitEXRHeader(&header);
        InitEXRImage(&image);
    }
    Picture(const Picture&) = delete;
    Picture& operator=(const Picture&) = delete;
    ~Picture() {
        FreeEXRImage(&image);
        FreeEXRHeader(&header);
    }
};

void expect(int result, const char* why, const std::string& name) {
    if (result == TINYEXR_SUCCESS) return;
    fail(name + ": cannot be read as an OpenEXR picture" + (why != nullptr ? std::string(": ") + why : std::string()));
}

int channel_of(const EXRHeader& header) {
    for (const std::string_view wanted : {"Y", "R"})
        for (int n = 0; n < header.num_channels; ++n)
            if (wanted == header.channels[n].name) return n;
    return 0;
}

} // namespace

Heights read_exr(const std::string& name) {
    Picture picture;
    EXRHeader& header = picture.header;
    const char* why = nullptr;
    expect(ParseEXRVersionFromFile(&picture.version, name.c_str()), nullptr, name);
    if (picture.version.multipart != 0 || picture.version.non_image != 0 || picture.version.tiled != 0)
        fail(name + ": pictures in parts, in tiles or with depth are not read; write it as rows (scan lines)");
    expect(ParseEXRHeaderFromFile(&header, &picture.version, name.c_str(), &why), why, name);
    const EXRBox2i& window = header.data_window;
    check_sides(name, std::int64_t{window.max_x} - window.min_x + 1, std::int64_t{window.max_y} - window.min_y + 1);
    if (header.num_channels < 1) fail(name + ": it has no channel");
    const int channel = channel_of(header);
    if (header.pixel_types[channel] == TINYEXR_PIXELTYPE_UINT)
        fail(name + ": whole numbers are not heights in metres; floats are");
    for (int n = 0; n < header.num_channels; ++n)
        if (header.pixel_types[n] == TINYEXR_PIXELTYPE_HALF) header.requested_pixel_types[n] = TINYEXR_PIXELTYPE_FLOAT;
    expect(LoadEXRImageFromFile(&picture.image, &header, name.c_str(), &why), why, name);
    Heights heights;
    heights.nx = static_cast<std::uint32_t>(picture.image.width);
    heights.ny = static_cast<std::uint32_t>(picture.image.height);
    heights.rows.resize(std::size_t{heights.nx} * heights.ny);
    std::memcpy(heights.rows.data(), picture.image.images[channel], heights.rows.size() * sizeof(float));
    for (float& height : heights.rows)
        if (!std::isfinite(height)) height = std::numeric_limits<float>::quiet_NaN();
    heights.notes.emplace_back("it does not say how large its cells are: --cell, else 1 m");
    if (header.num_channels > 1)
        heights.notes.push_back("it has " + std::to_string(header.num_channels) + " channels; " + header.channels[channel].name +
                                " is taken");
    return heights;
}

} // namespace import_map
