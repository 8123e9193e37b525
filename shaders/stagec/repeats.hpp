// What a stage says once and means twice: EACH_AXIS and EACH_OF (shaders/README.md, "Said once").
#pragma once
#include "source.hpp"

namespace stagec {

/// The stage with every EACH_AXIS and EACH_OF written out, line for line. `reads`: what `#include` lines of the stage bring,
/// where functions with REF parameters are looked for.
Source written_out(const Source& stage, const std::string& reads);

} // namespace stagec
