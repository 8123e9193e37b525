// shaders/frame_params.inc as C++.
#pragma once
#include <glm/vec4.hpp>

namespace viewer {

struct FrameParams {
    using vec4 = glm::vec4;
    using ivec4 = glm::ivec4;
#include "shaders/frame_params.inc"
};
static_assert(sizeof(FrameParams) == (23 + 10) * 16, "shaders/frame_params.inc holds 16-byte members only");

} // namespace viewer
