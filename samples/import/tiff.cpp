#include "tiff.hpp"
#include "request.hpp"
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <tiffio.h>

namespace import_map {
namespace {

constexpr std::uint32_t PIXEL_SCALE = 33550, TIE_POINT = 33922, GEO_KEYS = 34735, GDAL_NODATA = 42113;

/// Tags of GeoTIFF and GDAL that libtiff does not know by itself.
void add_tags(TIFF* tiff) {
    static const TIFFFieldInfo fields[] = {
        {PIXEL_SCALE, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("ModelPixelScale")},
        {TIE_POINT, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("ModelTiepoint")},
        {GEO_KEYS, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_SHORT, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoKeyDirectory")},
        {GDAL_NODATA, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDAL_NODATA")},
    };
    TIFFMergeFieldInfo(tiff, fields, static_cast<std::uint32_t>(std::size(fields)));
}

struct Places {
    bool degrees = false;
    std::optional<double> nodata;
};

template <class T> double number(const std::uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
}

double sample(const std::uint8_t* at, int bits, int format, const std::string& name) {
    if (format == SAMPLEFORMAT_IEEEFP && bits == 32) return number<float>(at);
    if (format == SAMPLEFORMAT_IEEEFP && bits == 64) return number<double>(at);
    const bool is_signed = format == SAMPLEFORMAT_INT;
    if (bits == 8) return is_signed ? number<std::int8_t>(at) : number<std::uint8_t>(at);
    if (bits == 16) return is_signed ? number<std::int16_t>(at) : number<std::uint16_t>(at);
    if (bits == 32) return is_signed ? number<std::int32_t>(at) : number<std::uint32_t>(at);
    fail(name + ": samples of " + std::to_string(bits) + " bits are not read; 8, 16 and 32, and floats of 32 and 64 are");
}

void read_places(TIFF* tiff, Heights& heights, Places& places) {
    std::uint16_t count = 0;
    const double* values = nullptr;
    if (TIFFGetField(tiff, PIXEL_SCALE, &count, &values) == 1 && count >= 2 && values[0] > 0 && values[1] > 0) {
        heights.has_cells = true;
        heights.dx = values[0];
        heights.dy = values[1];
    }
    if (TIFFGetField(tiff, TIE_POINT, &count, &values) == 1 && count >= 6) {
        heights.west = values[3] - values[0] * heights.dx;
        heights.south = values[4] + values[1] * heights.dy - heights.ny * heights.dy;
    }
    const std::uint16_t* keys = nullptr;
    if (TIFFGetField(tiff, GEO_KEYS, &count, &keys) == 1)
        for (std::uint32_t n = 4; n + 3 < count; n += 4)
            places.degrees |= keys[n] == 1024 && keys[n + 3] == 2; // model: geographic
    const char* text = nullptr;
    if (TIFFGetField(tiff, GDAL_NODATA, &text) == 1 && text != nullptr) places.nodata = std::strtod(text, nullptr);
}

/// Columns [x, x + count) of a row, from samples side by side.
void put(Heights& heights, const Places& places, std::uint32_t x, std::uint32_t y, std::uint32_t count, const std::uint8_t* from,
         int bits, int format, std::size_t pixel, const std::string& name) {
    for (std::uint32_t i = 0; i < count && x + i < heights.nx; ++i) {
        const double value = sample(from + i * pixel, bits, format, name);
        const bool hole = !std::isfinite(value) || std::fabs(value) > 3.39e38 ||
                          (places.nodata && std::fabs(value - *places.nodata) <= 1e-6 * std::fabs(*places.nodata));
        heights.rows[std::size_t{y} * heights.nx + x + i] = hole ? std::nanf("") : static_cast<float>(value);
    }
}

Heights read_all(const std::string& name, Places& places) {
    TIFFSetTagExtender(add_tags);
    const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(name.c_str(), "r"), TIFFClose);
    if (!tiff) fail(name + ": cannot be read as a TIFF");
    Heights heights;
    std::uint16_t bits = 1, format = SAMPLEFORMAT_UINT, samples = 1, planes = PLANARCONFIG_CONTIG;
    TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &heights.nx);
    TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &heights.ny);
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_PLANARCONFIG, &planes);
    check_sides(name, heights.nx, heights.ny);
    if (bits % 8 != 0) fail(name + ": samples of " + std::to_string(bits) + " bits are not heights");
    read_places(tiff.get(), heights, places);
    if (samples > 1) heights.notes.push_back("it has " + std::to_string(samples) + " values per sample; the first is taken");
    heights.rows.resize(std::size_t{heights.nx} * heights.ny);
    const std::size_t pixel = std::size_t{bits} / 8 * (planes == PLANARCONFIG_CONTIG ? samples : 1);
    if (TIFFIsTiled(tiff.get())) {
        std::uint32_t width = 0, length = 0;
        TIFFGetField(tiff.get(), TIFFTAG_TILEWIDTH, &width);
        TIFFGetField(tiff.get(), TIFFTAG_TILELENGTH, &length);
        const tmsize_t bytes = TIFFTileSize(tiff.get());
        if (width < 1 || length < 1 || bytes < 1 || static_cast<std::size_t>(bytes) < pixel * width * length ||
            bytes > (tmsize_t{1} << 30))
            fail(name + ": damaged tiles");
        std::vector<std::uint8_t> tile(static_cast<std::size_t>(bytes));
        for (std::uint32_t y = 0; y < heights.ny; y += length)
            for (std::uint32_t x = 0; x < heights.nx; x += width) {
                if (TIFFReadTile(tiff.get(), tile.data(), x, y, 0, 0) < 0) fail(name + ": a tile cannot be read");
                for (std::uint32_t j = 0; j < length && y + j < heights.ny; ++j)
                    put(heights, places, x, y + j, width, &tile[j * width * pixel], bits, format, pixel, name);
            }
        return heights;
    }
    const tmsize_t bytes = TIFFScanlineSize(tiff.get());
    if (bytes < 1 || static_cast<std::size_t>(bytes) < pixel * heights.nx) fail(name + ": damaged rows");
    std::vector<std::uint8_t> row(static_cast<std::size_t>(bytes));
    for (std::uint32_t y = 0; y < heights.ny; ++y) {
        if (TIFFReadScanline(tiff.get(), row.data(), y, 0) < 0) fail(name + ": row " + std::to_string(y) + " cannot be read");
        put(heights, places, 0, y, heights.nx, row.data(), bits, format, pixel, name);
    }
    return heights;
}

/// Degrees become metres at the middle of the map: an equirectangular projection, right for small maps.
void to_metres(Heights& heights, const Places& places) {
    if (!heights.has_cells) {
        heights.notes.emplace_back("it does not say how large its cells are: 1 m");
        return;
    }
    constexpr double along_meridian = 111132, along_equator = 111320; // of a degree [m]
    if (!places.degrees && heights.dx >= 0.02) return;
    const double middle = heights.south + heights.ny * heights.dy / 2;
    heights.notes.push_back("its cells of " + std::to_string(heights.dx) + " degrees are taken as metres at latitude " +
                            std::to_string(middle));
    heights.dx *= along_equator * std::cos(middle * std::numbers::pi / 180);
    heights.dy *= along_meridian;
    heights.west = heights.south = 0;
}

} // namespace

Heights read_tiff(const std::string& name) {
    Places places;
    Heights heights = read_all(name, places);
    to_metres(heights, places);
    return heights;
}

} // namespace import_map
