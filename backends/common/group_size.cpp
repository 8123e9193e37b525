#include "backends/common/group_size.hpp"
#include <algorithm>

namespace wadi::backends {

using compute::GroupSize;

Result<GroupSize> choose_group(const compute::StageInfo& stage, GroupSize asked, const compute::GroupLimits& limits) {
    const bool rim = stage.extent == compute::Extent::rim;
    GroupSize group{0, 0, asked.tile};
    if (asked.tile < 0 || (asked.tile > 0 && !stage.marks))
        return error(Code::bad_argument, "stage " + std::string(stage.name) + " cannot run over active tiles of " +
                                             std::to_string(asked.tile) + " cells");
    if (limits.threads > 0) {
        if (stage.fused()) {
            asked = {int{compute::fused_group_x}, int{compute::fused_group_y}, 0};
        } else if (asked.tile > 0) { // as list_active_tiles counts the groups of a tile
            asked = rim ? GroupSize{} : GroupSize{asked.tile, std::min(asked.tile, 256 / asked.tile), 0};
        }
        group.x = asked.x != 0 ? asked.x : std::min({rim ? limits.rim : 64, limits.x, limits.threads});
        group.y = asked.y != 0 ? asked.y : std::clamp(limits.threads / std::max(1, group.x), 1, std::min(rim ? 1 : 4, limits.y));
    }
    const bool fits =
        limits.threads == 0 || (group.x <= limits.x && group.y <= limits.y && std::int64_t{group.x} * group.y <= limits.threads);
    if (asked.x >= 0 && asked.y >= 0 && fits) return group;
    return error(Code::bad_argument, "group size of stage " + std::string(stage.name) + " is " + std::to_string(asked.x) + " x " +
                                         std::to_string(asked.y) + "; allowed are 0 to " + std::to_string(limits.x) + " x 0 to " +
                                         std::to_string(limits.y) + " and at most " + std::to_string(limits.threads) +
                                         " threads in all");
}

} // namespace wadi::backends
