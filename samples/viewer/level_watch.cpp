#include "level_watch.hpp"
#include <algorithm>
#include <system_error>

namespace viewer {
namespace {

constexpr double LOOK_EVERY = 0.3; // [s]

/// Of the level and the maps beside it. A folder that is being written may lack files for a moment: those are left out.
std::filesystem::file_time_type newest_change(const std::filesystem::path& level_file) {
    std::error_code ignored;
    std::filesystem::file_time_type newest = std::filesystem::last_write_time(level_file, ignored);
    if (level_file.extension() != ".json") return newest;
    for (const auto& entry : std::filesystem::directory_iterator(level_file.parent_path(), ignored)) {
        const std::string ending = entry.path().extension().string();
        if (ending == ".jpg" || ending == ".md" || ending == ".part" || !entry.is_regular_file(ignored)) continue;
        newest = std::max(newest, entry.last_write_time(ignored));
    }
    return newest;
}

} // namespace

void LevelWatch::watch(const std::filesystem::path& level_file) {
    file_ = std::filesystem::absolute(level_file);
    newest_ = newest_change(file_);
    unseen_ = 0;
}

bool LevelWatch::changed(double seconds) {
    unseen_ += seconds;
    if (unseen_ < LOOK_EVERY) return false;
    unseen_ = 0;
    const std::filesystem::file_time_type newest = newest_change(file_);
    if (newest == newest_) return false;
    newest_ = newest;
    return true;
}

} // namespace viewer
