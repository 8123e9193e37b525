// The CPU backend: always built, needs nothing but threads. The reference that every other backend is compared with in bits.
#pragma once
#include "engine/compute/device.hpp"

namespace wadi::cpu {
const compute::Backend& cpu_backend();
}
