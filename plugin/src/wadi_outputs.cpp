// Published fields: views on the device, copies in host memory, tiles.
#include "plugin/src/output_arguments.hpp"

using namespace wadi;
using namespace wadi::plugin;

static_assert(WADI_OUTPUT_COUNT == static_cast<int>(Output::count) && WADI_OUTPUT_TILES_BIT == tiles_bit);
static_assert(WADI_OUTPUT_INTERPOLATED == static_cast<int>(OutputSet::interpolated));
static_assert(WADI_HANDLE_CUDA_POINTER == static_cast<int>(compute::NativeBuffer::Kind::cuda_pointer));

namespace {

Status check_mask(const char* function, uint32_t mask, uint32_t allowed) {
    if ((mask & ~allowed) == 0) return ok_status();
    return error(Code::bad_argument, std::string(function) + ": mask: bits " + std::to_string(mask & ~allowed) +
                                         " are no outputs; allowed are those of " + std::to_string(allowed));
}

wadi_format to_format(const OutputFormat& format) {
    return format.component_bytes == 2 ? WADI_FORMAT_R16G16B16A16_FLOAT : static_cast<wadi_format>(format.components);
}

} // namespace

extern "C" {

wadi_result wadi_world_set_outputs(wadi_world_id id, uint32_t mask) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        auto status = check_mask("wadi_world_set_outputs", mask, all_outputs | tiles_bit);
        return report(status ? hosted.world->outputs().set_mask(mask) : status);
    });
}

wadi_result wadi_world_set_host_outputs(wadi_world_id id, uint32_t mask) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        auto status = check_mask("wadi_world_set_host_outputs", mask, all_outputs);
        return report(status ? hosted.world->outputs().set_host_mask(mask) : status);
    });
}

wadi_result wadi_world_get_view(wadi_world_id id, wadi_output output, wadi_output_set set, wadi_output_view* view) {
    constexpr const char* function = "wadi_world_get_view";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (auto status = understood(std::string(function) + ": view", view); !status) return report(status);
        const auto found = view_of(function, hosted, output, set);
        if (!found) return report(found.status());
        wadi_output_view own = wadi_default_output_view();
        own.handle_kind = static_cast<wadi_handle_kind>(found->native.kind);
        own.handle = found->native.handle;
        own.offset = found->offset;
        own.row_pitch = found->row_pitch;
        own.buffer_bytes = found->native.bytes;
        own.nx = found->nx;
        own.ny = found->ny;
        own.format = to_format(found->format);
        own.step = found->step;
        own.finished = found->finished ? 1 : 0;
        give(view, own);
        return report(ok_status());
    });
}

wadi_result wadi_world_wait_for_outputs(wadi_world_id id) {
    constexpr const char* function = "wadi_world_wait_for_outputs";
    return with_world(function, id, [&](HostedWorld& hosted) { return report(named(function, hosted.world->outputs().wait())); });
}

wadi_result wadi_world_get_host_output(wadi_world_id id, wadi_output output, const float** data, uint64_t* row_pitch,
                                       uint64_t* step) {
    constexpr const char* function = "wadi_world_get_host_output";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (data == nullptr) return bad_argument(std::string(function) + ": data is NULL");
        if (auto status = check_output(function, output); !status) return report(status);
        auto found = hosted.world->outputs().host_view(static_cast<Output>(output));
        if (!found) return report(named(function, found.status()));
        *data = reinterpret_cast<const float*>(found->data);
        if (row_pitch != nullptr) *row_pitch = found->row_pitch;
        if (step != nullptr) *step = found->step;
        return report(ok_status());
    });
}

wadi_result wadi_world_get_tiles(wadi_world_id id, wadi_tile* tiles, uint32_t* count, uint64_t* step) {
    constexpr const char* function = "wadi_world_get_tiles";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument(std::string(function) + ": count is NULL");
        auto found = hosted.world->outputs().tiles();
        if (!found) return report(named(function, found.status()));
        const auto all = static_cast<uint32_t>(found->count());
        for (uint32_t n = 0; tiles != nullptr && n < std::min(*count, all); ++n) {
            const Tile tile = (*found)[static_cast<int>(n)];
            const auto& [i, j, nx, ny] = tile.cells;
            tiles[n] = {i, j, nx, ny, tile.solid_least, tile.solid_most, tile.free_least, tile.free_most, tile.changed_step};
        }
        *count = all;
        if (step != nullptr) *step = found->step;
        return report(ok_status());
    });
}

wadi_result wadi_world_get_dirty_regions(wadi_world_id id, int64_t since_step, wadi_region* regions, uint32_t* count,
                                         uint64_t* step) {
    constexpr const char* function = "wadi_world_get_dirty_regions";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument(std::string(function) + ": count is NULL");
        if (since_step < -1)
            return bad_argument(std::string(function) + ": since_step: " + std::to_string(since_step) + " is below -1");
        auto found = hosted.world->outputs().tiles();
        if (!found) return report(named(function, found.status()));
        uint32_t all = 0;
        for_dirty_regions(*found, since_step, [&](const Region& region) {
            if (regions != nullptr && all < *count) regions[all] = {region.i0, region.j0, region.nx, region.ny};
            ++all;
        });
        *count = all;
        if (step != nullptr) *step = found->step;
        return report(ok_status());
    });
}

} // extern "C"
