#include "engine/compute/thread_name.hpp"
#include <windows.h>

namespace wadi::compute {

// Windows 10 from version 1607 on; looked up, since older ones would not load a library that imports it.
void name_this_thread(const char* name) {
    using SetDescription = HRESULT(WINAPI*)(HANDLE, PCWSTR);
    const auto found = GetProcAddress(GetModuleHandleA("kernel32.dll"), "SetThreadDescription");
    const auto set = reinterpret_cast<SetDescription>(reinterpret_cast<void*>(found));
    wchar_t wide[16] = {};
    for (int n = 0; n < 15 && name[n] != 0; ++n) wide[n] = static_cast<unsigned char>(name[n]);
    if (set != nullptr) set(GetCurrentThread(), wide);
}

} // namespace wadi::compute
