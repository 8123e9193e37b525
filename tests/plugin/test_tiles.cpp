// Tiles for collision shapes: ranges of heights, when they changed, and the regions that a host has to rebuild.
#include "tests/plugin/plugin_world.hpp"
#include <algorithm>
#include <initializer_list>

using namespace plugin_test;

namespace {

std::vector<wadi_tile> tiles_of(const World& world, uint64_t* step = nullptr) {
    uint32_t count = 0;
    REQUIRE_MESSAGE(wadi_world_get_tiles(world.id, nullptr, &count, step) == WADI_OK, std::string(wadi_get_last_error()));
    std::vector<wadi_tile> tiles(count);
    REQUIRE(wadi_world_get_tiles(world.id, tiles.data(), &count, step) == WADI_OK);
    return tiles;
}

std::vector<wadi_region> dirty(const World& world, int64_t since) {
    uint32_t count = 0;
    REQUIRE(wadi_world_get_dirty_regions(world.id, since, nullptr, &count, nullptr) == WADI_OK);
    std::vector<wadi_region> regions(count);
    REQUIRE(wadi_world_get_dirty_regions(world.id, since, regions.data(), &count, nullptr) == WADI_OK);
    return regions;
}

// The arrived tiles are those of the last update.
void update_and_arrive(const World& world, uint64_t nanoseconds) {
    world.update(nanoseconds);
    world.wait();
    world.update(0);
}

} // namespace

TEST_CASE("tiles hold the least and largest surfaces, and the step at which a cell changed") {
    for (const auto& backend : backends()) {
        for (const auto& [nx, ny] : {std::pair(100, 70), std::pair(64, 32), std::pair(5, 3)}) {
            CAPTURE(backend);
            CAPTURE(nx);
            const World world(backend, nx, ny);
            REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_TILES_BIT) == WADI_OK);
            uint32_t count = 0;
            CHECK(wadi_world_get_tiles(world.id, nullptr, &count, nullptr) == WADI_NOT_READY);
            update_and_arrive(world, 0);
            CHECK(dirty(world, -1).size() == static_cast<std::size_t>((ny + 31) / 32)); // whole rows of tiles
            CHECK(dirty(world, 0).empty());
            std::vector<int64_t> changed;
            for (const auto& tile : tiles_of(world)) changed.push_back(tile.changed_step);
            CHECK(std::all_of(changed.begin(), changed.end(), [](int64_t step) { return step == 0; }));
            auto solid_before = world.read(WADI_FIELD_SAND_DEPTH), free_before = world.read(WADI_FIELD_FREE_SURFACE);
            const auto terrain = world.read(WADI_FIELD_TERRAIN);
            for (std::size_t n = 0; n < terrain.size(); ++n) solid_before[n] += terrain[n];
            for (int round = 1; round <= 3; ++round) {
                update_and_arrive(world, 2 * step_time);
                auto solid = world.read(WADI_FIELD_SAND_DEPTH);
                for (std::size_t n = 0; n < terrain.size(); ++n) solid[n] += terrain[n];
                const auto free = world.read(WADI_FIELD_FREE_SURFACE);
                uint64_t step = 0;
                const auto tiles = tiles_of(world, &step);
                CHECK(step == static_cast<uint64_t>(2 * round));
                REQUIRE(tiles.size() == static_cast<std::size_t>((nx + 31) / 32 * ((ny + 31) / 32)));
                int dirty_cells = 0;
                for (std::size_t t = 0; t < tiles.size(); ++t) {
                    const auto& tile = tiles[t];
                    float least = 1e9F, most = -1e9F, free_least = 1e9F, free_most = -1e9F;
                    bool differs = false;
                    for (int j = tile.j; j < tile.j + tile.ny; ++j) {
                        for (int i = tile.i; i < tile.i + tile.nx; ++i) {
                            const auto c = static_cast<std::size_t>(j * nx + i);
                            least = std::min(least, solid[c]);
                            most = std::max(most, solid[c]);
                            free_least = std::min(free_least, free[c]);
                            free_most = std::max(free_most, free[c]);
                            differs |= solid[c] != solid_before[c] || free[c] != free_before[c];
                        }
                    }
                    if (differs) changed[t] = 2 * round;
                    dirty_cells += differs ? tile.nx * tile.ny : 0;
                    CHECK(tile.solid_min == least);
                    CHECK(tile.solid_max == most);
                    CHECK(tile.free_min == free_least);
                    CHECK(tile.free_max == free_most);
                    CHECK(tile.changed_step == changed[t]);
                }
                for (const auto& region : dirty(world, 2 * round - 2)) dirty_cells -= region.nx * region.ny;
                CHECK(dirty_cells == 0);
                if (nx == 100) {
                    CHECK(!dirty(world, 2 * round - 2).empty());
                    CHECK(tiles.back().changed_step == 0); // dry terrain far from sand and water
                }
                solid_before = solid;
                free_before = free;
            }
        }
    }
}

TEST_CASE("tiles refuse what they must, and write no further than they may") {
    const World world("cpu", 100, 70);
    uint32_t count = 1;
    CHECK(wadi_world_get_tiles(world.id, nullptr, &count, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("not asked for"));
    REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_TILES_BIT) == WADI_OK);
    update_and_arrive(world, 0);
    CHECK(wadi_world_get_tiles(world.id, nullptr, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_tiles({9, 9}, nullptr, &count, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_dirty_regions(world.id, -2, nullptr, &count, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("since_step"));
    CHECK(wadi_world_get_dirty_regions(world.id, 0, nullptr, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    wadi_tile tiles[2] = {};
    tiles[1].nx = -77;
    count = 1;
    REQUIRE(wadi_world_get_tiles(world.id, tiles, &count, nullptr) == WADI_OK);
    CHECK(count == 12);
    CHECK(tiles[0].nx == 32);
    CHECK(tiles[1].nx == -77);
    wadi_region regions[2] = {};
    regions[1].nx = -77;
    count = 1;
    REQUIRE(wadi_world_get_dirty_regions(world.id, -1, regions, &count, nullptr) == WADI_OK);
    CHECK(count == 3);
    CHECK(regions[0].nx == 100);
    CHECK(regions[1].nx == -77);
}
