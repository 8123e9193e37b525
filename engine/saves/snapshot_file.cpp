#include "engine/saves/snapshot_file.hpp"
#include "engine/saves/disk_file.hpp"
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>

namespace wadi {

namespace {

constexpr std::size_t name_most = 255; // bytes of a file's name

// Beside the path, which need not exist, with a name of this process alone, and of this call in it: savers to one path do not
// write into one file.
std::string temporary_of(const std::filesystem::path& path) {
    static std::atomic<std::uint64_t> calls{0};
    const std::string end = "." + process_number() + "-" + std::to_string(++calls) + ".part";
    const std::string name = path.filename().string();
    return (path.parent_path() / (name.substr(0, name_most - end.size()) + end)).string();
}

// The file that a link leads to is replaced, not the link.
std::filesystem::path behind_links(std::filesystem::path path) {
    constexpr int most = 40; // links in a row, as systems have it
    std::error_code failure;
    for (int n = 0; n < most && std::filesystem::is_symlink(path, failure); ++n) {
        const auto next = std::filesystem::read_symlink(path, failure);
        if (failure) break;
        path = next.is_absolute() ? next : path.parent_path() / next;
    }
    return path;
}

} // namespace

Status write_snapshot_file(const std::string& path, std::span<const std::byte> bytes) {
    std::error_code failure;
    if (std::filesystem::exists(path, failure) && !std::filesystem::is_regular_file(path, failure))
        return error(Code::bad_file, "'" + path + "' is not a regular file");
    const auto target = behind_links(path);
    std::string temporary;
    const auto failed = [&](const std::string& text) {
        std::filesystem::remove(temporary, failure);
        return error(Code::bad_file, "'" + temporary + "'" + text);
    };
    {
        // A process of another pid namespace may have this one's number and name.
        constexpr int tries = 100;
        std::optional<DiskFile> made;
        for (int n = 0; n < tries && (n == 0 || (!made->is_open() && errno == EEXIST)); ++n)
            made.emplace(temporary = temporary_of(target), DiskFile::Open::to_make);
        const DiskFile& file = *made;
        if (!file.is_open()) return error(Code::not_found, "'" + temporary + "' cannot be opened for writing");
        file.take_rights_of(target.string());
        if (!file.write_all(bytes) || !file.synchronise())
            return failed(": writing " + std::to_string(bytes.size()) + " bytes failed: " + std::strerror(errno));
    }
    std::filesystem::rename(temporary, target, failure);
    if (failure) return failed(" cannot be renamed to '" + target.string() + "': " + failure.message());
    const auto folder = target.parent_path();
    synchronise_folder(folder.empty() ? "." : folder.string());
    return ok_status();
}

Result<std::vector<std::byte>> read_snapshot_file(const std::string& path, std::uint64_t most) {
    const DiskFile file(path, DiskFile::Open::to_read);
    if (!file.is_open()) return error(Code::not_found, "'" + path + "' cannot be opened");
    const auto size = file.regular_bytes();
    if (!size) return error(Code::bad_file, "'" + path + "' is not a regular file");
    if (*size > most)
        return error(Code::bad_file, "'" + path + "': " + std::to_string(*size) + " bytes are more than the " +
                                         std::to_string(most) + " of the largest snapshot that this world can have");
    try {
        std::vector<std::byte> bytes(static_cast<std::size_t>(*size));
        if (!file.read_all(bytes)) return error(Code::bad_file, "'" + path + "' cannot be read");
        return bytes;
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, "'" + path + "' does not fit into memory");
    }
}

} // namespace wadi
