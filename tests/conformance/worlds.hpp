// Worlds on a device under test.
#pragma once
#include "engine/world.hpp"
#include "tests/conformance/case.hpp"
#include "tests/conformance/inputs.hpp"
#include "tests/conformance/target.hpp"
#include <memory>

namespace wadi::conformance {

/// A World on the session's shared device.
Result<std::unique_ptr<World>> open_world(Session& session, const Scene& scene);
/// A World on a device of its own with these options.
Result<std::unique_ptr<World>> open_world(Session& session, const Scene& scene, const compute::DeviceOptions& options);

/// Every state field of both, ghosts included, equal to the bit.
Verdict same_state(World& got, World& expected);

} // namespace wadi::conformance
