#include "engine/compute/available_memory.hpp"
#include <windows.h>

namespace wadi {

std::uint64_t available_memory(const std::string&) {
    MEMORYSTATUSEX status{};
    status.dwLength = sizeof(status);
    return GlobalMemoryStatusEx(&status) != 0 ? status.ullAvailPhys : 0;
}

} // namespace wadi
