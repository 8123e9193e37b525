// The CPU backend: always built, needs nothing but threads. The reference that every other backend is compared with in bits.
#pragma once
#include "backends/common/backend.hpp"

namespace wadi::cpu {
const backends::Backend& cpu_backend();
}
