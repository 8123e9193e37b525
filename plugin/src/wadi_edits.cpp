// Brushes, stamps, pushes, written regions and changes of the material; effects that follow them.
#include "engine/settings/rules/cost.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include "engine/settings/rules/messages.hpp"
#include "plugin/src/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

namespace {

// What the engine's types cannot hold is refused here.
Result<Edit> to_edit(const wadi_edit* edits, uint32_t index) {
    const auto which = [&] { return "wadi_world_edit: edits[" + std::to_string(index) + "]"; };
    const auto refuse = [&](const std::string& text) { return error(Code::bad_argument, which() + "." + text); };
    const wadi_edit* const given = element(edits, index);
    if (given->struct_size != sizeof(wadi_edit)) { // the text is made for these alone: thousands of edits may come at once
        if (auto status = understood(which(), given); !status) return status;
    }
    if (given->struct_size != edits->struct_size) return refuse("struct_size is not that of edits[0]");
    const wadi_edit e = taken(given, wadi_default_edit());
    if (e.kind < WADI_EDIT_BRUSH || e.kind > WADI_EDIT_PUSH)
        return refuse("kind: " + std::to_string(e.kind) + " is no wadi_edit_kind (0 ... 2)");
    if (e.layer < WADI_LAYER_TERRAIN || e.layer > WADI_LAYER_WATER)
        return refuse("layer: " + std::to_string(e.layer) + " is no wadi_layer (0 ... 2)");
    if (e.player > UINT32_MAX) return refuse(player_text(e.player));
    Edit edit;
    edit.kind = static_cast<EditKind>(e.kind);
    edit.layer = static_cast<EditLayer>(e.layer);
    edit.capsule = e.capsule != 0;
    edit.step = e.step;
    edit.x0 = e.x0;
    edit.y0 = e.y0;
    edit.x1 = e.x1;
    edit.y1 = e.y1;
    edit.radius = e.radius;
    edit.softness = e.softness;
    edit.amount = e.amount;
    edit.strength = e.strength;
    edit.velocity_x = e.velocity_x;
    edit.velocity_y = e.velocity_y;
    edit.stamp = e.stamp;
    edit.player = static_cast<std::uint32_t>(e.player);
    return edit;
}

Region to_region(const wadi_region& r) { return {r.i0, r.j0, r.nx, r.ny}; }

Result<EditLayer> layer_of(const char* function, wadi_field field) {
    switch (field) {
    case WADI_FIELD_TERRAIN:
        return EditLayer::terrain;
    case WADI_FIELD_SAND_DEPTH:
        return EditLayer::sand;
    case WADI_FIELD_TOTAL_WATER_DEPTH:
        return EditLayer::water;
    default:
        return error(Code::bad_argument, std::string(function) + ": field " + std::to_string(static_cast<int>(field)) +
                                             " is not TERRAIN, SAND_DEPTH or TOTAL_WATER_DEPTH");
    }
}

Result<ValueSource> source_of(const wadi_device_values& values, const Region& region) {
    const auto refuse = [](const std::string& text) { return error(Code::bad_argument, "values." + text); };
    const int kind = static_cast<int>(values.handle_kind);
    if (kind < 0 || kind > WADI_HANDLE_CUDA_POINTER)
        return refuse("handle_kind: " + std::to_string(kind) + " is outside 0 ... 2");
    if (values.handle == 0) return refuse("handle is 0");
    if (values.offset % 4 != 0) return refuse("offset: " + std::to_string(values.offset) + " is no multiple of 4");
    const std::uint64_t row = static_cast<std::uint64_t>(region.nx) * 4, pitch = values.row_pitch != 0 ? values.row_pitch : row;
    if (pitch % 4 != 0 || pitch < row || pitch > std::uint64_t{1} << 40)
        return refuse("row_pitch: " + std::to_string(pitch) + " is no multiple of 4 from " + std::to_string(row) + " to 2^40");
    return ValueSource{static_cast<compute::NativeBuffer::Kind>(kind), values.handle, values.offset, pitch};
}

wadi_result give_log(const char* function, const std::vector<std::byte>& bytes, void* data, size_t& size) {
    const size_t room = size;
    size = bytes.size();
    if (data == nullptr) return report(ok_status());
    if (room < bytes.size())
        return bad_argument(std::string(function) + ": size is " + std::to_string(room) + ", the log needs " +
                            std::to_string(bytes.size()) + " bytes");
    std::memcpy(data, bytes.data(), bytes.size());
    return report(ok_status());
}

} // namespace

extern "C" {

wadi_result wadi_world_edit(wadi_world_id id, const wadi_edit* edits, uint32_t count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (edits == nullptr && count > 0) return bad_argument("wadi_world_edit: edits is NULL");
        std::vector<Edit>& list = hosted.edits;
        list.clear();
        for (uint32_t n = 0; n < count; ++n) {
            auto edit = to_edit(edits, n);
            if (!edit) return report(edit.status());
            list.push_back(*edit);
        }
        return report(hosted.world->commands().edit(list));
    });
}

wadi_result wadi_world_create_stamp(wadi_world_id id, int32_t nx, int32_t ny, const float* values, uint32_t* stamp) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (values == nullptr || stamp == nullptr) return bad_argument("wadi_world_create_stamp: values or stamp is NULL");
        const bool positive = nx > 0 && ny > 0;
        const auto pixels = positive ? static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) : 0;
        auto made = hosted.world->edits().create_stamp(nx, ny, {values, pixels});
        if (made) *stamp = *made;
        return report(made.status());
    });
}

wadi_result wadi_world_read_region(wadi_world_id id, wadi_field field, const wadi_region* region, float* values, size_t count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (region == nullptr) return bad_argument("wadi_world_read_region: region is NULL");
        if (plan_name(field) == nullptr)
            return bad_argument("wadi_world_read_region: no field " + std::to_string(static_cast<int>(field)));
        if (values == nullptr) return bad_argument("wadi_world_read_region: values is NULL");
        return report(hosted.world->reader().read(plan_name(field), to_region(*region), {values, count}));
    });
}

wadi_result wadi_world_write_region(wadi_world_id id, wadi_field field, const wadi_region* region, const float* values,
                                    size_t count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (region == nullptr) return bad_argument("wadi_world_write_region: region is NULL");
        if (values == nullptr) return bad_argument("wadi_world_write_region: values is NULL");
        const auto layer = layer_of("wadi_world_write_region", field);
        if (!layer) return report(layer.status());
        return report(hosted.world->commands().write_region(*layer, to_region(*region), {values, count}));
    });
}

wadi_result wadi_world_write_region_from(wadi_world_id id, wadi_field field, const wadi_region* region,
                                         const wadi_device_values* values) {
    constexpr const char* function = "wadi_world_write_region_from";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (region == nullptr) return bad_argument(std::string(function) + ": region is NULL");
        if (auto status = understood(std::string(function) + ": values", values); !status) return report(status);
        const auto layer = layer_of(function, field);
        if (!layer) return report(layer.status());
        const Region cells = to_region(*region);
        if (auto status = check_region(function, cells, hosted.world->settings().grid, cells.cells()); !status)
            return report(status);
        auto from = source_of(taken(values, wadi_default_device_values()), cells);
        if (!from) return report(named(function, from.status()));
        return report(named(function, hosted.world->commands().write_values(*layer, cells, *from)));
    });
}

wadi_result wadi_world_prepare_effects(wadi_world_id id) {
    return with_world(__func__, id, [&](HostedWorld& hosted) { return report(hosted.world->stepper().prepare()); });
}

wadi_result wadi_world_trim(wadi_world_id id) {
    return with_world(__func__, id, [&](HostedWorld& hosted) { return report(hosted.world->commands().trim()); });
}

wadi_result wadi_world_get_material(wadi_world_id id, wadi_material_info* infos, uint32_t* count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument("wadi_world_get_material: count is NULL");
        const auto keys = material_keys();
        const uint32_t capacity = infos != nullptr ? *count : 0;
        *count = static_cast<uint32_t>(keys.size());
        for (uint32_t n = 0; n < std::min(capacity, *count); ++n) {
            copy_text(infos[n].name, keys[n].name);
            infos[n].value = material_value(hosted.world->settings().material, static_cast<int>(n));
            infos[n].least = keys[n].least;
            infos[n].most = keys[n].most;
        }
        return report(ok_status());
    });
}

wadi_result wadi_world_set_material(wadi_world_id id, const char* name, double value) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (name == nullptr) return bad_argument("wadi_world_set_material: name is NULL");
        const int key = find_material_key(name);
        if (key >= 0) return report(hosted.world->commands().set_material(key, value));
        std::vector<std::string> known;
        for (const auto& k : material_keys()) known.push_back(k.name);
        return report(error(Code::not_found, std::string("wadi_world_set_material: the material has no number \"") + name + "\"" +
                                                 suggestion(name, known)));
    });
}

wadi_result wadi_world_set_command_log(wadi_world_id id, int32_t on) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        hosted.world->commands().remember(on != 0);
        return report(ok_status());
    });
}

wadi_result wadi_world_get_commands(wadi_world_id id, void* data, size_t* size) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (size == nullptr) return bad_argument("wadi_world_get_commands: size is NULL");
        return give_log("wadi_world_get_commands", hosted.world->commands().bytes(), data, *size);
    });
}

wadi_result wadi_world_get_commands_since(wadi_world_id id, uint64_t step, uint64_t player, void* data, size_t* size) {
    constexpr const char* function = "wadi_world_get_commands_since";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (size == nullptr) return bad_argument(std::string(function) + ": size is NULL");
        const bool every = player == WADI_EVERY_PLAYER;
        if (!every && player > UINT32_MAX) return bad_argument(std::string(function) + ": " + player_text(player));
        const auto of = every ? std::nullopt : std::optional(static_cast<std::uint32_t>(player));
        return give_log(function, hosted.world->commands().bytes(step, of), data, *size);
    });
}

wadi_result wadi_world_play_commands(wadi_world_id id, const void* data, size_t size) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (data == nullptr) return bad_argument("wadi_world_play_commands: data is NULL");
        const std::span bytes(static_cast<const std::byte*>(data), size);
        if (hosted.most) {
            const auto cost = hosted.world->commands().cost(bytes);
            if (!cost) return report(cost.status());
            if (auto status = check_cost("command log", *cost, *hosted.most); !status) return report(status);
        }
        return report(hosted.world->commands().play(bytes));
    });
}

} // extern "C"
