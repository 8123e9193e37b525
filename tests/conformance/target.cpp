#include "tests/conformance/target.hpp"
#include "tests/support/borrowed_device.hpp"

namespace wadi::conformance {

std::vector<Target> all_targets() {
    std::vector<Target> targets;
    for (const auto& backend : backends::all()) {
        std::string why;
        for (const auto& info : backends::list_devices(backend, why)) targets.push_back({&backend, info});
    }
    return targets;
}

Session::Session(Target target, const compute::DeviceOptions& options)
    : target_(std::move(target)), options_(options), messages_(std::make_shared<std::vector<std::string>>()) {
    backends::apply_environment(options_);
    options_.log = [messages = messages_](int severity, const std::string& message) {
        if (severity <= 1) messages->push_back(message);
    };
}

Result<std::unique_ptr<compute::Device>> Session::fresh(compute::DeviceOptions options) {
    options.log = options_.log;
    return backends::open_device(*target_.backend, target_.info.index, options);
}

Result<compute::Device*> Session::device() {
    if (!device_) {
        auto opened = fresh(options_);
        if (!opened) return opened.status();
        device_ = std::move(*opened);
    }
    return device_.get();
}

Result<std::unique_ptr<compute::Device>> Session::borrow() {
    auto shared = device();
    if (!shared) return shared.status();
    return std::unique_ptr<compute::Device>(new test::BorrowedDevice(**shared));
}

std::vector<std::string> Session::take_messages() { return std::exchange(*messages_, {}); }

Result<std::unique_ptr<compute::Device>> open_plain_cpu() {
    compute::DeviceOptions options;
    options.threads = 1;
    options.instruction_set = "base";
    return backends::open_device("cpu", 0, options);
}

} // namespace wadi::conformance
