// Notices that a level was saved by another program.
#pragma once
#include <filesystem>

namespace viewer {

class LevelWatch {
  public:
    /// The level file and the files in its folder, as they are now.
    void watch(const std::filesystem::path& level_file);
    /// True once for each change. Looks at the disk a few times a second.
    bool changed(double seconds);

  private:
    std::filesystem::path file_;
    std::filesystem::file_time_type newest_{};
    double unseen_ = 0; // [s]
};

} // namespace viewer
