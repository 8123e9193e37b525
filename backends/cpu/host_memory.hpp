// What the backend asks of the operating system.
#pragma once
#include <cstdint>
#include <string>

namespace wadi::cpu {
std::uint64_t physical_memory(); // bytes; 0 = unknown
std::string processor_name();
} // namespace wadi::cpu
