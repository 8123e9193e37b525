#include "engine/saves/snapshot_file.hpp"
#include <filesystem>
#include <fstream>

namespace wadi {

namespace {

// Where streams hold what the operating system would not take until they are closed, so closing is part of writing.
bool write_all(const std::string& path, std::span<const std::byte> bytes) {
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
    return static_cast<bool>(out);
}

} // namespace

Status write_snapshot_file(const std::string& path, std::span<const std::byte> bytes) {
    const std::string temporary = path + ".part";
    if (!std::ofstream(temporary, std::ios::binary))
        return error(Code::not_found, "'" + temporary + "' cannot be opened for writing");
    std::error_code failure;
    if (!write_all(temporary, bytes)) {
        std::filesystem::remove(temporary, failure);
        return error(Code::bad_file, "'" + temporary + "': writing " + std::to_string(bytes.size()) + " bytes failed");
    }
    std::filesystem::rename(temporary, path, failure);
    if (!failure) return ok_status();
    const std::string why = failure.message();
    std::filesystem::remove(temporary, failure);
    return error(Code::bad_file, "'" + temporary + "' cannot be renamed to '" + path + "': " + why);
}

Result<std::vector<std::byte>> read_snapshot_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    if (!in) return error(Code::not_found, "'" + path + "' cannot be opened");
    const auto end = in.tellg();
    // A folder opens as a file without an end.
    if (end < 0 || std::filesystem::is_directory(path)) return error(Code::bad_file, "'" + path + "' cannot be read");
    std::vector<std::byte> bytes(static_cast<std::size_t>(end));
    in.seekg(0);
    in.read(reinterpret_cast<char*>(bytes.data()), end);
    if (!in) return error(Code::bad_file, "'" + path + "' cannot be read");
    return bytes;
}

} // namespace wadi
