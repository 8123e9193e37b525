// Threads of a group, as every backend with groups takes them.
#pragma once
#include "engine/compute/device.hpp"

namespace wadi::backends {

/// What the caller left open filled in: 64 x 4, which suits stencils (GPU measurements), rim stages one row, tiles and fused
/// stages the only size that they are written for; all 0 where the device has no groups. Errors: bad_argument.
Result<compute::GroupSize> choose_group(const compute::StageInfo& stage, compute::GroupSize asked,
                                        const compute::GroupLimits& limits);

} // namespace wadi::backends
