// A fuzzed case: a world, what a host does to it, and how long it runs.
#pragma once
#include "engine/settings/data/edit.hpp"
#include "tests/conformance/inputs.hpp"
#include <cstdint>
#include <string>
#include <vector>

namespace wadi::fuzz {

class Random;

/// Everything fits into a level file: heights as maps, uniform velocities, edits as brushes and pushes.
struct Case {
    std::uint64_t seed = 0;
    conformance::Scene scene; // settings without edits, and fields
    std::vector<Edit> commands;
    int steps = 1;
    bool at_ends = false; // of settings' ranges, where floats say less than doubles
};

/// The case of a seed: any grid up to 64 x 64, content, material, method, sides, sources and edits that validate() lets pass.
Case make_case(std::uint64_t seed);

/// Sets some settings of a case, any that the schema knows, to ends of their ranges or next to nothing, as far as it stays valid.
/// Whether it did.
bool draw_ends(Random& random, Case& c);

/// Writes DIR/level.json with its maps. Errors: not_found.
Status write_level(const Case& c, const std::string& folder);
/// The case of a level file that write_level() wrote. Errors: load_level.
Result<Case> read_level(const std::string& path);

/// The case as its mirror image or transposed would be.
enum class Image { mirror_x, mirror_y, transpose };
Case image_of(const Case& c, Image image);

} // namespace wadi::fuzz
