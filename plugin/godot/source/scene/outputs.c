#include "terrain.h"

wadi_result world_set_outputs(Terrain* terrain) {
    const wadi_output_mask mask = (wadi_output_mask)terrain->outputs;
    const wadi_output_mask heights = terrain->heights_asked ? WADI_OUTPUT_BIT(WADI_OUTPUT_SAND_SURFACE) : 0;
    const wadi_output_mask on_device = terrain->textures.shared ? mask : 0, on_host = terrain->textures.shared ? 0 : mask;
    terrain->updates_due = 2;
    wadi_result result = wadi_world_set_outputs(terrain->world, on_device | WADI_OUTPUT_TILES_BIT);
    if (result == WADI_OK) result = wadi_world_set_host_outputs(terrain->world, on_host | heights);
    return result;
}
