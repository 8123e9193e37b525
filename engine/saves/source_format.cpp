#include "engine/saves/source_format.hpp"
#include "engine/saves/sealed_bytes.hpp"

namespace wadi {

namespace {

constexpr std::size_t source_head_bytes = 112, source_sample_bytes = 16;
constexpr TimeSeries Source::*source_series[] = {&Source::rate, &Source::discharge, &Source::level};

} // namespace

std::uint64_t source_bytes(const Source& source) {
    std::uint64_t bytes = source_head_bytes;
    for (const auto of : source_series) bytes += source_sample_bytes * (source.*of).samples.size();
    return bytes;
}

void put_source(std::span<std::byte> to, std::size_t& at, const Source& source) {
    for (const auto word : {std::uint32_t(source.shape), std::uint32_t(source.material), std::uint32_t{source.drain},
                            std::uint32_t{source.set_velocity}})
        put(to, at, word);
    const auto& [x0, y0, x1, y1] = source.box;
    for (const double number :
         {source.center[0], source.center[1], source.radius, x0, y0, x1, y1, source.velocity[0], source.velocity[1]})
        put(to, at, number);
    for (const auto of : source_series) put(to, at, std::uint64_t{(source.*of).samples.size()});
    for (const auto of : source_series)
        for (const auto& [time, value] : (source.*of).samples) {
            put(to, at, time);
            put(to, at, value);
        }
}

std::optional<Source> get_source(std::span<const std::byte> from, std::size_t& at) {
    if (at > from.size() || from.size() - at < source_head_bytes) return {};
    const auto word = [&] {
        at += 4;
        return get<std::uint32_t>(from, at - 4);
    };
    const auto number = [&] {
        at += 8;
        return get<double>(from, at - 8);
    };
    Source source;
    const std::uint32_t shape = word(), material = word();
    if (shape > static_cast<std::uint32_t>(SourceShape::box) || material > static_cast<std::uint32_t>(SourceMaterial::sand))
        return {};
    source.shape = static_cast<SourceShape>(shape);
    source.material = static_cast<SourceMaterial>(material);
    source.drain = word() != 0;
    source.set_velocity = word() != 0;
    for (double& value : source.center) value = number();
    source.radius = number();
    for (double& value : source.box) value = number();
    for (double& value : source.velocity) value = number();
    std::uint64_t counts[std::size(source_series)];
    for (auto& count : counts) {
        count = get<std::uint64_t>(from, at);
        at += 8;
    }
    for (std::size_t n = 0; n < std::size(source_series); ++n) {
        if (counts[n] > (from.size() - at) / source_sample_bytes) return {};
        for (std::uint64_t k = 0; k < counts[n]; ++k) {
            const double time = number();
            (source.*source_series[n]).samples.emplace_back(time, number());
        }
    }
    return source;
}

} // namespace wadi
