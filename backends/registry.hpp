// The backends of this build, and opening a device by name: the only place that chooses between them.
#pragma once
#include "backends/common/backend.hpp"
#include <span>

namespace wadi::backends {

/// All backends of this build, the CPU first. Defined in a file that CMake writes: no code names a backend.
std::span<const Backend> all();

/// The devices of a backend; empty with a reason.
std::vector<DeviceInfo> list_devices(const Backend& backend, std::string& why_none);

/// Reads WADI_VALIDATE, WADI_FULL_BARRIERS and WADI_NO_REPLAY into options that the caller left off.
void apply_environment(compute::DeviceOptions& options);

/// Opens a backend's device (-1 = its best), behind the front end.
Result<std::unique_ptr<compute::Device>> open_device(const Backend& backend, int index, const compute::DeviceOptions& options);

/// Opens `name` ("auto" or the name of a backend), device `index` (-1 = the backend's best).
/// auto: a real GPU first, else the CPU; a software GPU only when asked for by name.
/// Errors: not_found, listing what there is.
Result<std::unique_ptr<compute::Device>> open_device(const std::string& name, int index, compute::DeviceOptions options);

} // namespace wadi::backends
