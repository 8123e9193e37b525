#include "engine/image/plausible.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>

namespace wadi {
namespace {

constexpr double DEEPEST = -11000; // no sea is deeper [m]

/// What programs write for holes, deepest first. Those that could be ground count where nothing comes near.
constexpr std::array<double, 7> HOLES = {-99999, -32768, -32767, -9999, 32767, 99999, 1e20};

/// Percentiles of known values.
struct Spread {
    double low = 0, high = 0; // 99 of 100 values lie between
    double least = 0, most = 0;
    std::size_t least_at = 0, most_at = 0;
};

Spread spread_of(const std::vector<float>& values) {
    constexpr std::size_t looks = 65536; // are enough to place the bulk of a map
    std::vector<float> some;
    Spread spread{0, 0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0, 0};
    const std::size_t every = std::max<std::size_t>(values.size() / looks, 1);
    for (std::size_t n = 0; n < values.size(); ++n) {
        const auto value = static_cast<double>(values[n]);
        if (std::isnan(value)) continue;
        if (n % every == 0) some.push_back(values[n]);
        if (value < spread.least) spread.least = value, spread.least_at = n;
        if (value > spread.most) spread.most = value, spread.most_at = n;
    }
    if (some.empty()) return spread;
    const auto at = [&](double share) {
        const auto place = some.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(some.size() - 1));
        std::nth_element(some.begin(), place, some.end());
        return static_cast<double>(*place);
    };
    spread.low = at(0.005);
    spread.high = at(0.995);
    return spread;
}

/// Values that are holes though the file says otherwise; how many.
std::int64_t find_holes(Map& map) {
    std::int64_t found = 0;
    for (const double hole : HOLES) {
        const auto is_it = [&](float value) {
            return static_cast<double>(value) == static_cast<double>(static_cast<float>(hole));
        };
        const std::int64_t count = std::count_if(map.values.begin(), map.values.end(), is_it);
        if (count == 0 || count == static_cast<std::int64_t>(map.values.size())) continue;
        double nearest = std::numeric_limits<double>::infinity(), least = nearest, most = -nearest;
        for (const float each : map.values) {
            const auto value = static_cast<double>(each);
            if (std::isnan(value) || is_it(each)) continue;
            nearest = std::min(nearest, std::fabs(value - hole));
            least = std::min(least, value);
            most = std::max(most, value);
        }
        constexpr double gap = 1000; // [m]
        const bool beyond = hole < DEEPEST || (nearest > gap && nearest > 2 * (most - least));
        if (!beyond) continue;
        std::replace_if(map.values.begin(), map.values.end(), is_it, std::numeric_limits<float>::quiet_NaN());
        map.notes.push_back(std::to_string(count) + " cells hold " + number_text(hole) + ", which is no ground beside " +
                            number_text(least) + " ... " + number_text(most) + " m: taken for holes");
        found += count;
    }
    return found;
}

/// Share of the samples that equal the one `apart` before them.
double equal_share(const Map& map, int apart) {
    const auto off = static_cast<std::size_t>(apart);
    if (map.values.size() <= off) return 0;
    std::size_t equal = 0;
    for (std::size_t cell = off; cell < map.values.size(); ++cell) equal += map.values[cell] == map.values[cell - off] ? 1 : 0;
    return static_cast<double>(equal) / static_cast<double>(map.values.size() - off);
}

std::string place_text(const Map& map, std::size_t cell) {
    const auto width = static_cast<std::size_t>(map.nx);
    return "column " + std::to_string(cell % width + 1) + ", row " + std::to_string(cell / width + 1) + " from the south";
}

} // namespace

bool is_float_limit(double value) { return std::fabs(value) >= 3.4e38 && std::fabs(value) <= 3.41e38; }

Status fill_holes(Map& map, const std::string& name) {
    find_holes(map);
    std::queue<std::size_t> front;
    for (std::size_t cell = 0; cell < map.values.size(); ++cell)
        if (!std::isnan(map.values[cell])) front.push(cell);
    map.filled = static_cast<std::int64_t>(map.values.size() - front.size());
    if (map.filled == 0) return ok_status();
    if (front.empty()) return error(Code::bad_file, name + ": every value is NODATA_value");
    map.holes.resize(map.values.size());
    for (std::size_t cell = 0; cell < map.values.size(); ++cell) map.holes[cell] = std::isnan(map.values[cell]);
    const auto nx = static_cast<std::size_t>(map.nx);
    for (; !front.empty(); front.pop()) {
        const std::size_t cell = front.front();
        const auto reach = [&](bool inside, std::size_t neighbour) {
            if (!inside || !std::isnan(map.values[neighbour])) return;
            map.values[neighbour] = map.values[cell];
            front.push(neighbour);
        };
        reach(cell % nx > 0, cell - 1);
        reach(cell % nx + 1 < nx, cell + 1);
        reach(cell >= nx, cell - nx);
        reach(cell + nx < map.values.size(), cell + nx);
    }
    return ok_status();
}

double roughness_of(const Map& map) {
    const auto nx = static_cast<std::size_t>(map.nx);
    const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
    const double range = static_cast<double>(*high) - static_cast<double>(*low);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t cell = 0; cell < map.values.size(); ++cell) {
        const auto differ = [&](bool inside, std::size_t neighbour) {
            if (!inside) return;
            sum += std::fabs(static_cast<double>(map.values[cell]) - static_cast<double>(map.values[neighbour]));
            ++count;
        };
        differ(cell % nx + 1 < nx, cell + 1);
        differ(cell + nx < map.values.size(), cell + nx);
    }
    return range > 0 && count > 0 ? sum / static_cast<double>(count) / range : 0;
}

void note_odd_ground(Map& map) {
    constexpr std::size_t fewest = 1024; // samples: of fewer nothing can be said
    if (map.values.size() < fewest) return;
    const Spread spread = spread_of(map.values);
    const double bulk = spread.high - spread.low;
    const double far = 20 * bulk + (map.integer ? 0 : 100);
    const auto outlier = [&](double value, std::size_t at, double off) {
        map.notes.push_back("its value " + number_text(value) + " in " + place_text(map, at) + " lies " + number_text(off) +
                            " from " + number_text(spread.low) + " ... " + number_text(spread.high) +
                            ", where 99 % are: a hole, or a damaged sample?");
    };
    if (spread.low - spread.least > far && bulk > 0) outlier(spread.least, spread.least_at, spread.low - spread.least);
    if (spread.most - spread.high > far && bulk > 0) outlier(spread.most, spread.most_at, spread.most - spread.high);

    constexpr double noisy = 0.2; // white noise has 1/3
    const double roughness = roughness_of(map);
    if (roughness > noisy)
        map.notes.push_back(
            "neighbouring samples differ by " + number_text(std::round(100 * roughness)) +
            " % of its relief in the mean, as in noise: another number of bits or order of bytes than its own, or " +
            "heights packed into colours?");

    std::vector<float> levels = map.values;
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    constexpr std::size_t few = 256, some = 16; // fewer are a mask
    const double relief = spread.most - spread.least;
    constexpr double mostly = 0.4; // of neighbours along either axis: a plane along one has few values as well
    if (levels.size() >= some && levels.size() <= few && std::min(equal_share(map, 1), equal_share(map, map.nx)) > mostly)
        map.notes.push_back("it has " + std::to_string(levels.size()) + " different values alone: terraces of " +
                            number_text(relief / static_cast<double>(levels.size() - 1)) + (map.integer ? " of white" : " m") +
                            ", on which water stands; a map of 16 bits or of floats has none");

    if (map.integer) return;
    const auto at_sea = static_cast<double>(std::count(map.values.begin(), map.values.end(), 0.0f));
    const double share = at_sea / static_cast<double>(map.values.size());
    if (share > 0.05 && share < 0.95)
        map.notes.push_back(number_text(std::round(100 * share)) + " % of it is exactly 0: a sea, which is flat ground here");
}

} // namespace wadi
