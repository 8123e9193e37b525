#include "engine/compute/available_memory.hpp"
#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace wadi {

namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

// The number behind a word; of a file that is one number alone: behind "".
std::optional<std::uint64_t> number_in(const std::string& path, const std::string& word) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string first;
        if (!word.empty() && (!(words >> first) || first != word)) continue;
        std::uint64_t number = 0;
        if (words >> number) return number;
        return std::nullopt; // "max"
    }
    return std::nullopt;
}

// What is left of a group's limit.
std::uint64_t left_in(const std::string& folder, const char* limit, const char* usage, const char* droppable) {
    const auto most = number_in(folder + limit, ""), used = number_in(folder + usage, "");
    if (!most || !used) return unlimited;
    const std::uint64_t files = std::min(*used, number_in(folder + "/memory.stat", droppable).value_or(0));
    return *most > *used - files ? *most - (*used - files) : 0;
}

// A group is limited by all above it. A container may show its own as the top one.
template <class Left> std::uint64_t least_up_from(const std::string& top, std::string path, const Left& left) {
    std::uint64_t least = left(top);
    while (path.size() > 1) {
        least = std::min(least, left(top + path));
        path.erase(path.rfind('/'));
    }
    return least;
}

} // namespace

std::uint64_t available_memory(const std::string& root) {
    const auto kibibytes = number_in(root + "proc/meminfo", "MemAvailable:");
    if (!kibibytes) return 0;
    std::uint64_t least = *kibibytes * 1024;
    std::ifstream groups(root + "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) { // number:controllers:path
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
        if (controllers.empty()) {
            least = std::min(least, least_up_from(root + "sys/fs/cgroup", path, [](const std::string& folder) {
                                 return left_in(folder, "/memory.max", "/memory.current", "inactive_file");
                             }));
        } else if (("," + controllers + ",").find(",memory,") != std::string::npos) {
            least =
                std::min(least, least_up_from(root + "sys/fs/cgroup/memory", path, [](const std::string& folder) {
                             return left_in(folder, "/memory.limit_in_bytes", "/memory.usage_in_bytes", "total_inactive_file");
                         }));
        }
    }
    return least;
}

} // namespace wadi
