#include "engine/settings/rules/level_digest.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/checksum.hpp"
#include <span>
#include <string_view>

namespace wadi {

std::uint64_t level_digest(const Settings& s) {
    Checksum sum;
    const auto add = [&](double value) { sum.add(std::as_bytes(std::span(&value, 1))); };
    const auto series = [&](const TimeSeries& t) {
        add(static_cast<double>(t.samples.size()));
        for (const auto& [time, value] : t.samples) {
            add(time);
            add(value);
        }
    };
    sum.add(std::as_bytes(std::span(s.method.name)));
    for (const Setting& row : setting_table()) {
        const double value = row.at.get(s);
        const bool set = row.in_digest == InDigest::where_set && value != row.normal();
        if (set) sum.add(std::as_bytes(std::span(std::string_view(row.path)))); // which of them: the others add nothing
        if (set || row.in_digest == InDigest::yes) add(value);
    }
    for (const auto& side : s.sides) {
        add(static_cast<double>(side.kind));
        add(side.from);
        add(side.to);
        series(side.value);
        if (side.depth > 0) add(side.depth);
        if (!side.wave.samples.empty()) series(side.wave);
        if (side.absorb > 0) add(side.absorb);
        if (side.slope > 0) add(side.slope);
        if (side.sediment >= 0) add(side.sediment);
    }
    for (const auto& source : s.sources) {
        for (const double value :
             {double(source.shape), double(source.material), source.center[0], source.center[1], source.radius, source.box[0],
              source.box[1], source.box[2], source.box[3], double(source.set_velocity), source.velocity[0], source.velocity[1]})
            add(value);
        series(source.rate);
        if (!source.discharge.samples.empty()) series(source.discharge);
        if (!source.level.samples.empty()) {
            series(source.level);
            add(double(source.drain));
        }
    }
    series(s.rain);
    series(s.evaporation);
    for (const auto& [edit, time, every, until, move] : s.edits) {
        for (const double value :
             {double(edit.kind), double(edit.layer), double(edit.capsule), edit.x0, edit.y0, edit.x1, edit.y1, edit.radius,
              edit.softness, edit.amount, edit.strength, edit.velocity_x, edit.velocity_y, time, every, until, move[0], move[1]})
            add(value);
    }
    if (!s.roughness.empty()) sum.add(std::as_bytes(std::span(s.roughness)));
    if (!s.rain_map.empty()) {
        sum.add(std::as_bytes(std::span("rain_map"))); // the same numbers as roughness are another level
        sum.add(std::as_bytes(std::span(s.rain_map)));
    }
    return sum.value();
}

} // namespace wadi
