// The plugin's world, on the viewer's device where the backend can, and the outputs that are drawn.
#pragma once
#include "gpu.hpp"
#include "look.hpp"
#include <array>
#include <string>
#include <wadi/wadi.h>
#include <wadi/wadi_vulkan.h>

namespace viewer {

struct SimulationChoice {
    std::string level_file;
    std::string text;     // not empty: instead of the file's own; maps are still found beside it
    std::string variant;  // empty = the level as it is
    std::string accuracy; // preset; "level" = what the level says; empty = "fine" on a graphics card, "level" elsewhere
    std::string method;   // preset; empty = the level's
    std::string backend = "auto";
    int device = -1;
    int threads = 0;
    int nx = 0, ny = 0; // 0 = the level's
};

/// What a world can run on beside this renderer: a backend's best device (-1), or one of several. Vulkan's is the one that draws.
struct SimulationDevice {
    std::string backend;
    int device = -1;
    std::string label;
};
std::vector<SimulationDevice> simulation_devices();

/// Where the renderer reads: in the order of F.source in shaders/prepare.comp.
struct Source {
    VkBuffer buffer = VK_NULL_HANDLE;
    int offset = 0, row_pitch = 0; // [floats]
};
using Sources = std::array<Source, 10>;

/// Throws std::runtime_error with the plugin's message.
void check(wadi_result result, const char* what);

/// What the submission of a picture waits for and signals beside the renderer's own fence.
struct Submission {
    VkSemaphore wait = VK_NULL_HANDLE, signal = VK_NULL_HANDLE; // of a swapchain
    VkSemaphore timeline = VK_NULL_HANDLE;                      // waits for timeline_value, signals timeline_value + 1
    uint64_t timeline_value = 0;
};

/// A quantity per cell that the plugin does not publish: read or made on the host for each picture, which waits for the world.
enum class HostField { none, strain, stress, activity, limits };
/// What a view (views() in look.hpp) needs.
HostField host_field_of(int view);

class Simulation {
  public:
    Simulation(const Gpu& gpu, const SimulationChoice& choice);
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    wadi_world_id world{};
    wadi_world_info info{};
    Grid grid;
    wadi_frame frame{}; // of the last update

    /// Nothing is dropped: for recordings, where a picture may take longer than it shows.
    void set_recording(bool on);
    /// To be called ahead of update().
    void show(HostField field);
    void update(uint64_t nanoseconds);
    /// Whole steps beside the clock; outputs follow with the next update.
    void step(uint32_t steps);
    /// Depths are multiples of it [m]; 0: of nothing.
    double quantum() const { return quantum_; }
    /// Outputs of the newest update. `whole`: waits until the host has those of the last step (CPU backend; the others never
    /// wait).
    const Sources& sources(bool whole);

    /// For the next picture. CUDA's work and the viewer's are ordered by a timeline semaphore; the other backends share the
    /// viewer's queue or none.
    Submission next_submission();
    /// Outputs lie in memory that CUDA writes.
    bool foreign_memory() const { return timeline_ != VK_NULL_HANDLE; }

  private:
    const Gpu& gpu_;
    Sources sources_{};
    std::array<Buffer, std::tuple_size_v<Sources> - 1> staging_; // CPU backend
    Buffer host_field_buffer_;                                   // one row of zeros while there is none
    double quantum_ = 0;
    HostField host_field_ = HostField::none;
    bool on_host_ = false;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    uint64_t timeline_value_ = 0;
    uint64_t staged_step_ = UINT64_MAX;

    void choose_outputs();
    void make_buffers();
    void fill_host_field(bool whole);
    void read_strain();
    void read_activity(bool whole);
    void read_limits();
    bool stage();
};

/// Messages of the library since the last call, oldest first.
std::vector<std::string> take_log();

} // namespace viewer
