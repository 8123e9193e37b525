// Mirrored and transposed scenes, and whether two worlds are each other's image in bits.
#pragma once
#include "tests/conformance/worlds.hpp"

namespace wadi::conformance {

enum class Symmetry { mirror_x, mirror_y, transpose };

Scene image_of(const Scene& scene, Symmetry symmetry);
/// Zeros of either sign are equal; everything else to the bit.
Verdict compare_images(World& world, World& image, Symmetry symmetry);

} // namespace wadi::conformance
