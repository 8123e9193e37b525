#include "backends/registry.hpp"
#include "backends/common/front_end.hpp"
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

// "auto, cpu, vulkan": those of this build for which `chosen` holds.
std::string names_of(bool (*chosen)(const Backend&)) {
    std::string names = "auto";
    for (const auto& backend : all()) {
        if (chosen(backend)) names += std::string(", ") + backend.name;
    }
    return names;
}

const Backend* find(const std::string& name) {
    for (const auto& backend : all()) {
        if (name == backend.name) return &backend;
    }
    return nullptr;
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

std::vector<DeviceInfo> list_devices(const Backend& backend, std::string& why_none) {
    auto list = guarded([&]() -> Result<std::vector<DeviceInfo>> { return backend.enumerate(why_none); });
    if (list) return std::move(*list);
    why_none = list.status().message;
    return {};
}

Result<std::unique_ptr<Device>> open_device(const Backend& backend, int index, const DeviceOptions& options) {
    return guarded([&]() -> Result<std::unique_ptr<Device>> {
        auto device = backend.open(index, options);
        if (!device) return device.status();
        return std::unique_ptr<Device>(new FrontEnd(std::move(*device)));
    });
}

Result<std::unique_ptr<Device>> open_device(const std::string& wanted, int index, DeviceOptions options) {
    apply_environment(options);
    std::string name = wanted;
    const char* forced = std::getenv("WADI_BACKEND");
    if (name == "auto" && forced != nullptr && *forced != '\0') name = forced;
    const auto* backend = find(name);
    if (backend == nullptr && name != "auto") {
        return error(Code::not_found,
                     "no backend '" + name + "' in this build; known: " + names_of([](const Backend&) { return true; }));
    }
    if (options.host) {
        const auto* lending = lending_backend();
        if (lending == nullptr)
            return error(Code::not_supported, "a host's device was given, but this build has no backend for it");
        if (name == "auto" || backend == lending) return open_device(*lending, 0, options);
        if (!backend->borrows) {
            return error(Code::not_supported, "a host's device was given, but the backend is " + name +
                                                  "; on one or beside one run: " +
                                                  names_of([](const Backend& b) { return b.lend != nullptr || b.borrows; }));
        }
        auto lender = guarded([&] { return lending->lend(options); });
        if (!lender) return lender.status();
        options.lender = std::move(*lender);
    }
    std::string why;
    if (name == "auto") {
        for (const auto& b : all()) {
            for (const auto& info : list_devices(b, why)) {
                if (real_gpu(info.kind)) return open_device(b, info.index, options);
            }
        }
        backend = &all().front();
    }
    const auto devices = list_devices(*backend, why);
    if (devices.empty()) return error(Code::not_found, std::string("backend ") + backend->name + " has no device: " + why);
    if (index >= static_cast<int>(devices.size())) {
        return error(Code::not_found, std::string("backend ") + backend->name + " has no device " + std::to_string(index) +
                                          ", only 0 ... " + std::to_string(devices.size() - 1));
    }
    return open_device(*backend, index, options);
}

} // namespace wadi::backends
