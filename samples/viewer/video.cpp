#include "video.hpp"
#include <cstdio>
#include <cstdlib>

namespace viewer {
namespace {

/// For /bin/sh.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

} // namespace

std::string make_video(const std::filesystem::path& folder, const std::string& prefix, double frames_per_second) {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) return "none: ffmpeg is not installed (package ffmpeg)";
    const std::string file = (folder / (prefix + ".mp4")).string();
    char rate[32];
    std::snprintf(rate, sizeof(rate), "%.6g", frames_per_second);
    // yuv420p needs even sizes.
    const std::string command = std::string("ffmpeg -loglevel error -y -framerate ") + rate + " -i " +
                                quoted((folder / (prefix + "_%05d.png")).string()) +
                                " -vf 'crop=trunc(iw/2)*2:trunc(ih/2)*2' -c:v libx264 -crf 18 -pix_fmt yuv420p " + quoted(file);
    return std::system(command.c_str()) == 0 ? file : "none: ffmpeg failed";
}

} // namespace viewer
