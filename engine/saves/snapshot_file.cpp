#include "engine/saves/snapshot_file.hpp"
#include "engine/saves/disk_file.hpp"
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>

namespace wadi {

namespace {

// Of this process alone, and of this call in it: savers to one path do not write into one file.
std::string temporary_of(const std::string& path) {
    static std::atomic<std::uint64_t> calls{0};
    return path + "." + process_number() + "-" + std::to_string(++calls) + ".part";
}

} // namespace

Status write_snapshot_file(const std::string& path, std::span<const std::byte> bytes) {
    std::error_code failure;
    if (std::filesystem::exists(path, failure) && !std::filesystem::is_regular_file(path, failure))
        return error(Code::bad_file, "'" + path + "' is not a regular file");
    const std::string temporary = temporary_of(path);
    const auto failed = [&](const std::string& text) {
        std::filesystem::remove(temporary, failure);
        return error(Code::bad_file, "'" + temporary + "'" + text);
    };
    {
        const DiskFile file(temporary, DiskFile::Open::to_write_anew);
        if (!file.is_open()) return error(Code::not_found, "'" + temporary + "' cannot be opened for writing");
        if (!file.write_all(bytes) || !file.synchronise())
            return failed(": writing " + std::to_string(bytes.size()) + " bytes failed: " + std::strerror(errno));
    }
    std::filesystem::rename(temporary, path, failure);
    if (failure) return failed(" cannot be renamed to '" + path + "': " + failure.message());
    const auto folder = std::filesystem::path(path).parent_path();
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
