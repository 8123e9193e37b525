// Esri ASCII grids: a header of "key value" lines, then values in rows from the north, separated by blanks or line ends.
#include "engine/image/map.hpp"
#include "engine/image/parse_number.hpp"
#include "engine/image/plausible.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string_view>

namespace wadi {
namespace {

constexpr double NO_DATA = -9999; // where the header names no other

constexpr std::string_view BYTE_ORDER_MARK = "\xef\xbb\xbf"; // of text editors

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string lower_case(std::string_view word) {
    std::string text(word);
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

bool parse(std::string_view word, double& number) {
    if (word.starts_with('+')) word.remove_prefix(1);
    return parse_number(word, number);
}

/// Words that programs write for a cell without a value, in lower case.
bool is_hole(const std::string& word) {
    static const char* const words[] = {"null", "nodata", "no_data", "none", "na", "n/a", "nan", "-nan", "*", "-"};
    return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

/// Cuts a text into words and counts lines; what follows # or // to the end of a line is none.
class Words {
  public:
    explicit Words(std::string_view text) : rest_(text) {
        if (rest_.starts_with(BYTE_ORDER_MARK)) rest_.remove_prefix(BYTE_ORDER_MARK.size());
    }
    /// The next word, which stays the next one; empty at the end.
    std::string_view peek() {
        for (;;) {
            while (!rest_.empty() && is_blank(rest_.front())) {
                if (rest_.front() == '\n') ++line_;
                rest_.remove_prefix(1);
            }
            if (!rest_.starts_with('#') && !rest_.starts_with("//")) break;
            rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
        }
        std::size_t size = 0;
        while (size < rest_.size() && !is_blank(rest_[size])) ++size;
        return rest_.substr(0, size);
    }
    std::string_view next() {
        const std::string_view word = peek();
        rest_.remove_prefix(word.size());
        return word;
    }
    std::size_t bytes_left() const { return rest_.size(); }
    /// Of the last word.
    std::size_t line() const { return line_; }

  private:
    std::string_view rest_;
    std::size_t line_ = 1;
};

class AscReader {
  public:
    AscReader(std::string_view text, const std::string& name) : words_(text), name_(name) {}

    Result<Map> read(FileRoom* room) {
        Status status = read_header();
        if (status) status = check_map_size(map_.nx, map_.ny, name_, nullptr);
        if (status) status = find_square_rows();
        if (status && room != nullptr) status = room->take({values_in_all(), map_.nx, square_rows_}, name_);
        if (status) status = read_values();
        if (status) status = fill_holes(map_, name_);
        if (status) make_square();
        if (!status) return status;
        return std::move(map_);
    }

  private:
    enum Key : std::size_t { columns, rows, x_origin, y_origin, cell_size, cell_height, no_data, KEY_COUNT };

    Status refuse(const std::string& message) const {
        return error(Code::bad_file, name_ + ": line " + std::to_string(words_.line()) + ": " + message);
    }

    static Key key_of(const std::string& word) {
        if (word == "ncols") return columns;
        if (word == "nrows") return rows;
        if (word == "xllcorner" || word == "xllcenter") return x_origin;
        if (word == "yllcorner" || word == "yllcenter") return y_origin;
        if (word == "cellsize" || word == "dx") return cell_size;
        if (word == "dy") return cell_height;
        return word == "nodata_value" || word == "nodata" ? no_data : KEY_COUNT;
    }

    Status read_header() {
        bool given[KEY_COUNT] = {};
        double found[KEY_COUNT] = {0, 0, 0, 0, 0, 0, NO_DATA};
        for (double unused = 0; !words_.peek().empty() && !parse(words_.peek(), unused);) {
            if (given[cell_size] && is_hole(lower_case(words_.peek())) && lower_case(words_.peek()) != "nodata") break; // a value
            const std::string word(words_.next());
            const Key key = key_of(lower_case(word));
            if (key == KEY_COUNT)
                return refuse(
                    std::string("\"").append(word, 0, 40) +
                    "\" is no key of an Esri ASCII grid; the keys are ncols, nrows, xllcorner or xllcenter, yllcorner or "
                    "yllcenter, cellsize or dx and dy, NODATA_value");
            if (given[key]) return refuse(word + " is given twice");
            given[key] = true;
            if (key == x_origin || key == y_origin) centre_[key - x_origin] = lower_case(word).ends_with("center") ? 0.5 : 0;
            if (Status status = read_header_value(word, key, found[key]); !status) return status;
        }
        static const char* const names[] = {"ncols", "nrows", "xllcorner or xllcenter", "yllcorner or yllcenter", "cellsize"};
        for (std::size_t key = 0; key <= cell_size; ++key)
            if (!given[key]) return refuse(std::string("the header ends without ") + names[key]);
        map_.nx = static_cast<int>(found[columns]);
        map_.ny = static_cast<int>(found[rows]);
        map_.cell_size = found[cell_size];
        cell_height_ = given[cell_height] ? found[cell_height] : map_.cell_size;
        no_data_ = found[no_data];
        map_.origin = {found[x_origin] - centre_[0] * map_.cell_size, found[y_origin] - centre_[1] * cell_height_};
        return ok_status();
    }

    Status read_header_value(const std::string& word, Key key, double& value) {
        const std::string text(words_.next());
        if (key == no_data && is_hole(lower_case(text))) {
            value = std::numeric_limits<double>::quiet_NaN();
            return ok_status();
        }
        if (!parse(text, value) || (key != no_data && !std::isfinite(value))) return refuse(word + ": " + no_number_text(text));
        if (key <= rows && !(value >= 1 && value <= MAP_LIMIT && value == std::floor(value)))
            return refuse(word + ": " + text + " is not a whole number in 1 ... " + std::to_string(MAP_LIMIT));
        if ((key == cell_size || key == cell_height) && !(value > 0)) return refuse(word + ": " + text + " is not above 0");
        return ok_status();
    }

    /// Fills the map from its last row, the file's first, to row 0. Unknown heights stay NaN.
    Status read_values() {
        const auto nx = static_cast<std::size_t>(map_.nx);
        const std::size_t count = nx * static_cast<std::size_t>(map_.ny);
        if (words_.bytes_left() / 2 + 1 < count) return too_few(count); // not even room for a digit and a blank each
        map_.values.resize(count);
        for (std::size_t n = 0; n < count; ++n) {
            const std::string_view word = words_.next();
            double value = 0;
            if (word.empty()) return refuse(few_text(n, count));
            const bool hole = is_hole_value(word, value);
            if (!hole && !parse(word, value)) return refuse(place(n) + ": " + no_number_text(word));
            if (!hole && !(std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
                return refuse(place(n) + " is infinite or too large for a float");
            const std::size_t row = static_cast<std::size_t>(map_.ny) - 1 - n / nx;
            map_.values[row * nx + n % nx] = hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value);
        }
        if (!words_.next().empty()) return refuse("more values than ncols x nrows, " + size_text());
        return ok_status();
    }

    Status too_few(std::size_t count) {
        std::size_t held = 0;
        while (!words_.next().empty()) ++held;
        return refuse(few_text(held, count));
    }
    std::string few_text(std::size_t held, std::size_t count) const {
        return "the file ends after " + std::to_string(held) + " values where ncols x nrows, " + size_text() + ", are " +
               std::to_string(count);
    }
    std::string size_text() const { return std::to_string(map_.nx) + " x " + std::to_string(map_.ny); }
    std::string place(std::size_t n) const {
        const auto nx = static_cast<std::size_t>(map_.nx);
        return "the value in column " + std::to_string(n % nx + 1) + " of row " + std::to_string(n / nx + 1);
    }

    /// NODATA_value, which programs round as they write it, no number, or the largest of floats.
    bool is_hole_value(std::string_view word, double& value) const {
        if (!parse(word, value)) return is_hole(lower_case(word));
        if (std::isnan(value) || is_float_limit(value)) return true;
        constexpr double rounded = 1e-6;
        const double size = std::fabs(no_data_);
        return std::fabs(value - no_data_) <= (size > 1e6 ? rounded * size : 0);
    }

    static std::string no_number_text(std::string_view word) {
        std::string text(word.substr(0, 40));
        std::string pointed = text;
        std::replace(pointed.begin(), pointed.end(), ',', '.');
        double unused = 0;
        const bool comma = pointed != text && parse(pointed, unused);
        return "\"" + text + "\" " + (comma ? "has a decimal comma; save the grid with decimal points" : "is not a number");
    }

    /// As many rows as give cells that are not square the width of the columns.
    Status find_square_rows() {
        square_rows_ = map_.ny;
        if (cell_height_ == map_.cell_size) return ok_status();
        const double height = std::round(map_.ny * cell_height_ / map_.cell_size);
        if (!(height >= 1 && height <= MAP_LIMIT))
            return error(Code::bad_file, name_ + ": cells of " + number_text(map_.cell_size) + " by " +
                                             number_text(cell_height_) + " m would be " + number_text(height) +
                                             " rows of square ones");
        square_rows_ = static_cast<int>(height);
        return ok_status();
    }

    /// The file's own, and those of rows anew.
    std::int64_t values_in_all() const {
        const bool square = cell_height_ == map_.cell_size;
        return std::int64_t{map_.nx} * (map_.ny + (square ? 0 : square_rows_));
    }

    void make_square() {
        if (cell_height_ == map_.cell_size) return;
        map_.notes.push_back("cells of " + number_text(map_.cell_size) + " by " + number_text(cell_height_) + " m: its " +
                             std::to_string(map_.ny) + " rows are resampled to " + number_text(square_rows_));
        resample_map(map_, map_.nx, square_rows_);
    }

    Words words_;
    const std::string& name_;
    double no_data_ = NO_DATA, cell_height_ = 0, centre_[2] = {};
    int square_rows_ = 0;
    Map map_;
};

} // namespace

Result<Map> decode_asc(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room) {
    return AscReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name).read(room);
}

} // namespace wadi
