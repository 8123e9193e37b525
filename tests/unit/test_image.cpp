// engine/image: PNG, r16, NPY and ASC maps, their errors, and resampling.
#include "engine/image/map.hpp"
#include "engine/image/plausible.hpp"
#include "tests/unit/level_text.hpp"
#include "tests/unit/map_files.hpp"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <numeric>
#include <random>

using namespace wadi;
using namespace level_text;
using namespace map_files;

namespace {

const std::vector<float> VALUES = {1.5f, -2, 3, 4, 5, 6}; // 3 columns, 2 rows

const std::string ASC_HEADER = "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 5400000\ncellsize 30\n";
Bytes asc(const std::string& header, const std::string& values) {
    const std::string text = header + values;
    return {text.begin(), text.end()};
}

} // namespace

TEST_CASE("image: 16-bit PNG, north row first in the file, south row first in the map") {
    const auto map = decode_png(png16(3, 2, {0, 1, 2, 65535, 32768, 256}), "a.png");
    REQUIRE_MESSAGE(map, message(map));
    CHECK(map->nx == 3);
    CHECK(map->ny == 2);
    CHECK(map->integer);
    const std::vector<float> expected = {1.0f, 32768.0f / 65535, 256.0f / 65535, 0.0f, 1.0f / 65535, 2.0f / 65535};
    CHECK(map->values == expected);
}

TEST_CASE("image: 8-bit PNG, grey and colour") {
    const auto grey = decode_png(png(2, 1, 8, 0, {0, 255}), "a.png");
    REQUIRE_MESSAGE(grey, message(grey));
    CHECK(grey->values == std::vector<float>{0, 1});
    const auto color = decode_png(png(2, 1, 8, 2, {51, 51, 51, 255, 255, 255}), "a.png");
    REQUIRE_MESSAGE(color, message(color));
    CHECK(color->values[0] == doctest::Approx(0.2));
    CHECK(color->values[1] == doctest::Approx(1));
}

TEST_CASE("image: damaged PNG files") {
    const Bytes good = png16(3, 2, {0, 1, 2, 65535, 32768, 256});
    for (std::size_t size = 0; size < good.size(); ++size) {
        const auto map = decode_png(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)), "cut.png");
        REQUIRE_MESSAGE(!map, "cut to " << size << " bytes");
        CHECK(says(message(map), "cut.png"));
        CHECK((says(message(map), "truncated") || says(message(map), "not a PNG")));
    }
    for (std::size_t at = 8; at < good.size(); ++at) {
        Bytes bad = good;
        bad[at] ^= 0x10;
        CHECK_MESSAGE(!decode_png(bad, "bad.png"), "byte " << at);
    }
    CHECK(says(message(decode_png(png(40000, 2, 16, 0, {}), "a.png")), "40000 x 2 is outside 1 ... 16384"));
    CHECK(says(message(decode_png(png(0, 2, 16, 0, {}), "a.png")), "0 x 2"));
    // A header that asks for 512 MB in a file of 80 bytes.
    CHECK(says(message(decode_png(png(16384, 16384, 16, 0, {}), "a.png")), "cannot hold"));
    CHECK(says(message(decode_png(png(8, 8, 16, 0, {1, 2, 3, 4, 5, 6, 7, 8}), "a.png")), "cannot be decoded"));
}

TEST_CASE("image: a PNG's data may not go far beyond its header's pixels") {
    const auto bomb = decode_png(png_of_zeros(8, 8, 8, 0, 20'000'000), "bomb.png");
    CHECK(says(message(bomb), "bomb.png: damaged, its data holds more than the pixels of its header"));
    CHECK(decode_png(png_of_zeros(8, 8, 8, 0, 200), "padded.png")); // as some writers leave the end
}

TEST_CASE("image: a PNG counts with all its channels") {
    const auto padded = [](Bytes file, std::size_t padding) {
        Bytes chunk;
        append_chunk(chunk, "tEXt", Bytes(padding));
        file.insert(file.begin() + 33, chunk.begin(), chunk.end()); // behind IHDR
        return file;
    };
    // Bytes for one channel of a header's pixels, but not for four.
    const Bytes few = png(16384, 16384, 16, 6, {});
    CHECK(says(message(decode_png(padded(few, 600'000), "a.png")), "cannot hold"));
    // For all of them, but decoded they pass what the decoder counts with.
    CHECK(says(message(decode_png(padded(few, 2'200'000), "a.png")), "more than the 2147483647 bytes"));
    const auto zeros = decode_png(png_of_zeros(300, 200, 16, 6), "a.png"); // negative control
    REQUIRE_MESSAGE(zeros, message(zeros));
    CHECK(zeros->values == std::vector<float>(60000));
}

TEST_CASE("image: r16") {
    const auto map = decode_r16(words({0, 65535, 1, 2}, false), "a.r16", std::nullopt);
    REQUIRE_MESSAGE(map, message(map));
    CHECK(map->integer);
    CHECK(map->values == std::vector<float>{1.0f / 65535, 2.0f / 65535, 0, 1});
    const auto wide = decode_r16(words({1, 2, 3, 4, 5, 6}, false), "a.r16", std::pair{3, 2});
    REQUIRE_MESSAGE(wide, message(wide));
    CHECK(wide->nx == 3);
    CHECK(wide->values[0] == 4.0f / 65535);

    CHECK(says(message(decode_r16(words({1, 2, 3}, false), "a.r16", std::nullopt)), "6 bytes is not a square map"));
    CHECK(says(message(decode_r16({}, "a.r16", std::nullopt)), "0 bytes is not a square map"));
    CHECK(says(message(decode_r16({1, 2, 3}, "a.r16", std::nullopt)), "not a square map"));
    CHECK(says(message(decode_r16(words({1, 2, 3}, false), "a.r16", std::pair{2, 2})), "truncated, 6 bytes where 2 x 2"));
    CHECK(says(message(decode_r16(words({1, 2, 3}, false), "a.r16", std::pair{1, 1})), "wrong size, 6 bytes"));
    CHECK(says(message(decode_r16(words({1}, false), "a.r16", std::pair{0, 1})), "outside 1 ... 16384"));
    CHECK(says(message(decode_r16(words({1}, false), "a.r16", std::pair{20000, 1})), "outside 1 ... 16384"));
}

TEST_CASE("image: NPY of floats and doubles, format 1 and 2") {
    for (const int version : {1, 2}) {
        const auto map = decode_npy(npy(dictionary("<f4", "(2, 3)"), VALUES, version), "a.npy");
        REQUIRE_MESSAGE(map, message(map));
        CHECK(map->nx == 3);
        CHECK(map->ny == 2);
        CHECK(!map->integer);
        CHECK(map->values == VALUES);
    }
    const std::vector<double> doubles = {0.1, 2};
    const auto map = decode_npy(npy(dictionary("<f8", "(1, 2)"), doubles), "a.npy");
    REQUIRE_MESSAGE(map, message(map));
    CHECK(map->values == std::vector<float>{0.1f, 2});
}

TEST_CASE("image: damaged NPY files") {
    const Bytes good = npy(dictionary("<f4", "(2, 3)"), VALUES);
    for (std::size_t size = 0; size < good.size(); ++size)
        CHECK_MESSAGE(!decode_npy(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)), "cut.npy"), size);
    Bytes longer = good;
    longer.push_back(0);
    CHECK(says(message(decode_npy(longer, "a.npy")), "wrong size, 25 bytes of data where 3 x 2 values take 24"));
    CHECK(says(message(decode_npy(Bytes(good.begin(), good.end() - 1), "a.npy")), "truncated, 23 bytes"));

    const auto refuses = [](const std::string& type, const std::string& shape, const std::string& order,
                            const std::string& part) {
        const std::string text = message(decode_npy(npy(dictionary(type, shape, order), VALUES), "a.npy"));
        CHECK_MESSAGE(says(text, part), text);
    };
    refuses("<i4", "(2, 3)", "False", "element type '<i4' is not read, only '<f4' and '<f8'");
    refuses(">f4", "(2, 3)", "False", "'>f4'");
    refuses("<f4", "(2, 3)", "True", "C order");
    refuses("<f4", "(6,)", "False", "shape");
    refuses("<f4", "(1, 2, 3)", "False", "shape");
    refuses("<f4", "(2, x)", "False", "shape");
    refuses("<f4", "(-2, -3)", "False", "outside 1 ... 16384");
    refuses("<f4", "(99999999999999999999, 3)", "False", "shape");
    refuses("<f4", "(4611686018427387904, 4)", "False", "outside 1 ... 16384"); // the product overflows to 0
    refuses("<f4", "(16384, 16384)", "False", "truncated");
    CHECK(says(message(decode_npy(npy(dictionary("<f4", "(2, 3)"), VALUES, 3), "a.npy")), "version 3"));
    CHECK(says(message(decode_npy(npy("{}", VALUES), "a.npy")), "element type"));
}

TEST_CASE("image: the first NaN, infinity or overflow of an NPY is named") {
    std::vector<float> values = VALUES;
    values[4] = std::numeric_limits<float>::quiet_NaN();
    values[5] = std::numeric_limits<float>::infinity();
    CHECK(says(message(decode_npy(npy(dictionary("<f4", "(2, 3)"), values), "a.npy")), "column 1, row 1 is NaN"));
    values[4] = 0;
    CHECK(says(message(decode_npy(npy(dictionary("<f4", "(2, 3)"), values), "a.npy")), "column 2, row 1 is infinite"));
    CHECK(says(message(decode_npy(npy(dictionary("<f8", "(1, 1)"), std::vector<double>{1e300}), "a.npy")), "too large"));
}

TEST_CASE("image: Esri ASCII grids") {
    const auto map = decode_asc(asc(ASC_HEADER, "4 5 6\n1.5 -2 3e0\n"), "a.asc");
    REQUIRE_MESSAGE(map, message(map));
    CHECK(map->nx == 3);
    CHECK(map->ny == 2);
    CHECK(!map->integer);
    CHECK(map->cell_size == 30);
    CHECK(map->filled == 0);
    CHECK(map->values == VALUES);
    // Any case, other order, corners or centres, line ends of any kind and place, signs.
    const auto odd = decode_asc(
        asc("NROWS 2\r\nNCols\t3\r\nYLLCENTER +15\r\nxllCenter -5e5\r\nCellSize 0.5\r\n", "4 5\r\n6 +1.5 -2.0\r\n\r\n3"),
        "a.asc");
    REQUIRE_MESSAGE(odd, message(odd));
    CHECK(odd->values == VALUES);
    CHECK(odd->cell_size == 0.5);
}

TEST_CASE("image: cells of an ASCII grid without data take the nearest height") {
    const auto map = decode_asc(asc(ASC_HEADER + "NODATA_value -1\n", "4 -1 -1\n-1.0 -1 9\n"), "a.asc");
    REQUIRE_MESSAGE(map, message(map));
    CHECK(map->filled == 4);
    CHECK(map->values[0] == 4); // south-west
    CHECK(map->values[2] == 9);
    CHECK(map->values[5] == 9);
    for (const float value : map->values) CHECK((value == 4 || value == 9));
    CHECK(decode_asc(asc(ASC_HEADER + "nodata_value nan\n", "4 nan 6 NaN 8 9"), "a.asc")->filled == 2);
    CHECK(decode_asc(asc(ASC_HEADER, "4 -9999 6 7 8 9"), "a.asc")->filled == 1); // the format's own value
    CHECK(decode_asc(asc(ASC_HEADER + "NODATA_value 0\n", "4 -999 6 7 8 9"), "a.asc")->filled == 0);
    CHECK(says(message(decode_asc(asc(ASC_HEADER, "-9999 -9999 -9999\n-9999 -9999 -9999\n"), "a.asc")),
               "every value is NODATA_value"));
}

TEST_CASE("image: ASCII grids as programs write them") {
    const auto loads = [](const std::string& header, const std::string& values) {
        const auto map = decode_asc(asc(header, values), "a.asc");
        REQUIRE_MESSAGE(map, message(map));
        return *map;
    };
    const std::string six = "4 5 6\n1.5 -2 3e0\n", origin = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\n";
    CHECK(loads("\xef\xbb\xbf" + ASC_HEADER, six).values == VALUES);
    CHECK(loads("# a comment\n// another 7 8\n" + ASC_HEADER + "# of the header\n", six).values == VALUES);
    const Map square = loads(origin + "dx 2\ndy 2\n", six);
    CHECK(square.cell_size == 2);
    CHECK(square.notes.empty());
    CHECK(square.values == VALUES);
    const Map oblong = loads(origin + "dx 1\ndy 3\n", "9 9 9\n0 0 0");
    CHECK(oblong.ny == 6);
    CHECK(oblong.values.front() == 0);
    CHECK(oblong.values.back() == 9);
    REQUIRE(oblong.notes.size() == 1);
    CHECK(oblong.notes[0] == "cells of 1 by 3 m: its 2 rows are resampled to 6");
    for (const char* nodata : {"null", "NaN", "-", "-3.4028234663852886e+38", "NODATA"}) {
        const std::string value = std::string(nodata) == "-3.4028234663852886e+38" ? "-3.4028235e+38" : nodata;
        CHECK_MESSAGE(loads(ASC_HEADER + "NODATA_value " + nodata + "\n", "4 " + value + " 6 7 8 9").filled == 1, nodata);
    }
    CHECK(loads(ASC_HEADER, "null 5 6 7 8 9").filled == 1);
    CHECK(loads(ASC_HEADER, "1 2 3\n4 nan 6").filled == 1);
    const Map other = loads(ASC_HEADER + "NODATA_value -32768\n", "4 -9999 6 7 8 9");
    CHECK(other.filled == 1);
    REQUIRE(other.notes.size() == 1);
    CHECK(other.notes[0] == "1 cells hold -9999, which is no ground beside 4 ... 9 m: taken for holes");
    // A trench that goes down there is ground.
    CHECK(loads(ASC_HEADER + "NODATA_value -32768\n", "-9500 -9999 -9000 -5000 -2000 0").filled == 0);
}

namespace {
/// 32 x 32 of a smooth hill.
std::vector<double> hill(double most) {
    std::vector<double> values;
    for (int j = 0; j < 32; ++j)
        for (int i = 0; i < 32; ++i) values.push_back(most * std::sin(0.09 * (i + 1)) * std::sin(0.09 * (j + 1)));
    return values;
}
Bytes bytes_of_16(const std::vector<double>& values, bool swapped) {
    std::vector<std::uint16_t> words;
    for (const double value : values) words.push_back(static_cast<std::uint16_t>(static_cast<std::int32_t>(value)));
    return map_files::words(words, swapped);
}
Bytes bytes_of_32(const std::vector<double>& values, bool swapped) {
    Bytes bytes;
    for (const double value : values) {
        const auto number = static_cast<float>(value);
        std::uint8_t each[4];
        std::memcpy(each, &number, 4);
        if (swapped) std::reverse(each, each + 4);
        bytes.insert(bytes.end(), each, each + 4);
    }
    return bytes;
}
bool noted(const Map& map, const char* part) {
    for (const std::string& note : map.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}
} // namespace

TEST_CASE("image: raw samples of 8, 16 and 32 bits, in either order, signed or not, by size and smoothness") {
    Bytes eight;
    for (const double value : hill(250)) eight.push_back(static_cast<std::uint8_t>(value));
    const auto of_8 = decode_raw(eight, "a.raw", std::nullopt);
    REQUIRE_MESSAGE(of_8, message(of_8));
    CHECK(of_8->nx == 32);
    CHECK(of_8->integer);
    CHECK(noted(*of_8, "read as 32 x 32 samples of 8 bits, by its 1024 bytes"));
    const auto of_16 = decode_raw(bytes_of_16(hill(60000), false), "a.raw", std::nullopt);
    REQUIRE_MESSAGE(of_16, message(of_16));
    CHECK(of_16->notes.empty());
    const auto swapped = decode_r16(bytes_of_16(hill(60000), true), "a.r16", std::nullopt);
    REQUIRE_MESSAGE(swapped, message(swapped));
    CHECK(noted(*swapped, "its bytes are swapped"));
    CHECK(swapped->values == of_16->values);
    std::vector<double> both = hill(3000);
    for (double& value : both) value -= 900;
    const auto is_signed = decode_r16(bytes_of_16(both, false), "a.r16", std::nullopt);
    REQUIRE_MESSAGE(is_signed, message(is_signed));
    CHECK(noted(*is_signed, "its 16-bit samples are signed"));
    std::vector<double> ramp; // whose low bytes are all 0: as smooth in either order
    for (int n = 0; n < 65 * 65; ++n) ramp.push_back(std::min(65535, n % 65 * 1024));
    CHECK(decode_r16(bytes_of_16(ramp, false), "a.r16", std::nullopt)->notes.empty());
    std::vector<double> mask(1024);
    for (std::size_t n = 0; n < 512; ++n) mask[n] = 65535;
    CHECK(decode_r16(bytes_of_16(mask, false), "a.r16", std::nullopt)->notes.empty());
    for (const bool turned : {false, true}) {
        const auto floats = decode_raw(bytes_of_32(hill(812.5), turned), "a.raw", std::nullopt);
        REQUIRE_MESSAGE(floats, message(floats));
        CHECK(!floats->integer);
        CHECK(floats->nx == 32);
        CHECK(floats->values.back() == static_cast<float>(hill(812.5)[31]));
        CHECK(noted(*floats, "32 bits, floats"));
        CHECK(noted(*floats, "swapped") == turned);
    }
    std::vector<double> holes = hill(10);
    holes[40] = -9999;
    holes[50] = static_cast<double>(std::numeric_limits<float>::lowest());
    const auto r32 = decode_r32(bytes_of_32(holes, false), "a.r32", std::nullopt);
    REQUIRE_MESSAGE(r32, message(r32));
    CHECK(r32->filled == 2);
    CHECK(says(message(decode_raw({1, 2, 3}, "a.raw", std::nullopt)), "3 bytes is not a square map"));
    CHECK(decode_raw({1, 2, 3, 4, 5, 6}, "a.raw", std::pair{3, 2})->values[0] == 4.0f / 255);
    CHECK(says(message(decode_raw({1, 2, 3, 4, 5, 6}, "a.raw", std::pair{2, 2})), "truncated, 6 bytes where 2 x 2 16-bit"));
}

TEST_CASE("image: whatever raw bytes hold, a map that is read holds numbers") {
    std::mt19937 random(11);
    int read = 0;
    for (int trial = 0; trial < 600; ++trial) {
        Bytes bytes(std::size_t{4} * (1 + random() % 20) * (1 + random() % 20));
        const unsigned mask = trial % 3 == 0 ? 0xffU : trial % 3 == 1 ? 0x7fU : 0x43U;
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() & mask);
        for (const auto& map : {decode_raw(bytes, "a.raw", std::nullopt), decode_r32(bytes, "a.r32", std::nullopt),
                                decode_r16(bytes, "a.r16", std::nullopt), decode_hgt(bytes, "N60E007.hgt")}) {
            if (!map) continue;
            ++read;
            REQUIRE(std::all_of(map->values.begin(), map->values.end(), [](float value) { return std::isfinite(value); }));
        }
    }
    CHECK(read > 50);
}

TEST_CASE("image: tiles of SRTM") {
    std::vector<double> heights;
    for (int j = 0; j < 33; ++j)
        for (int i = 0; i < 33; ++i) heights.push_back(100 + 10 * i - 5 * j); // rows from the north
    heights[5] = -32768;
    const auto tile = decode_hgt(bytes_of_16(heights, true), "some/N46E007.hgt");
    REQUIRE_MESSAGE(tile, message(tile));
    CHECK(tile->nx == 32);
    CHECK(tile->ny == 46); // a degree of latitude over one of longitude at 46.5 degrees
    CHECK(tile->cell_size == doctest::Approx(111320 * std::cos(46.5 * 3.14159265358979 / 180) / 32));
    CHECK(tile->filled == 1);
    CHECK(tile->values[0] == doctest::Approx(100 + 5 - 5 * 32 + 5 * 32 / 46.0 / 2));
    CHECK(noted(*tile, "at latitude 46: 32 x 46 square cells"));
    CHECK(noted(*decode_hgt(bytes_of_16(heights, true), "tile.hgt"), "its name says no latitude"));
    CHECK(says(message(decode_hgt({1, 2, 3}, "a.hgt")), "not a square map"));
    CHECK(says(message(decode_hgt({1, 2}, "a.hgt")), "one sample is no tile"));
}

TEST_CASE("image: odd ground is noted with numbers; ground as it is, is not") {
    const auto notes_of = [](const std::vector<double>& values, bool integer = false) {
        Map map;
        map.nx = map.ny = 32;
        map.integer = integer;
        for (const double value : values) map.values.push_back(static_cast<float>(value));
        note_odd_ground(map);
        return map;
    };
    CHECK(notes_of(hill(300)).notes.empty());
    std::vector<double> pit = hill(300);
    pit[33] = -7000;
    CHECK(noted(notes_of(pit), "its value -7000 in column 2, row 2 from the south lies"));
    std::mt19937 random(3);
    std::vector<double> noise(1024);
    for (double& value : noise) value = static_cast<double>(random() % 65536);
    CHECK(noted(notes_of(noise), "as in noise"));
    std::vector<double> terraces = hill(200);
    for (double& value : terraces) value = std::floor(value / 12) * 12;
    CHECK(noted(notes_of(terraces), "17 different values alone: terraces of 12 m"));
    std::vector<double> sea = hill(300);
    for (std::size_t n = 0; n < 300; ++n) sea[n] = 0;
    CHECK(noted(notes_of(sea), "29 % of it is exactly 0"));
}

TEST_CASE("image: samples at corners of cells are read between them") {
    Map map;
    map.nx = 5;
    map.ny = 3;
    map.corners = true;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 5; ++i) map.values.push_back(static_cast<float>(i + 10 * j));
    CHECK(resample(map, 4, 2) == std::vector<float>{5.5f, 6.5f, 7.5f, 8.5f, 15.5f, 16.5f, 17.5f, 18.5f});
    CHECK(resample(map, 2, 1) == std::vector<float>{11, 13});
    CHECK(resample(map, 8, 4)[0] == 0.25f + 2.5f);
}

TEST_CASE("image: damaged ASCII grids are refused with their line") {
    const auto refuses = [](const std::string& header, const std::string& values, const std::string& part) {
        const std::string text = message(decode_asc(asc(header, values), "a.asc"));
        CHECK_MESSAGE(says(text, "a.asc: line " + part), text);
    };
    const std::string six = "1 2 3\n4 5 6\n";
    refuses(ASC_HEADER, "1 2 3\n4 5", "7: the file ends after 5 values where ncols x nrows, 3 x 2, are 6");
    refuses(ASC_HEADER, "", "6: the file ends after 0 values");
    refuses(ASC_HEADER, six + "\n7", "9: more values than ncols x nrows, 3 x 2");
    refuses(ASC_HEADER, "1 2 inf\n4 5 6", "6: the value in column 3 of row 1 is infinite");
    refuses(ASC_HEADER, "1 2 3\n4 1e39 6", "7: the value in column 2 of row 2 is infinite or too large");
    refuses(ASC_HEADER, "1 2 3\n4 5,0 6", "7: the value in column 2 of row 2: \"5,0\" has a decimal comma");
    refuses(ASC_HEADER, "1 2 3\n4 5x 6", "7: the value in column 2 of row 2: \"5x\" is not a number");
    refuses("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0,5\n", six, "5: cellsize: \"0,5\" has a decimal comma");
    refuses("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\n", six, "5: the header ends without cellsize");
    refuses("nrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n", six, "5: the header ends without ncols");
    refuses("ncols 3\nnrows 2\nxllcorner 0\ncellsize 1\n", six, "5: the header ends without yllcorner or yllcenter");
    refuses(ASC_HEADER + "ncols 3\n", six, "6: ncols is given twice");
    refuses("ncols 3\nnrows 2\nxllcorner 0\nxllcenter 0\n", six, "4: xllcenter is given twice");
    refuses("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\nwidth 1\n", six, "5: \"width\" is no key of an Esri ASCII grid");
    refuses("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\ndx 1\n", six, "6: dx is given twice");
    refuses("ncols 3.5\n", six, "1: ncols: 3.5 is not a whole number in 1 ... 16384");
    refuses("ncols 3\nnrows 0\n", six, "2: nrows: 0 is not a whole number");
    refuses("ncols 16385\n", six, "1: ncols: 16385");
    refuses("ncols many\n", six, "1: ncols: \"many\" is not a number");
    refuses("ncols", "", "1: ncols: \"\" is not a number");
    refuses("ncols 3\nnrows 2\nxllcorner nan\n", six, "3: xllcorner: \"nan\" is not a number");
    refuses("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n", six, "5: cellsize: 0 is not above 0");
    refuses("ncols 16384\nnrows 16384\nxllcorner 0\nyllcorner 0\ncellsize 1\n", six, "8: the file ends after 6 values");
    refuses("", "", "1: the header ends without ncols");
    refuses("P2 3 2", "", "1: \"P2\" is no key");
}

TEST_CASE("image: files by the ending of their name") {
    const Folder folder;
    const auto read_any = [](const std::string& path, std::optional<std::pair<int, int>> size) {
        FileRoom room(1000);
        return read_map(path, {size}, files_in("", FilesFrom::anywhere), room);
    };
    CHECK(read_any(folder.write("a.PNG", png16(1, 1, {7})), std::nullopt));
    CHECK(read_any(folder.write("a.r16", words({7}, false)), std::nullopt));
    CHECK(read_any(folder.write("a.raw", words({7, 8}, false)), std::pair{2, 1}));
    CHECK(read_any(folder.write("a.Asc", asc(ASC_HEADER, "1 2 3 4 5 6")), std::nullopt));
    CHECK(read_any(folder.write("a.npy", npy(dictionary("<f4", "(2, 3)"), VALUES)), std::nullopt));

    CHECK(read_any(folder.file("none.png"), std::nullopt).status().code == Code::not_found);
    CHECK(says(message(read_any(folder.file("none.png"), std::nullopt)), "none.png: no such file"));
    CHECK(says(message(read_any(folder.file("a.jpg"), std::nullopt)), "end in .png, .r16, .r32, .raw, .hgt, .npy or .asc"));
    CHECK(says(message(read_any(folder.file("a.PNG"), std::pair{1, 1})), "only .r16, .r32 and .raw maps are given a size"));
    std::filesystem::create_directory(folder.file("folder.png"));
    CHECK(says(message(read_any(folder.file("folder.png"), std::nullopt)), "not a regular file"));
    CHECK(says(message(read_file_bytes(folder.file("a.npy"), 10)), "more than the largest accepted file, 10 bytes"));
}

TEST_CASE("image: resampling is exact at equal size, bilinear on finer grids, a mean on coarser ones") {
    Map map;
    map.nx = 3;
    map.ny = 2;
    map.values = VALUES;
    CHECK(resample(map, 3, 2) == VALUES);

    Map slope; // a plane stays a plane between the outer sample centres
    slope.nx = 8;
    slope.ny = 4;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 8; ++i) slope.values.push_back(static_cast<float>((i + 0.5) / 8 + 10 * (j + 0.5) / 4));
    for (const auto& [nx, ny] : {std::pair{16, 12}, std::pair{5, 3}, std::pair{4, 4}}) {
        const auto values = resample(slope, nx, ny);
        REQUIRE(values.size() == static_cast<std::size_t>(nx * ny));
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                const double x = (i + 0.5) / nx;
                const double y = (j + 0.5) / ny;
                const double a = 0.25 / nx, b = 0.25 / ny; // to the places of a cell that has two
                if (x - a < 0.5 / 8 || x + a > 7.5 / 8 || y - b < 0.5 / 4 || y + b > 3.5 / 4) continue;
                CHECK(values[static_cast<std::size_t>(j * nx + i)] == doctest::Approx(x + 10 * y).epsilon(1e-6));
            }
    }
    const auto single = resample(map, 1, 1);
    CHECK(single[0] == doctest::Approx(std::accumulate(VALUES.begin(), VALUES.end(), 0.0F) / 6));
    Map spikes; // every third sample of a row: none falls between the cells, none counts twice
    spikes.nx = 12;
    spikes.ny = 1;
    for (int i = 0; i < 12; ++i) spikes.values.push_back(i % 3 == 1 ? 3.0F : 0.0F);
    for (const int cells : {1, 2, 4})
        for (const float value : resample(spikes, cells, 1)) CHECK(value == doctest::Approx(1));
}

TEST_CASE("image: random damage never crashes a reader") {
    std::mt19937 random(1);
    const std::vector<Bytes> files = {png16(3, 2, {0, 1, 2, 3, 4, 5}), words({1, 2, 3, 4}, false),
                                      npy(dictionary("<f4", "(2, 3)"), VALUES), asc(ASC_HEADER, "1 2 3\n4 5 6\n")};
    int read = 0;
    for (int round = 0; round < 3000; ++round) {
        Bytes bytes = files[static_cast<std::size_t>(round) % files.size()];
        for (int flips = 1 + static_cast<int>(random() % 4); flips > 0; --flips)
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
        for (const auto& map :
             {decode_png(bytes, "f"), decode_r16(bytes, "f", std::nullopt), decode_npy(bytes, "f"), decode_asc(bytes, "f")})
            if (map) {
                ++read;
                CHECK(map->values.size() == static_cast<std::size_t>(map->nx) * static_cast<std::size_t>(map->ny));
            }
    }
    CHECK(read > 0);
}
