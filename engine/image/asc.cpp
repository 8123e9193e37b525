// Esri ASCII grids: a header of "key value" lines, then values in rows from the north, separated by blanks or line ends.
#include "engine/image/map.hpp"
#include "engine/image/parse_number.hpp"
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <string_view>

namespace wadi {
namespace {

constexpr double NO_DATA = -9999; // where the header names no other

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

/// Cuts a text into words and counts lines.
class Words {
  public:
    explicit Words(std::string_view text) : rest_(text) {}
    /// The next word, which stays the next one; empty at the end.
    std::string_view peek() {
        while (!rest_.empty() && is_blank(rest_.front())) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
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
        if (status) status = check_map_size(map_.nx, map_.ny, name_, room);
        if (status) status = read_values();
        if (!status) return status;
        fill_unknown();
        return std::move(map_);
    }

  private:
    enum Key : std::size_t { columns, rows, x_origin, y_origin, cell_size, no_data, KEY_COUNT };

    Status refuse(const std::string& message) const {
        return error(Code::bad_file, name_ + ": line " + std::to_string(words_.line()) + ": " + message);
    }

    static Key key_of(const std::string& word) {
        if (word == "ncols") return columns;
        if (word == "nrows") return rows;
        if (word == "xllcorner" || word == "xllcenter") return x_origin;
        if (word == "yllcorner" || word == "yllcenter") return y_origin;
        if (word == "cellsize") return cell_size;
        return word == "nodata_value" ? no_data : KEY_COUNT;
    }

    Status read_header() {
        bool given[KEY_COUNT] = {};
        double found[KEY_COUNT] = {0, 0, 0, 0, 0, NO_DATA};
        for (double unused = 0; !words_.peek().empty() && !parse(words_.peek(), unused);) {
            const std::string word(words_.next());
            const Key key = key_of(lower_case(word));
            if (key == KEY_COUNT)
                return refuse("\"" + word + "\" is no key of an Esri ASCII grid with square cells; the keys are ncols, nrows, " +
                              "xllcorner or xllcenter, yllcorner or yllcenter, cellsize, NODATA_value");
            if (given[key]) return refuse(word + " is given twice");
            given[key] = true;
            if (Status status = read_header_value(word, key, found[key]); !status) return status;
        }
        static const char* const names[] = {"ncols", "nrows", "xllcorner or xllcenter", "yllcorner or yllcenter", "cellsize"};
        for (std::size_t key = 0; key < no_data; ++key)
            if (!given[key]) return refuse(std::string("the header ends without ") + names[key]);
        map_.nx = static_cast<int>(found[columns]);
        map_.ny = static_cast<int>(found[rows]);
        map_.cell_size = found[cell_size];
        no_data_ = found[no_data];
        return ok_status();
    }

    Status read_header_value(const std::string& word, Key key, double& value) {
        const std::string text(words_.next());
        if (!parse(text, value) || (key != no_data && !std::isfinite(value)))
            return refuse(word + ": \"" + text + "\" is not a number");
        if (key <= rows && !(value >= 1 && value <= MAP_LIMIT && value == std::floor(value)))
            return refuse(word + ": " + text + " is not a whole number in 1 ... " + std::to_string(MAP_LIMIT));
        if (key == cell_size && !(value > 0)) return refuse(word + ": " + text + " is not above 0");
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
            if (!parse(word, value)) return refuse(place(n) + ": \"" + std::string(word.substr(0, 40)) + "\" is not a number");
            const bool unknown = value == no_data_ || (std::isnan(value) && std::isnan(no_data_));
            if (!unknown && !(std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
                return refuse(place(n) + " is " + (std::isnan(value) ? "NaN" : "infinite or too large for a float"));
            const std::size_t row = static_cast<std::size_t>(map_.ny) - 1 - n / nx;
            map_.values[row * nx + n % nx] = unknown ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value);
            map_.filled += unknown ? 1 : 0;
        }
        if (!words_.next().empty()) return refuse("more values than ncols x nrows, " + size_text());
        if (map_.filled == static_cast<std::int64_t>(count)) return refuse("every value is NODATA_value");
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

    /// Gives unknown cells the height of the nearest known one, by steps between neighbours: flat ground, no cliffs.
    void fill_unknown() {
        if (map_.filled == 0) return;
        std::queue<std::size_t> front;
        for (std::size_t cell = 0; cell < map_.values.size(); ++cell)
            if (!std::isnan(map_.values[cell])) front.push(cell);
        const auto nx = static_cast<std::size_t>(map_.nx);
        for (; !front.empty(); front.pop()) {
            const std::size_t cell = front.front();
            const auto reach = [&](bool inside, std::size_t neighbour) {
                if (!inside || !std::isnan(map_.values[neighbour])) return;
                map_.values[neighbour] = map_.values[cell];
                front.push(neighbour);
            };
            reach(cell % nx > 0, cell - 1);
            reach(cell % nx + 1 < nx, cell + 1);
            reach(cell >= nx, cell - nx);
            reach(cell + nx < map_.values.size(), cell + nx);
        }
    }

    Words words_;
    const std::string& name_;
    double no_data_ = NO_DATA;
    Map map_;
};

} // namespace

Result<Map> decode_asc(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room) {
    return AscReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name).read(room);
}

} // namespace wadi
