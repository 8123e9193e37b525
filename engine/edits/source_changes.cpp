#include "engine/edits/source_changes.hpp"
#include "engine/saves/source_format.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>

namespace wadi {

namespace {

// What stands below a new source where none is: it brings nothing and takes nothing.
Source without_rate(Source source) {
    source.rate.samples = {{0, 0}};
    source.discharge.samples.clear();
    source.level.samples.clear();
    source.drain = source.set_velocity = false;
    return source;
}

} // namespace

Status SourceChanges::check(const std::string& function, const SourceChange& change) const {
    const Settings& settings = state_.settings();
    const Source& source = change.source;
    if (change.index >= MAX_SOURCES)
        return error(Code::bad_argument, outside_text(function + ": index", change.index, 0, MAX_SOURCES - 1));
    for (const auto& [name, series] :
         {std::pair("rate", &source.rate), std::pair("discharge", &source.discharge), std::pair("level", &source.level)})
        if (series->samples.size() > SOURCE_SAMPLES_MOST)
            return error(Code::bad_argument, function + ": source." + name + ": " + std::to_string(series->samples.size()) +
                                                 " samples are more than " + std::to_string(SOURCE_SAMPLES_MOST));
    if (auto status = check_source(settings, source, function + ": source"); !status) return status;
    auto status = check_allowed(settings, content_of(source));
    for (const auto& [name, force] : settings.effects)
        if (force == Force::off && name == "sources")
            status = error(Code::bad_argument, "effects.sources is forced off by the level");
    return status ? status : error(Code::bad_argument, function + ": " + status.message);
}

void SourceChanges::schedule(SourceChange change) {
    const TurnOfPlayer turn{change.step, change.player};
    waiting_.emplace(turn, std::move(change));
}

// What the world has stays, with the effects that it has: water that a source brought is there when the source brings no more.
Status SourceChanges::before_step() {
    const auto later = waiting_.upper_bound(last_of(state_.steps));
    if (later == waiting_.begin()) return ok_status();
    LiveSettings live = state_.settings().live();
    std::for_each(waiting_.begin(), later, [&](const auto& each) {
        const SourceChange& change = each.second;
        while (live.sources.size() <= change.index) live.sources.push_back(without_rate(change.source));
        live.sources[change.index] = change.source;
    });
    const std::uint32_t mask = state_.effects().mask;
    const Content content{state_.content.sand || (mask & EFFECT_SAND) != 0, state_.content.water || (mask & EFFECT_WATER) != 0};
    if (auto status = stepper_.change(live, content); !status) return status;
    waiting_.erase(waiting_.begin(), later);
    return ok_status();
}

std::uint64_t SourceChanges::undisturbed(std::uint64_t most) const {
    const auto later = waiting_.upper_bound(last_of(state_.steps));
    return later == waiting_.end() ? most : std::min(most, later->first.step - state_.steps);
}

} // namespace wadi
