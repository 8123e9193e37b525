// Height maps read from files: PNG, RAW of 8, 16 and 32 bits, HGT, NPY and Esri ASCII grids. Row 0 is the south side, as in every
// field of the engine.
#pragma once
#include "engine/compute/status.hpp"
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wadi {

/// Largest width and height of a map [cells]: the largest grid.
inline constexpr int MAP_LIMIT = 16384;

struct Map {
    int nx = 0;
    int ny = 0;
    bool integer = false;    // values are grey 0 ... 1; otherwise as stored (NPY, ASC, HGT, floats)
    bool corners = false;    // samples lie at the corners of cells, the outer ones on the rim, and not in their middles
    double cell_size = 0;    // as the file says (ASC, HGT) [m]; 0 where the format does not
    std::int64_t filled = 0; // cells of no known height, which took that of the nearest known one
    std::vector<bool> holes; // which they are, as values; empty where there are none
    std::optional<std::array<double, 2>> origin; // of the south-west corner on the map that the file was cut from (ASC) [m]
    std::vector<std::string> notes;              // what was guessed, and what looks odd
    std::vector<float> values;                   // row-major nx * ny, row 0 in the south
};

/// What the pixels of a PNG hold.
enum class Packing : std::uint8_t {
    grey,      // brightness
    terrarium, // metres in red, green and blue: 256 r + g + b / 256 - 32768 (Mapzen, AWS terrain tiles)
    mapbox     // 0.1 (65536 r + 256 g + b) - 10000
};

/// How a file is read beside what it says itself.
struct MapForm {
    std::optional<std::pair<int, int>> size; // nx, ny of a raw file, square when absent; absent for the other formats
    Packing packing = Packing::grey;         // of a PNG; grey for the other formats
    bool flip_x = false, flip_y = false;     // east for west, north for south
};

/// What becomes of holes.
enum class Holes : std::uint8_t {
    filled,  // the nearest height, as the readers leave them
    outside, // those that reach the map's rim lie lower than the ground beside them: what flows there is gone; others are filled
    wall,    // as high as the highest ground
    pit      // lower than the lowest
};

/// Values that the files of one level may hold together. Each file takes its own ahead of being decoded, so that small files
/// cannot ask for much memory and time.
class FileRoom {
  public:
    /// What a file asked for: values, and the map's size where it is one.
    struct Asked {
        std::int64_t values = 0;
        int nx = 0, ny = 0;
    };

    explicit FileRoom(std::int64_t values) : left_(values) {}
    /// One that hears what a file asks for and then ends its reading: with not_ready nothing is decoded.
    static FileRoom that_listens(std::int64_t values);
    void add(std::int64_t values) { left_ += values; }
    std::int64_t left() const { return left_; }
    /// Errors: bad_file, which names the file; nothing is taken then.
    Status take(const Asked& asked, const std::string& name);
    /// Of the last file.
    const Asked& asked() const { return asked_; }

  private:
    std::int64_t left_;
    bool listens_ = false;
    Asked asked_;
};

/// The whole of a file of at most `limit` bytes, by the name that a level gives it. Errors: not_found, bad_file.
using FileReader = std::function<Result<std::vector<std::uint8_t>>(const std::string& name, std::uint64_t limit)>;

enum class FilesFrom : std::uint8_t {
    below,   // the folder alone, links followed
    anywhere // that the process can read
};
/// Files on disk, relative to a folder. A file elsewhere than `from` says is bad_file, there or not.
FileReader files_in(const std::string& folder, FilesFrom from);

/// ok, or bad_file for a name that leads out of the folder of who names it: a path from the root or a drive on, or one with "..".
Status check_below(const std::string& name);

/// Reads a map by the ending of its name: .png, .raw, .r16, .r32, .hgt, .npy and .asc. Errors: not_found, bad_file, bad_argument
/// (a form that the format does not have); the message names the file.
Result<Map> read_map(const std::string& path, const MapForm& form, const FileReader& files, FileRoom& room);

/// What a map's file asks for: its bytes are read, but no more than its header is looked at.
struct MapCost {
    std::uint64_t file_bytes = 0;
    FileRoom::Asked asked;
};
/// Errors: those of read_map() that the header shows.
Result<MapCost> cost_of_map(const std::string& path, const MapForm& form, const FileReader& files, std::int64_t most_values);

/// The same from bytes already read; `name` is used in messages. `room`: null = as large as a map may be.
/// PNG with 8 or 16 bits: grey, or the luma of a colour image; alpha is ignored. The file's first row is the north.
Result<Map> decode_png(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room = nullptr,
                       Packing packing = Packing::grey);
/// 16-bit samples without a header: little-endian and unsigned, unless the map is far smoother otherwise, which a note says. The
/// file's first row is the north.
Result<Map> decode_r16(const std::vector<std::uint8_t>& bytes, const std::string& name, std::optional<std::pair<int, int>> size,
                       FileRoom* room = nullptr);
/// Samples without a header of 8 or 16 bits, or floats of 32, by what its size leaves; a note says which, unless 16.
Result<Map> decode_raw(const std::vector<std::uint8_t>& bytes, const std::string& name, std::optional<std::pair<int, int>> size,
                       FileRoom* room = nullptr);
/// Floats of 32 bits without a header, in the order of bytes that makes sense.
Result<Map> decode_r32(const std::vector<std::uint8_t>& bytes, const std::string& name, std::optional<std::pair<int, int>> size,
                       FileRoom* room = nullptr);
/// A tile of SRTM: metres in big-endian signed 16 bits at the corners of a square degree, -32768 for holes. Its name says where
/// it lies, N46E007.hgt, and so how wide its cells are: resampled to square ones.
Result<Map> decode_hgt(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room = nullptr);
/// NumPy format 1 and 2, little-endian float32 or float64, C order, shape (ny, nx). The file's first row is the south.
Result<Map> decode_npy(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room = nullptr);

/// Esri ASCII grid; one whose cells are not square is resampled. The file's first row is the north.
Result<Map> decode_asc(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room = nullptr);

/// Bilinear samples at the cell centres of an nx * ny grid over the same rectangle; an exact copy when the sizes are equal and
/// the map's samples lie in the middles of cells.
std::vector<float> resample(const Map& map, int nx, int ny);

/// Makes a map of nx * ny samples in the middles of cells of it, as resample() does; a sample is a hole where the nearest one
/// was.
void resample_map(Map& map, int nx, int ny);

/// Gives holes their heights, by the relief of the map and its cells' width [m].
void raise_holes(Map& map, Holes how, double cell);

/// The whole of a regular file of at most `limit` bytes.
Result<std::vector<std::uint8_t>> read_file_bytes(const std::string& path, std::uint64_t limit);

/// ok, or why a map of this size is not accepted; takes its values from `room`, if there is one.
Status check_map_size(std::int64_t nx, std::int64_t ny, const std::string& name, FileRoom* room);

} // namespace wadi
