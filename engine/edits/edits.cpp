#include "engine/edits/edits.hpp"
#include "engine/settings/rules/scripted_edits.hpp"
#include "engine/step/run/step_number.hpp"
#include <algorithm>

namespace wadi {

Edits::Edits(WorldState& state, Stepper& stepper)
    : state_(state), stepper_(stepper), program_(state, "edits", [this](compute::ProgramBuilder& builder, const Parity& parity) {
          return state_.append_stage(builder, "apply_edits", parity, {{"stamp_images", images_}});
      }) {}

Status Edits::check(const char* function, std::span<const Edit> edits, std::span<const Stamp> stamps) const {
    for (std::size_t n = 0; n < edits.size(); ++n) {
        if (auto status = check_edit(function, n, edits[n], state_.settings(), stamps, next_step()); !status) return status;
    }
    return ok_status();
}

void Edits::schedule(const Edit& edit) { waiting_.emplace(TurnOfPlayer{edit.step, edit.player}, edit); }

Result<std::uint32_t> Edits::create_stamp(int nx, int ny, std::span<const float> values) {
    if (auto status = check_stamp("create_stamp", nx, ny, values); !status) return status;
    Stamp stamp{nx, ny, {values.begin(), values.end()}, 0, 0, pages_used_};
    stamp.set_range();
    const std::uint64_t end = pages_used_ + (values.size() + STAMP_PAGE - 1) / STAMP_PAGE;
    if (auto status = make_room(end); !status) return status;
    if (auto status = upload(stamp); !status) return status;
    stamps_.push_back(std::move(stamp));
    pages_used_ = end;
    return static_cast<std::uint32_t>(stamps_.size());
}

Status Edits::upload(const Stamp& stamp) {
    return state_.device().write(images_, stamp.page * STAMP_PAGE * 4, std::as_bytes(std::span(stamp.values)));
}

// Grows by doubling; the images move to the new buffer.
Status Edits::make_room(std::uint64_t pages) {
    if (pages <= pages_) return ok_status();
    const std::uint64_t wanted = std::max(pages, 2 * pages_);
    auto made = state_.device().create_buffer({wanted * STAMP_PAGE * 4, "stamps"});
    if (!made) return made.status();
    program_.forget();
    state_.device().destroy_buffer(images_);
    images_ = *made;
    pages_ = wanted;
    for (const auto& stamp : stamps_) {
        if (auto status = upload(stamp); !status) return status;
    }
    return ok_status();
}

void Edits::forget() {
    waiting_.clear();
    due_.clear();
    scripted_from_ = state_.steps;
}

// Where this or the step's own submission fails, the step is asked for again: each edit is taken once, and stays due until it
// was submitted.
Status Edits::before_step() {
    if (state_.steps >= scripted_from_) {
        append_scripted_edits(state_.settings(), state_.steps, due_);
        scripted_from_ = state_.steps + 1;
    }
    const auto later = waiting_.upper_bound(last_of(state_.steps));
    std::for_each(waiting_.begin(), later, [&](const auto& edit) { due_.push_back(edit.second); });
    waiting_.erase(waiting_.begin(), later);
    if (due_.empty()) return ok_status();
    if (auto status = promote(); !status) return status;
    if (auto status = make_room(1); !status) return status;
    return submit();
}

std::uint64_t Edits::undisturbed(std::uint64_t most) const {
    const auto later = waiting_.upper_bound(last_of(state_.steps));
    if (later != waiting_.end()) most = std::min(most, later->first.step - state_.steps);
    std::vector<Edit> scripted;
    for (std::uint64_t n = 1; n < most; ++n) {
        append_scripted_edits(state_.settings(), state_.steps + n, scripted);
        if (!scripted.empty()) return n;
    }
    return most;
}

Status Edits::promote() {
    Content content = state_.content;
    EditInput packed;
    for (const Edit& edit : due_) {
        if (!pack_edit(edit, stamps_, state_.settings().grid, packed)) continue;
        const Content brought = content_brought(edit, stamps_);
        content.sand |= brought.sand;
        content.water |= brought.water;
    }
    return content == state_.content ? ok_status() : stepper_.set_content(content);
}

Status Edits::submit() {
    if (recorded_with_ != state_.settings().material) {
        program_.forget();
        recorded_with_ = state_.settings().material;
    }
    while (!due_.empty()) {
        StepInput input{};
        input.step = stage_step(state_.steps);
        std::size_t taken = 0;
        for (; taken < due_.size() && input.edit_count < MAX_EDITS; ++taken) {
            if (pack_edit(due_[taken], stamps_, state_.settings().grid, input.edit[input.edit_count])) ++input.edit_count;
        }
        if (input.edit_count > 0) {
            state_.tiles().wake_edits(input);
            if (auto ticket = program_.submit(input); !ticket) return ticket.status();
        }
        due_.erase(due_.begin(), due_.begin() + static_cast<std::ptrdiff_t>(taken));
    }
    return ok_status();
}

} // namespace wadi
