// A file on a disk, by the system's own calls: what the C++ library cannot say of one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace wadi {

/// Closed whatever happens. errno says why a call failed.
class DiskFile {
  public:
    enum class Open { to_read, to_make };
    /// To read: a pipe is opened without waiting for its writer. To write: made, where nothing has the name.
    DiskFile(const std::string& path, Open how);
    ~DiskFile();
    DiskFile(const DiskFile&) = delete;
    DiskFile& operator=(const DiskFile&) = delete;

    bool is_open() const { return number_ >= 0; }
    bool write_all(std::span<const std::byte> bytes) const;
    bool read_all(std::span<std::byte> bytes) const;
    /// Nothing where it is a folder, pipe or device.
    std::optional<std::uint64_t> regular_bytes() const;
    /// Gives it the permissions and, where the system lets it, the owner of another file, if there is one.
    void take_rights_of(const std::string& path) const;
    /// On the disk itself, so that a power cut after it takes nothing back.
    bool synchronise() const;

  private:
    int number_;
};

/// That the folder's names are on the disk; where a file system cannot synchronise one, that is all there is to have.
void synchronise_folder(const std::string& path);
/// Of this process among those that run.
std::string process_number();

} // namespace wadi
