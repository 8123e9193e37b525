#include "engine/image/map.hpp"
#include "engine/image/parse_number.hpp"
#include "engine/level/settings_reader.hpp"
#include <cstddef>
#include <string_view>

namespace wadi {
namespace {

constexpr std::size_t SAMPLES_MOST = 1000000;
constexpr std::uint64_t SERIES_BYTES_MOST = 64u << 20;

std::string_view trimmed(std::string_view text) {
    const char* blank = " \t\r";
    const std::size_t first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

} // namespace

Result<TimeSeries> read_series_file(const std::string& path, LevelFiles& files) {
    auto bytes = files.read(path, SERIES_BYTES_MOST);
    if (!bytes) return bytes.status();
    if (Status status = files.room.take({static_cast<std::int64_t>(bytes->size())}, path); !status) return status;
    std::string_view rest(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    TimeSeries series;
    bool heading_allowed = true;
    for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
        const std::size_t end = rest.find('\n');
        const std::string_view line = trimmed(rest.substr(0, end));
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
        if (line.empty() || line.front() == '#') continue;
        const std::size_t comma = line.find(',');
        double time = 0;
        double value = 0;
        const bool numbers = comma != std::string_view::npos && parse_number(trimmed(line.substr(0, comma)), time) &&
                             parse_number(trimmed(line.substr(comma + 1)), value);
        if (!numbers && !heading_allowed)
            return error(Code::bad_file, path + ": line " + std::to_string(line_number) + " is not \"time,value\"");
        heading_allowed = false;
        if (numbers) series.samples.emplace_back(time, value);
        if (series.samples.size() > SAMPLES_MOST)
            return error(Code::bad_file, path + ": more than " + std::to_string(SAMPLES_MOST) + " samples");
    }
    if (series.samples.empty()) return error(Code::bad_file, path + ": holds no \"time,value\" lines");
    return series;
}

TimeSeries read_series(const Json& value, const std::string& path, LevelFiles& files, Status& status) {
    TimeSeries series;
    if (value.is_object()) {
        ObjectReader reader(value, path, status);
        std::string file;
        reader.require("file");
        reader.string("file", file);
        reader.finish();
        if (!status) return series;
        auto read = read_series_file(file, files);
        if (read) return std::move(*read);
        status = error(read.status().code, path + ".file: " + read.status().message);
    } else if (value.is_array()) {
        const auto elements = read_array(value, path, SAMPLES_MOST, status);
        for (std::size_t n = 0; n < elements.size() && status; ++n) {
            const auto sample = read_pair(*elements[n], path + "[" + std::to_string(n) + "]", -ANY_NUMBER, ANY_NUMBER, status);
            series.samples.emplace_back(sample[0], sample[1]);
        }
        if (elements.empty() && status) status = error(Code::bad_file, path + ": an empty list; give [[time, value], ...]");
    } else if (value.is_number()) {
        series.samples.emplace_back(0, read_number(value, path, -ANY_NUMBER, ANY_NUMBER, status));
    } else if (status) {
        status = error(Code::bad_file,
                       path + ": expected a number, a list of [time, value] or {\"file\": ...}, found " + json_text(value));
    }
    return series;
}

} // namespace wadi
