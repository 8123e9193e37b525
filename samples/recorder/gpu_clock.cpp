#include "gpu_clock.hpp"
#include "../common/platform.hpp"
#include <algorithm>

namespace recorder {
namespace {

// NVML's C interface; its header is in no free package. Every call returns 0 for success.
using Start = int();
using GetCount = int(unsigned*);
using GetDevice = int(unsigned, void**);
using GetName = int(void*, char*, unsigned);
using GetClock = int(void*, int, unsigned*);
constexpr int MULTIPROCESSOR_CLOCK = 1;
constexpr unsigned NAME_BYTES = 96;

} // namespace

struct GpuClock::Library {
    common::SharedLibrary file;
    Start* start = nullptr;
    Start* stop = nullptr;
    GetCount* get_count = nullptr;
    GetDevice* get_device = nullptr;
    GetName* get_name = nullptr;
    GetClock* get_clock = nullptr;

    bool load() {
        return file.open({"libnvidia-ml.so.1", "nvml.dll"}) && file.find("nvmlInit_v2", start) &&
               file.find("nvmlShutdown", stop) && file.find("nvmlDeviceGetCount_v2", get_count) &&
               file.find("nvmlDeviceGetHandleByIndex_v2", get_device) && file.find("nvmlDeviceGetName", get_name) &&
               file.find("nvmlDeviceGetClockInfo", get_clock) && start() == 0;
    }
};

GpuClock::GpuClock(const std::string& device_name) {
    auto library = std::make_unique<Library>();
    if (!library->load()) return;
    library_ = std::move(library);
    unsigned count = 0, named = 0;
    if (library_->get_count(&count) != 0) return;
    for (unsigned n = 0; n < count; ++n) {
        void* gpu = nullptr;
        char name[NAME_BYTES] = "";
        if (library_->get_device(n, &gpu) != 0 || library_->get_name(gpu, name, NAME_BYTES) != 0 || device_name != name) continue;
        gpu_ = gpu;
        ++named;
    }
    if (named > 1) gpu_ = nullptr; // which of them is not known
}

GpuClock::~GpuClock() {
    if (library_) library_->stop();
}

void GpuClock::read() {
    unsigned now = 0;
    if (gpu_ == nullptr || library_->get_clock(gpu_, MULTIPROCESSOR_CLOCK, &now) != 0) return;
    last_ = now;
    least_ = readings_ == 0 ? now : std::min(least_, now);
    ++readings_;
}

} // namespace recorder
