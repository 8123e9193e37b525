#include "engine/saves/disk_file.hpp"
#include <algorithm>
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>

namespace wadi {

namespace {
// The calls take an unsigned int and give an int.
unsigned piece(std::size_t bytes) { return static_cast<unsigned>(std::min(bytes, std::size_t{1} << 30)); }
} // namespace

DiskFile::DiskFile(const std::string& path, Open how)
    : number_(_open(path.c_str(), (how == Open::to_read ? _O_RDONLY : _O_WRONLY | _O_CREAT | _O_EXCL) | _O_BINARY | _O_NOINHERIT,
                    _S_IREAD | _S_IWRITE)) {}

DiskFile::~DiskFile() {
    if (number_ >= 0) _close(number_);
}

bool DiskFile::write_all(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const int done = _write(number_, bytes.data(), piece(bytes.size()));
        if (done <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
    return true;
}

bool DiskFile::read_all(std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const int done = _read(number_, bytes.data(), piece(bytes.size()));
        if (done <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
    return true;
}

std::optional<std::uint64_t> DiskFile::regular_bytes() const {
    struct _stat64 about {};
    if (_fstat64(number_, &about) != 0 || (about.st_mode & _S_IFMT) != _S_IFREG) return std::nullopt;
    return static_cast<std::uint64_t>(about.st_size);
}

void DiskFile::take_rights_of(const std::string&) const {} // a replaced file's are the folder's

bool DiskFile::synchronise() const { return _commit(number_) == 0; }

void synchronise_folder(const std::string&) {} // Windows has no such call

std::string process_number() { return std::to_string(_getpid()); }

} // namespace wadi
