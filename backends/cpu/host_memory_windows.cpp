#include "backends/cpu/host_memory.hpp"
#include <vector>
#include <windows.h>
// after windows.h
#include <psapi.h>

namespace wadi::cpu {

std::uint64_t physical_memory() {
    MEMORYSTATUSEX status{};
    status.dwLength = sizeof(status);
    return GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : 0;
}

std::string processor_name() {
    char name[256] = {};
    DWORD bytes = sizeof(name) - 1;
    const auto found = RegGetValueA(HKEY_LOCAL_MACHINE, "HARDWARE\\DESCRIPTION\\System\\CentralProcessor\\0",
                                    "ProcessorNameString", RRF_RT_REG_SZ, nullptr, name, &bytes);
    return found == ERROR_SUCCESS && name[0] != 0 ? name : "CPU";
}

// Large pages want a privilege that games do not have. Pages that nobody has touched count against the system's commit limit all
// the same, but take no memory.
std::byte* map_pages(std::size_t bytes, std::size_t, bool) {
    return static_cast<std::byte*>(VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE));
}

void unmap_pages(std::byte* data, std::size_t) { VirtualFree(data, 0, MEM_RELEASE); }

std::uint64_t resident_pages(std::byte* data, std::size_t pages, std::size_t page) {
    std::vector<PSAPI_WORKING_SET_EX_INFORMATION> about(pages);
    for (std::size_t n = 0; n < pages; ++n) about[n].VirtualAddress = data + n * page;
    const auto bytes = static_cast<DWORD>(pages * sizeof(about[0]));
    if (QueryWorkingSetEx(GetCurrentProcess(), about.data(), bytes) == 0) return 0;
    std::uint64_t resident = 0;
    for (const auto& one : about) resident += one.VirtualAttributes.Valid;
    return resident;
}

// Zeros when they are touched again.
void forget_pages(std::byte* data, std::size_t bytes) {
    VirtualFree(data, bytes, MEM_DECOMMIT);
    VirtualAlloc(data, bytes, MEM_COMMIT, PAGE_READWRITE);
}

} // namespace wadi::cpu
