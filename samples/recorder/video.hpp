// The frames as an H.264 MP4, by the ffmpeg program.
#pragma once
#include "options.hpp"
#include <filesystem>

namespace recorder {

/// No failure where the program is there; else one that says what to install.
Failure check_video_program();

/// Turns frame_00000.png ... of the folder into `file`, which is then whole or absent.
Failure write_video(const std::filesystem::path& folder, int frames_per_second, const std::filesystem::path& file);

} // namespace recorder
