// The first pass and cell at which a device's step differs, after a comparison of whole steps has failed.
#pragma once
#include "tests/conformance/inputs.hpp"
#include "tests/conformance/target.hpp"
#include <string>

namespace wadi::conformance {

/// Runs the step's passes one by one beside the reference solver's stages.
std::string locate_against_reference(compute::Device& device, const Scene& scene, int steps);

/// Gives every pass on the device the very inputs the pass has on `other` and compares what both write in bits.
std::string locate_against_device(compute::Device& device, compute::Device& other, const Scene& scene, int steps);

} // namespace wadi::conformance
