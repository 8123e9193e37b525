#include "backends/cuda/context.hpp"
#include "backends/cuda/device_list.hpp"
#include "backends/cuda/stages.hpp"
#include <algorithm>

namespace wadi::cuda {
namespace {

// Stages compute their indices as int, so a buffer of floats ends before 2^31 elements.
constexpr std::uint64_t largest_indexed_buffer = std::uint64_t{4} << 31;

// The GPU that the lender lends from.
Result<ListedDevice> choose_beside(const compute::Lender& lender, const std::vector<ListedDevice>& devices, int index) {
    const auto same =
        std::find_if(devices.begin(), devices.end(), [&](const ListedDevice& d) { return d.uuid == lender.device_uuid(); });
    const std::string name = "the host's Vulkan device " + lender.device_name();
    if (same == devices.end()) return error(Code::not_found, name + " is no CUDA device");
    if (index >= 0 && index != same->info.index) {
        return error(Code::bad_argument,
                     name + " is CUDA device " + std::to_string(same->info.index) + ", not " + std::to_string(index));
    }
    return *same;
}

Result<ListedDevice> choose(int index, const compute::Lender* lender) {
    std::string why;
    const std::vector<ListedDevice> devices = list_devices(why);
    if (devices.empty()) return error(Code::not_found, "no CUDA device: " + why);
    if (lender != nullptr) return choose_beside(*lender, devices, index);
    const int wanted = index < 0 ? 0 : index;
    if (wanted < static_cast<int>(devices.size())) return devices[static_cast<std::size_t>(wanted)];
    std::string list;
    for (const auto& d : devices) list += (list.empty() ? "" : ", ") + std::to_string(d.info.index) + " = " + d.info.name;
    return error(Code::not_found, "no CUDA device " + std::to_string(index) + "; there is " + list);
}

Status read_capabilities(Context& c, const ListedDevice& chosen) {
    int driver = 0;
    if (Status s = c.check(cudaDriverGetVersion(&driver), "cudaDriverGetVersion"); !s) return s;
    c.capabilities.backend = "cuda";
    c.capabilities.name = chosen.info.name;
    c.capabilities.driver = "driver for CUDA " + version_text(driver) + ", runtime " + version_text(CUDART_VERSION) +
                            ", compute capability " + capability_text(chosen.capability);
    c.capabilities.kind = chosen.info.kind;
    c.capabilities.memory_bytes = chosen.info.memory_bytes;
    c.capabilities.largest_buffer_bytes = std::min(chosen.info.memory_bytes, largest_indexed_buffer) / 4 * 4;
    c.capabilities.groups = {largest_group, largest_group, largest_group, 256};
    c.capabilities.timestamps = true;
    c.tuning.fused_gain_cells = std::int64_t{1} << 16; // H100: below it too few groups fill the GPU (engine/step/README.md)
    c.tuning.fused_slopes = true;                      // as many registers as they want, which Vulkan cannot ask for
    c.tuning.tiles_gain_cells = std::int64_t{1} << 20;
    c.capabilities.fused_stages = true; // every architecture that is compiled for has 48 KiB a group
    return ok_status();
}

} // namespace

Result<std::unique_ptr<Context>> Context::open(int index, const compute::DeviceOptions& options) {
    auto context = std::make_unique<Context>();
    Context& c = *context;
    c.options = options;
    const auto chosen = choose(index, options.lender.get());
    if (!chosen) return chosen.status();
    if (Status s = read_capabilities(c, chosen.value()); !s) return s;
    auto driver = load_driver();
    if (!driver) return driver.status();
    c.driver = *driver;
    // The runtime keeps a reference of its own from here on: the context outlives this device, so that opening again is quick.
    if (Status s = c.check(cudaInitDevice(chosen.value().ordinal, 0, 0), "cudaInitDevice", c.capabilities.name); !s) return s;
    if (Status s = c.check(c.driver.device_get(&c.device, chosen.value().ordinal), "cuDeviceGet"); !s) return s;
    if (Status s = c.check(c.driver.retain_primary_context(&c.context, c.device), "cuDevicePrimaryCtxRetain"); !s) return s;
    const CurrentContext current(c);
    // Not ordered with the legacy default stream, on which other CUDA code of the process may be at work.
    const cudaError_t made = cudaStreamCreateWithFlags(&c.stream, cudaStreamNonBlocking);
    if (Status s = c.check(made, "cudaStreamCreateWithFlags"); !s) return s;
    if (options.validate) c.log(2, "CUDA has no validation layers; run the program under compute-sanitizer instead");
    return context;
}

Context::~Context() {
    if (context == nullptr) return;
    if (stream != nullptr) {
        const CurrentContext current(*this);
        note(cudaStreamDestroy(stream), "cudaStreamDestroy");
    }
    note(static_cast<cudaError_t>(driver.release_primary_context(device)), "cuDevicePrimaryCtxRelease");
}

Status Context::check(cudaError_t result, std::string_view what, std::string_view label) {
    if (result == cudaSuccess) return ok_status();
    static_cast<void>(cudaGetLastError()); // else the runtime would report it again from a later call
    std::string message(what);
    if (!label.empty()) message.append(" of '").append(label).append("'");
    message.append(": ").append(error_text(result));
    const Code code = code_of(result);
    if (code != Code::device_lost) return error(code, std::move(message));
    lose(std::move(message));
    return lost_status();
}

void Context::note(cudaError_t result, std::string_view what, std::string_view label) {
    const bool known = lost;
    if (Status s = check(result, what, label); !s && !known) log(1, s.message);
}

void Context::lose(std::string reason) {
    if (!lost) lost_reason = std::move(reason);
    lost = true;
}

Status Context::lost_status() const {
    return error(Code::device_lost, "the CUDA device " + capabilities.name + " is lost (" + lost_reason +
                                        "); CUDA gives it back only to a new process");
}

void Context::wait_idle() {
    const CurrentContext current(*this);
    note(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
}

void Context::log(int severity, const std::string& message) const {
    if (options.log) options.log(severity, "cuda: " + message);
}

CurrentContext::CurrentContext(Context& context)
    : c_(context), pushed_(context.check(context.driver.push_context(context.context), "cuCtxPushCurrent").code == Code::ok) {}

CurrentContext::~CurrentContext() {
    CUcontext ours = nullptr;
    if (pushed_) c_.note(static_cast<cudaError_t>(c_.driver.pop_context(&ours)), "cuCtxPopCurrent");
}

} // namespace wadi::cuda
