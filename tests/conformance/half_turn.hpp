// The figure of the paper's supplement: the state half way between a strained body and itself turned by an angle.
#pragma once
#include "tests/conformance/case.hpp"

namespace wadi::conformance {

/// Case half_turn(strain=polar|direct|left_stretch): in one dispatch, a cell gathers half its sand from a neighbour that is
/// strained alike but turned by 0, 15 ... 180 degrees. Its area (det of the strain) must be that of both for polar, shrink by
/// cos^2 of half the angle for direct. Of left_stretch the mean of two stretches is asked. The detail lists angle:area.
Verdict run_half_turn(const CaseSpec& spec, Session& session);

} // namespace wadi::conformance
