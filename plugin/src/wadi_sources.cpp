// Sources of a running world: what they are, and others in their place.
#include "engine/saves/source_format.hpp"
#include "engine/settings/rules/messages.hpp"
#include "plugin/src/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

namespace {

constexpr SourceShape shapes[] = {SourceShape::disc, SourceShape::box, SourceShape::point}; // by wadi_source_shape
static_assert(WADI_SOURCE_DISC == 0 && WADI_SOURCE_BOX == 1 && WADI_SOURCE_POINT == 2);

Result<TimeSeries> series_of(const std::string& path, const wadi_sample* samples, std::uint32_t count) {
    if (count > SOURCE_SAMPLES_MOST)
        return error(Code::bad_argument, outside_text(path + "_count", count, 0, SOURCE_SAMPLES_MOST));
    if (samples == nullptr && count > 0)
        return error(Code::bad_argument, path + " is NULL, with " + std::to_string(count) + " samples");
    TimeSeries series;
    for (std::uint32_t n = 0; n < count; ++n) series.samples.emplace_back(samples[n].time, samples[n].value);
    return series;
}

Result<SourceChange> to_change(const std::string& path, std::uint32_t index, const wadi_source& s) {
    const auto refuse = [&](const std::string& text) { return error(Code::bad_argument, path + "." + text); };
    const auto yes_or_no = [](wadi_bool value) { return value == 0 || value == 1; };
    if (s.shape < WADI_SOURCE_DISC || s.shape > WADI_SOURCE_POINT)
        return refuse("shape: " + std::to_string(s.shape) + " is no wadi_source_shape (0 ... 2)");
    if (!yes_or_no(s.sand)) return refuse("sand: " + std::to_string(s.sand) + " is not 0 or 1");
    if (!yes_or_no(s.drain)) return refuse("drain: " + std::to_string(s.drain) + " is not 0 or 1");
    if (!yes_or_no(s.set_velocity)) return refuse("set_velocity: " + std::to_string(s.set_velocity) + " is not 0 or 1");
    if (s.player > UINT32_MAX) return refuse(player_text(s.player));
    SourceChange change;
    change.step = s.step;
    change.player = static_cast<std::uint32_t>(s.player);
    change.index = index;
    Source& source = change.source;
    source.shape = shapes[s.shape];
    source.material = s.sand == 1 ? SourceMaterial::sand : SourceMaterial::water;
    source.drain = s.drain == 1;
    source.center = {s.center[0], s.center[1]};
    source.radius = s.shape == WADI_SOURCE_DISC ? s.radius : 0;
    source.box = {s.from[0], s.from[1], s.to[0], s.to[1]};
    source.set_velocity = s.set_velocity == 1;
    source.velocity = {s.velocity[0], s.velocity[1]};
    auto rate = series_of(path + ".rate", s.rate, s.rate_count);
    auto discharge = series_of(path + ".discharge", s.discharge, s.discharge_count);
    auto level = series_of(path + ".level", s.level, s.level_count);
    for (const auto* series : {&rate, &discharge, &level})
        if (!*series) return series->status();
    source.rate = std::move(*rate);
    source.discharge = std::move(*discharge);
    source.level = std::move(*level);
    return change;
}

} // namespace

extern "C" {

wadi_result wadi_world_get_source(wadi_world_id id, uint32_t index, wadi_source* source) {
    constexpr const char* function = "wadi_world_get_source";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (auto status = understood(std::string(function) + ": source", source); !status) return report(status);
        const auto& sources = hosted.world->settings().sources;
        if (index >= sources.size())
            return bad_argument(std::string(function) + ": index: " + std::to_string(index) + "; the world has " +
                                std::to_string(sources.size()) + " sources");
        const Source& of = sources[index];
        wadi_source own = wadi_default_source();
        own.shape =
            static_cast<wadi_source_shape>(std::find(std::begin(shapes), std::end(shapes), of.shape) - std::begin(shapes));
        own.sand = of.material == SourceMaterial::sand ? 1 : 0;
        own.drain = of.drain ? 1 : 0;
        own.radius = of.radius;
        own.set_velocity = of.set_velocity ? 1 : 0;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            own.center[axis] = of.center[axis];
            own.from[axis] = of.box[axis];
            own.to[axis] = of.box[axis + 2];
            own.velocity[axis] = of.velocity[axis];
        }
        const auto give_series = [&](std::size_t n, const TimeSeries& series, const wadi_sample*& to, uint32_t& count) {
            auto& samples = hosted.samples[n];
            samples.clear();
            for (const auto& [time, value] : series.samples) samples.push_back({time, value});
            to = samples.empty() ? nullptr : samples.data();
            count = static_cast<uint32_t>(samples.size());
        };
        give_series(0, of.rate, own.rate, own.rate_count);
        give_series(1, of.discharge, own.discharge, own.discharge_count);
        give_series(2, of.level, own.level, own.level_count);
        give(source, own);
        return report(ok_status());
    });
}

wadi_result wadi_world_set_source(wadi_world_id id, uint32_t index, const wadi_source* source) {
    constexpr const char* function = "wadi_world_set_source";
    return with_world(function, id, [&](HostedWorld& hosted) {
        const std::string path = std::string(function) + ": source";
        if (auto status = understood(path, source); !status) return report(status);
        auto change = to_change(path, index, taken(source, wadi_default_source()));
        if (!change) return report(change.status());
        return report(hosted.world->commands().set_source(std::move(*change)));
    });
}

} // extern "C"
