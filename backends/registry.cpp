#include "backends/registry.hpp"
#include <cstdlib>

namespace wadi::backends {

using compute::Device;
using compute::DeviceKind;
using compute::DeviceOptions;

namespace {

bool environment_switch(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0' && *value != '0';
}

std::string known_backends() {
    std::string names = "auto";
    for (const auto& backend : all()) names += std::string(", ") + backend.name;
    return names;
}

// The backend that runs on a host's device and lends from it; null where the build lacks it.
const Backend* lending_backend() {
    for (const auto& backend : all()) {
        if (backend.lend != nullptr) return &backend;
    }
    return nullptr;
}

bool real_gpu(DeviceKind kind) {
    return kind == DeviceKind::discrete_gpu || kind == DeviceKind::integrated_gpu || kind == DeviceKind::virtual_gpu;
}

} // namespace

void apply_environment(DeviceOptions& options) {
    options.validate |= environment_switch("WADI_VALIDATE");
    options.full_barriers |= environment_switch("WADI_FULL_BARRIERS");
    options.no_replay |= environment_switch("WADI_NO_REPLAY");
}

Result<std::unique_ptr<Device>> open_device(const std::string& wanted, int index, DeviceOptions options) {
    apply_environment(options);
    std::string name = wanted;
    const char* forced = std::getenv("WADI_BACKEND");
    if (name == "auto" && forced != nullptr && *forced != '\0') name = forced;
    std::string why;
    if (options.host) {
        const auto* lending = lending_backend();
        if (lending == nullptr)
            return error(Code::not_supported, "a host's Vulkan device was given, but this build has no Vulkan");
        if (name == "auto" || name == lending->name) return lending->open(0, options);
        if (name != "cuda") {
            return error(Code::not_supported, "a host's Vulkan device was given, but the backend is " + name +
                                                  "; on one run vulkan and auto, beside one cuda");
        }
        auto lender = lending->lend(options);
        if (!lender) return lender.status();
        options.lender = std::move(*lender);
    }
    if (name == "auto") {
        for (const auto& backend : all()) {
            for (const auto& info : backend.enumerate(why)) {
                if (real_gpu(info.kind)) return backend.open(info.index, options);
            }
        }
        name = "cpu";
    }
    for (const auto& backend : all()) {
        if (name != backend.name) continue;
        const auto devices = backend.enumerate(why);
        if (devices.empty()) return error(Code::not_found, "backend " + name + " has no device: " + why);
        if (index >= static_cast<int>(devices.size())) {
            return error(Code::not_found, "backend " + name + " has no device " + std::to_string(index) + ", only 0 ... " +
                                              std::to_string(devices.size() - 1));
        }
        return backend.open(index, options);
    }
    return error(Code::not_found, "no backend '" + name + "' in this build; known: " + known_backends());
}

} // namespace wadi::backends
