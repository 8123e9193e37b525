// Numbered pictures to MP4, where ffmpeg is installed.
#pragma once
#include <filesystem>
#include <string>

namespace viewer {

/// Writes `folder`/`prefix`.mp4 from its numbered pictures; the answer says where it is or why there is none.
std::string make_video(const std::filesystem::path& folder, const std::string& prefix, double frames_per_second);

} // namespace viewer
