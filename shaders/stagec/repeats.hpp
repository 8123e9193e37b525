// What a stage says once and means twice: EACH_AXIS and EACH_OF (shaders/README.md, "Said once").
#pragma once
#include "source.hpp"

namespace stagec {

/// Text with x and y, xx and yy, i and j, nx and ny exchanged in every name, and the arguments of IDX in the other order.
std::string other_axis(const std::string& text);

/// The stage with every EACH_AXIS and EACH_OF written out, line for line. `reads`: what `#include` lines of the stage bring,
/// where functions with REF parameters are looked for.
Source written_out(const Source& stage, const std::string& reads);

} // namespace stagec
