#include "engine/saves/disk_file.hpp"
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace wadi {

DiskFile::DiskFile(const std::string& path, Open how)
    : number_(open(path.c_str(),
                   (how == Open::to_read ? O_RDONLY | O_NONBLOCK : O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW) | O_CLOEXEC, 0666)) {
}

DiskFile::~DiskFile() {
    if (number_ >= 0) close(number_);
}

bool DiskFile::write_all(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const auto done = write(number_, bytes.data(), bytes.size());
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
    return true;
}

bool DiskFile::read_all(std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const auto done = read(number_, bytes.data(), bytes.size());
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
    return true;
}

std::optional<std::uint64_t> DiskFile::regular_bytes() const {
    struct stat about {};
    if (fstat(number_, &about) != 0 || !S_ISREG(about.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(about.st_size);
}

void DiskFile::take_rights_of(const std::string& path) const {
    struct stat about {};
    if (stat(path.c_str(), &about) != 0) return;
    [[maybe_unused]] const int owner = fchown(number_, about.st_uid, about.st_gid); // may take set-id bits away: first
    fchmod(number_, about.st_mode & 07777);
}

bool DiskFile::synchronise() const { return fsync(number_) == 0; }

void synchronise_folder(const std::string& path) {
    const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
}

std::string process_number() { return std::to_string(getpid()); }

} // namespace wadi
