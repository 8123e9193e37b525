// The clock that a GPU runs at, as its driver tells: a time says little without it.
#pragma once
#include <memory>
#include <string>

namespace recorder {

/// Readings of one NVIDIA GPU's multiprocessor clock through NVML, which comes with the driver. None where there is no NVML, or
/// not exactly one GPU of the name.
class GpuClock {
  public:
    /// `device_name`: as wadi_world_info has it.
    explicit GpuClock(const std::string& device_name);
    ~GpuClock();
    GpuClock(const GpuClock&) = delete;
    GpuClock& operator=(const GpuClock&) = delete;

    /// Takes a reading; to be called while the GPU works, since it slows down when idle.
    void read();

    unsigned readings() const { return readings_; }
    /// [MHz] of the last and of the slowest reading.
    unsigned last() const { return last_; }
    unsigned least() const { return least_; }

  private:
    struct Library;
    std::unique_ptr<Library> library_;
    void* gpu_ = nullptr;
    unsigned readings_ = 0, last_ = 0, least_ = 0;
};

} // namespace recorder
