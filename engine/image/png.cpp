#include "engine/image/map.hpp"
#include "engine/image/plausible.hpp"
#include <algorithm>
#include <array>
#include <climits>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <memory>

namespace {
// What stb_image may grow a buffer to while it decodes on this thread. It starts with what the header implies, grows only where
// the data holds more, and would go on to 4 GiB.
thread_local std::size_t grow_most = 0;
thread_local bool grew_past = false;

void* grow(void* memory, std::size_t bytes) {
    grew_past = grew_past || bytes > grow_most;
    return bytes > grow_most ? nullptr : std::realloc(memory, bytes);
}
} // namespace

#define STBI_MALLOC(bytes) std::malloc(bytes)
#define STBI_REALLOC(memory, bytes) grow(memory, bytes)
#define STBI_FREE(memory) std::free(memory)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 16384
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace wadi {
namespace {

constexpr std::size_t SIGNATURE_BYTES = 8;
constexpr std::array<std::uint8_t, SIGNATURE_BYTES> SIGNATURE = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
// Deflate expands by at most this factor (PNG specification, second edition, annex; zlib technical notes).
constexpr std::uint64_t DEFLATE_LIMIT = 1032;

std::uint32_t big_endian(const std::uint8_t* at) {
    return (std::uint32_t{at[0]} << 24) | (std::uint32_t{at[1]} << 16) | (std::uint32_t{at[2]} << 8) | at[3];
}

std::uint32_t crc32(const std::uint8_t* data, std::size_t size) {
    static const std::array<std::uint32_t, 256> table = [] {
        std::array<std::uint32_t, 256> t{};
        for (std::uint32_t n = 0; n < 256; ++n) {
            std::uint32_t c = n;
            for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
            t[n] = c;
        }
        return t;
    }();
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 0; i < size; ++i) crc = table[(crc ^ data[i]) & 0xffu] ^ (crc >> 8);
    return crc ^ 0xffffffffu;
}

/// stb_image checks neither chunk checksums nor that the file ends where it should: a damaged map would load.
Status check_chunks(const std::vector<std::uint8_t>& bytes, const std::string& name) {
    constexpr std::size_t overhead = 12; // length, type and checksum
    std::size_t at = SIGNATURE_BYTES;
    for (;;) {
        if (bytes.size() - at < overhead) return error(Code::bad_file, name + ": truncated at byte " + std::to_string(at));
        const std::size_t length = big_endian(&bytes[at]);
        if (length > bytes.size() - at - overhead)
            return error(Code::bad_file, name + ": truncated inside the chunk at byte " + std::to_string(at));
        if (crc32(&bytes[at + 4], length + 4) != big_endian(&bytes[at + 8 + length]))
            return error(Code::bad_file, name + ": damaged, wrong checksum of the chunk at byte " + std::to_string(at));
        if (std::string(&bytes[at + 4], &bytes[at + 8]) == "IEND") return ok_status();
        at += overhead + length;
    }
}

/// Samples of a pixel by its colour type.
std::uint64_t channels_of(std::uint8_t color) {
    constexpr std::uint64_t grey_alpha = 2, rgb = 3, rgba = 4;
    return color == 2 ? rgb : color == 4 ? grey_alpha : color == 6 ? rgba : 1;
}

/// stb_image names no reason where it had no memory for what it inflates; it keeps that of an earlier failure of the thread.
Status why_not(const std::string& name) {
    if (grew_past) return error(Code::bad_file, name + ": damaged, its data holds more than the pixels of its header");
    const char* reason = stbi_failure_reason();
    if (reason == nullptr || std::string(reason) == "outofmem")
        return error(Code::out_of_memory, name + ": there is no memory to decode this PNG");
    return error(Code::bad_file, name + ": PNG cannot be decoded: " + reason);
}

/// Metres of packed colours; black, which tiles have where they know nothing, is a hole.
float unpacked(const stbi_uc* rgb, Packing packing) {
    const double r = rgb[0], g = rgb[1], b = rgb[2];
    if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) return std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(packing == Packing::terrarium ? 256 * r + g + b / 256 - 32768
                                                            : 0.1 * (65536 * r + 256 * g + b) - 10000);
}

std::vector<float> to_metres(const stbi_uc* samples, int nx, int ny, Packing packing) {
    std::vector<float> metres;
    const auto width = static_cast<std::size_t>(nx);
    metres.reserve(width * static_cast<std::size_t>(ny));
    for (auto row = static_cast<std::size_t>(ny); row-- > 0;)
        for (std::size_t i = 0; i < width; ++i) metres.push_back(unpacked(&samples[3 * (row * width + i)], packing));
    return metres;
}

template <class Sample> std::vector<float> to_grey(const Sample* samples, int nx, int ny, float white) {
    std::vector<float> grey;
    const auto width = static_cast<std::size_t>(nx);
    grey.reserve(width * static_cast<std::size_t>(ny));
    for (auto row = static_cast<std::size_t>(ny); row-- > 0;)
        for (std::size_t i = 0; i < width; ++i) grey.push_back(static_cast<float>(samples[row * width + i]) / white);
    return grey;
}

} // namespace

Result<Map> decode_png(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room, Packing packing) {
    const std::size_t ihdr_end = SIGNATURE_BYTES + 25;
    if (bytes.size() < ihdr_end || bytes.size() > INT_MAX || !std::equal(SIGNATURE.begin(), SIGNATURE.end(), bytes.begin()))
        return error(Code::bad_file, name + ": not a PNG file");
    if (Status status = check_chunks(bytes, name); !status) return status;
    const std::int64_t width = big_endian(&bytes[16]);
    const std::int64_t height = big_endian(&bytes[20]);
    const auto channels = static_cast<std::int64_t>(channels_of(bytes[25]));
    if (Status status = check_map_size(width, height, name, nullptr); !status) return status;
    // The header alone decides how much the decoder allocates: the data must be able to fill it.
    const std::uint64_t row = (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(channels) * bytes[24] + 7) / 8;
    const std::uint64_t decoded = (row + 1) * static_cast<std::uint64_t>(height); // a byte per row says how it is filtered
    if (decoded > DEFLATE_LIMIT * bytes.size())
        return error(Code::bad_file, name + ": " + std::to_string(bytes.size()) + " bytes cannot hold the " +
                                         std::to_string(width) + " x " + std::to_string(height) + " pixels of its header");
    if (decoded > INT_MAX)
        return error(Code::bad_file, name + ": " + std::to_string(decoded) + " bytes when decoded are more than the " +
                                         std::to_string(INT_MAX) + " bytes of the largest PNG");
    if (room != nullptr)
        if (Status status = room->take({width * height * channels, static_cast<int>(width), static_cast<int>(height)}, name);
            !status)
            return status;
    const auto size = static_cast<int>(bytes.size());
    int nx = 0;
    int ny = 0;
    int found = 0;
    Map map;
    const bool packed = packing != Packing::grey;
    if (packed && (bytes[24] != 8 || bytes[25] == 0 || bytes[25] == 4))
        return error(Code::bad_file, name + ": heights are packed into colours of 8 bits each, which this PNG has not");
    map.integer = !packed;
    stbi__g_failure_reason = nullptr;
    // Chunks of data are put together first. Interlaced rows are more, shorter and padded; some writers pad the end.
    constexpr std::size_t smallest = 4096;
    grew_past = false;
    grow_most = std::max(2 * bytes.size(), 4 * static_cast<std::size_t>(decoded)) + smallest;
    if (packed) {
        constexpr int rgb = 3;
        const std::unique_ptr<stbi_uc, void (*)(void*)> samples(stbi_load_from_memory(bytes.data(), size, &nx, &ny, &found, rgb),
                                                                stbi_image_free);
        if (!samples) return why_not(name);
        map.values = to_metres(samples.get(), nx, ny, packing);
    } else if (stbi_is_16_bit_from_memory(bytes.data(), size) != 0) {
        const std::unique_ptr<stbi_us, void (*)(void*)> samples(stbi_load_16_from_memory(bytes.data(), size, &nx, &ny, &found, 1),
                                                                stbi_image_free);
        if (!samples) return why_not(name);
        map.values = to_grey(samples.get(), nx, ny, 65535.0f);
    } else {
        const std::unique_ptr<stbi_uc, void (*)(void*)> samples(stbi_load_from_memory(bytes.data(), size, &nx, &ny, &found, 1),
                                                                stbi_image_free);
        if (!samples) return why_not(name);
        map.values = to_grey(samples.get(), nx, ny, 255.0f);
    }
    map.nx = nx;
    map.ny = ny;
    if (packed)
        if (Status status = fill_holes(map, name); !status) return status;
    return map;
}

} // namespace wadi
