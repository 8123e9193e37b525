// Which masks, grids, scenes and choices of method the cases of each stage meet.
#pragma once

namespace wadi::conformance {

/// Prints a table; 1 where a mask that the stage can tell apart has no case, or a stage has nothing to be compared with.
int print_coverage();

} // namespace wadi::conformance
