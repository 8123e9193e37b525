// The edits that a level brings along: which of them act ahead of a step.
#pragma once
#include "engine/settings/data/settings.hpp"

namespace wadi {

/// Appends the edits that act ahead of the step with this number, in the level's order. It follows from settings and step alone,
/// so a world that goes back in time meets them again.
void append_scripted_edits(const Settings& settings, std::uint64_t step, std::vector<Edit>& to);

/// ok, or bad_argument that names edits[index], its field and the range.
Status check_scripted_edit(const Settings& settings, std::size_t index);

/// The most edits that fall into one step; where turns are too many to count one by one, as many as may.
std::uint64_t most_edits_per_step(const Settings& settings);

/// ok, or bad_argument where the checked edits bring more than STEP_EDITS_MOST into a step, with how many and when.
Status check_edits_per_step(const Settings& settings);

} // namespace wadi
