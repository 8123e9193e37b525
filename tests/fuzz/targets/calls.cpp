// libFuzzer: any sequence of calls on the C interface, right and wrong ones, answers with a code.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>
#include <wadi/wadi_cuda.h>

namespace {

/// Numbers out of the input; 0 once it ends.
struct Input {
    const std::uint8_t* at;
    const std::uint8_t* end;
    std::uint8_t byte() { return at < end ? *at++ : std::uint8_t{0}; }
    /// Often near zero, sometimes any bits.
    double number() {
        const std::uint8_t kind = byte();
        if (kind < 200) return (kind - 100) / 16.0;
        double value = 0;
        std::uint8_t bits[8];
        for (auto& b : bits) b = byte();
        std::memcpy(&value, bits, 8);
        return value;
    }
    std::uint32_t whole() {
        const std::uint8_t kind = byte();
        return kind < 240 ? kind % 12 : static_cast<std::uint32_t>(byte()) << 24 | byte();
    }
};

const char* const LEVEL = R"({ "format_version": 1, "name": "calls", "grid": { "nx": 5, "ny": 4, "dx": 0.5 }, "dt": 0.02,
    "water": [ { "shape": "plane", "height": 0.5 } ] })";

void call(Input& in, wadi_world_id& world, std::vector<unsigned char>& snapshot, std::vector<unsigned char>& log) {
    float cells[20];
    switch (in.byte() % 20) {
    case 0:
        wadi_world_step(world, in.whole() % 5);
        break;
    case 1: {
        auto edit = wadi_default_edit();
        edit.kind = static_cast<wadi_edit_kind>(in.whole());
        edit.layer = static_cast<wadi_layer>(in.whole());
        edit.step = in.whole();
        edit.stamp = in.whole();
        edit.x0 = in.number(), edit.y0 = in.number(), edit.x1 = in.number(), edit.y1 = in.number();
        edit.radius = in.number(), edit.softness = in.number(), edit.amount = in.number();
        wadi_world_edit(world, &edit, in.byte() % 2);
        break;
    }
    case 2:
        wadi_world_read_field(world, static_cast<wadi_field>(in.byte() % 8), cells, in.byte() < 200 ? 20 : in.byte() % 20);
        break;
    case 3: {
        auto stats = wadi_default_world_stats();
        wadi_world_get_stats(world, &stats);
        break;
    }
    case 4: {
        std::size_t size = 0;
        if (wadi_world_save(world, nullptr, &size) != WADI_OK) break;
        snapshot.resize(size);
        if (wadi_world_save(world, snapshot.data(), &size) != WADI_OK) snapshot.clear();
        break;
    }
    case 5: {
        auto bytes = snapshot;
        if (!bytes.empty() && in.byte() > 200) bytes[in.whole() % bytes.size()] ^= in.byte();
        wadi_world_load(world, bytes.data(), bytes.size());
        break;
    }
    case 6:
        wadi_world_set_rollback(world, in.whole() % 300, in.whole());
        break;
    case 7:
        wadi_world_roll_back(world, in.whole(), nullptr);
        break;
    case 8:
        wadi_world_set_outputs(world, in.whole());
        break;
    case 9: {
        auto frame = wadi_default_frame();
        wadi_world_update(world, in.whole() * 7'000'000ull, &frame);
        break;
    }
    case 10: {
        const float xy[4] = {static_cast<float>(in.number()), static_cast<float>(in.number()), 1, 1};
        std::uint64_t ticket = 0;
        wadi_world_query(world, xy, in.byte() % 3, &ticket);
        wadi_query_result results[4];
        std::uint32_t count = 0;
        wadi_world_get_query(world, ticket, results, in.byte() % 5, &count, nullptr);
        break;
    }
    case 11:
        wadi_world_trim(world);
        break;
    case 12:
        wadi_world_set_command_log(world, in.byte() % 2);
        break;
    case 13: {
        std::size_t size = 0;
        if (wadi_world_get_commands(world, nullptr, &size) != WADI_OK) break;
        log.resize(size);
        if (wadi_world_get_commands(world, log.data(), &size) != WADI_OK) log.clear();
        break;
    }
    case 14:
        wadi_world_play_commands(world, log.data(), log.size());
        break;
    case 15: {
        const wadi_region region{static_cast<std::int32_t>(in.whole()), static_cast<std::int32_t>(in.whole()),
                                 static_cast<std::int32_t>(in.whole()), static_cast<std::int32_t>(in.whole())};
        for (float& c : cells) c = static_cast<float>(in.number());
        wadi_world_write_region(world, static_cast<wadi_field>(in.byte() % 8), &region, cells, in.byte() % 21);
        break;
    }
    case 16: {
        std::uint32_t stamp = 0;
        for (float& c : cells) c = static_cast<float>(in.number());
        wadi_world_create_stamp(world, static_cast<std::int32_t>(in.whole() % 6), static_cast<std::int32_t>(in.whole() % 4),
                                cells, &stamp);
        break;
    }
    case 18: {
        const wadi_region region{static_cast<std::int32_t>(in.whole()), static_cast<std::int32_t>(in.whole()),
                                 static_cast<std::int32_t>(in.whole() % 3), static_cast<std::int32_t>(in.whole() % 3)};
        for (float& c : cells) c = static_cast<float>(in.number());
        auto values = wadi_default_device_values(); // of at most 2 x 2 cells: within the 20
        values.handle_kind = static_cast<wadi_handle_kind>(in.byte() < 200 ? 0 : in.whole());
        values.handle = in.byte() < 200 ? reinterpret_cast<std::uintptr_t>(cells) : 0;
        values.offset = in.byte() % 24;
        values.row_pitch = in.byte() % 48;
        wadi_world_write_region_from(world, static_cast<wadi_field>(in.byte() % 8), &region, &values);
        break;
    }
    case 17: // no world here takes events: nobody looks into it
        (in.byte() % 2 == 0 ? wadi_cuda_wait : wadi_cuda_signal)(world, in.byte() % 2 == 0 ? nullptr : cells);
        break;
    default:
        if (in.byte() > 100) break;
        wadi_destroy_world(world); // calls go on with a dead id
    }
    if (wadi_get_last_error() == nullptr) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 1;
    wadi_world_id world{};
    if (wadi_create_world_from_level_text(LEVEL, nullptr, nullptr, nullptr, &options, &world) != WADI_OK) std::abort();
    Input in{data, data + size};
    std::vector<unsigned char> snapshot, log;
    for (int n = 0; n < 60 && in.at < in.end; ++n) call(in, world, snapshot, log);
    wadi_destroy_world(world);
    return 0;
}
