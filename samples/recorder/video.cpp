#include "video.hpp"
#include "../common/platform.hpp"

namespace recorder {
namespace {

namespace fs = std::filesystem;
constexpr const char* PROGRAM = "ffmpeg";

/// A path as a pattern of numbered files that stands for itself.
std::string literal(const std::string& path) {
    std::string pattern;
    for (const char c : path) pattern += c == '%' ? "%%" : std::string(1, c);
    return pattern;
}

} // namespace

Failure check_video_program() {
    if (!common::find_program(PROGRAM).empty()) return {};
    return {EXIT_BAD_INPUT, "--mp4: no program ffmpeg in PATH; install it (Debian: package ffmpeg) or record without --mp4"};
}

Failure write_video(const fs::path& folder, int frames_per_second, const fs::path& file) {
    fs::path part = fs::absolute(file);
    part += ".part";
    // Players want 4:2:0 colour, which has even sizes only; the index in front lets browsers start at once.
    const int code = common::run_program({PROGRAM,        "-nostdin",
                                          "-hide_banner", "-loglevel",
                                          "error",        "-y",
                                          "-framerate",   std::to_string(frames_per_second),
                                          "-i",           literal(fs::absolute(folder).string()) + "/frame_%05d.png",
                                          "-vf",          "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                          "-c:v",         "libx264",
                                          "-crf",         "18",
                                          "-pix_fmt",     "yuv420p",
                                          "-movflags",    "+faststart",
                                          "-f",           "mp4",
                                          part.string()});
    std::error_code error;
    if (code == 0) {
        fs::rename(part, file, error);
        if (!error) return {};
    }
    const std::string why = error ? error.message() : "ffmpeg ended with code " + std::to_string(code);
    fs::remove(part, error);
    return {EXIT_BAD_INPUT, "cannot write " + file.string() + ": " + why};
}

} // namespace recorder
