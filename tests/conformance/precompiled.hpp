// What most of these tests include, for CMake to precompile. A file includes what it uses all the same: preset dev compiles
// without.
#pragma once
#include "engine/step/plan/world_params.hpp"
#include "tests/conformance/case.hpp"
#include "tests/conformance/worlds.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>
