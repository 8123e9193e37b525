// What most tests include, for CMake to precompile. A test includes what it uses all the same: preset dev compiles without.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <doctest/doctest.h>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>
