#include "engine/saves/snapshot_file.hpp"
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <new>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace wadi {

namespace {

// Closed whatever happens.
class OpenFile {
  public:
    OpenFile(const std::string& path, int flags) : number_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    ~OpenFile() {
        if (number_ >= 0) close(number_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    bool is_open() const { return number_ >= 0; }
    bool write_all(std::span<const std::byte> bytes) const {
        while (!bytes.empty()) {
            const auto done = write(number_, bytes.data(), bytes.size());
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return false;
            bytes = bytes.subspan(static_cast<std::size_t>(done));
        }
        return true;
    }
    bool read_all(std::span<std::byte> bytes) const {
        while (!bytes.empty()) {
            const auto done = read(number_, bytes.data(), bytes.size());
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return false;
            bytes = bytes.subspan(static_cast<std::size_t>(done));
        }
        return true;
    }
    /// Nothing where it is a folder, pipe or device.
    std::optional<std::uint64_t> regular_bytes() const {
        struct stat about {};
        if (fstat(number_, &about) != 0 || !S_ISREG(about.st_mode)) return std::nullopt;
        return static_cast<std::uint64_t>(about.st_size);
    }
    /// On the disk itself, so that a power cut after it takes nothing back.
    bool synchronise() const { return fsync(number_) == 0; }

  private:
    int number_;
};

// Of this process alone, and of this call in it: savers to one path do not write into one file.
std::string temporary_of(const std::string& path) {
    static std::atomic<std::uint64_t> calls{0};
    return path + "." + std::to_string(getpid()) + "-" + std::to_string(++calls) + ".part";
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
        const OpenFile file(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW);
        if (!file.is_open()) return error(Code::not_found, "'" + temporary + "' cannot be opened for writing");
        if (!file.write_all(bytes) || !file.synchronise())
            return failed(": writing " + std::to_string(bytes.size()) + " bytes failed: " + std::strerror(errno));
    }
    std::filesystem::rename(temporary, path, failure);
    if (failure) return failed(" cannot be renamed to '" + path + "': " + failure.message());
    // The name is in the folder: some file systems cannot synchronise one, and then that is all there is to have.
    const auto folder = std::filesystem::path(path).parent_path();
    const OpenFile around(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
    if (around.is_open()) around.synchronise();
    return ok_status();
}

Result<std::vector<std::byte>> read_snapshot_file(const std::string& path, std::uint64_t most) {
    const OpenFile file(path, O_RDONLY | O_NONBLOCK); // a pipe is opened without waiting for its writer
    if (!file.is_open()) return error(Code::not_found, "'" + path + "' cannot be opened");
    const auto size = file.regular_bytes();
    if (!size) return error(Code::bad_file, "'" + path + "' is not a regular file");
    if (*size > most)
        return error(Code::bad_file, "'" + path + "': " + std::to_string(*size) + " bytes are more than the " +
                                         std::to_string(most) + " of the largest snapshot that this world can have");
    try {
        std::vector<std::byte> bytes(*size);
        if (!file.read_all(bytes)) return error(Code::bad_file, "'" + path + "' cannot be read");
        return bytes;
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, "'" + path + "' does not fit into memory");
    }
}

} // namespace wadi
