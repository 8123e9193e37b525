// Outputs: what a host draws and collides with, published from the state into three sets in turn with fixed buffers.
#pragma once
#include "engine/frames/host_copies.hpp"
#include "engine/frames/output_tiles.hpp"
#include "engine/step/run/state_program.hpp"

namespace wadi {

/// Published fields; bit n of a mask is output n. Meaning and units: wadi_output in the plugin's header.
enum class Output : std::uint32_t {
    terrain,
    sand_surface,
    free_surface,
    sand_depth,
    water_depth,
    saturation,
    flow,
    sand_flow,
    foam,
    normal,
    smooth_surface,
    packed,
    packed_half,
    wetness,
    silt,
    count
};
constexpr std::uint32_t bit(Output output) { return 1u << static_cast<std::uint32_t>(output); }
constexpr std::uint32_t all_outputs = bit(Output::count) - 1;
/// One more bit of the mask, which is no field: see Tile.
constexpr std::uint32_t tiles_bit = 1u << 31;

/// What lies in a cell of an output: so many floats.
struct OutputFormat {
    int components = 1;      // 1, 2 or 4
    int component_bytes = 4; // 4, or 2: IEEE binary16
    std::uint64_t bytes() const { return static_cast<std::uint64_t>(components * component_bytes); }
};

enum class OutputSet { previous, current, interpolated };

/// A published field on the device.
struct OutputView {
    compute::Buffer buffer;
    compute::NativeBuffer native;
    std::uint64_t offset = 0;    // of cell (0, 0) [bytes]
    std::uint64_t row_pitch = 0; // [bytes]
    int nx = 0, ny = 0;
    OutputFormat format;
    std::uint64_t step = 0; // the state after that many steps
    bool finished = false;  // the device has written it
};

class Outputs {
  public:
    explicit Outputs(WorldState& state) : state_(state), buffers_(state.device()), copies_(state) {}

    /// What is published (all_outputs and tiles_bit), what is copied to host memory as well (all_outputs), and whether float
    /// fields of `mask` are interpolated. Allocates and frees, and starts publishing anew; waits for the device.
    /// Errors: out_of_memory (nothing changed).
    Status set_mask(std::uint32_t mask) { return change({mask, asked_.host, asked_.interpolate}); }
    Status set_host_mask(std::uint32_t mask) { return change({asked_.mask, mask, asked_.interpolate}); }
    Status set_interpolation(bool on) { return change({asked_.mask, asked_.host, on}); }

    /// To be called as an update begins.
    void begin_update() { copies_.begin_update(); }
    /// The state is another, at whatever step: loaded, or gone back to. The next update publishes it.
    void jumped() { jumped_ = true; }
    /// Publishes the state, if it is that `between_steps` and another than last time, and interpolates. `interpolation`: where
    /// the host's time is from the last step but one to the last. Submits nothing where nothing is asked for.
    Status publish(bool between_steps, double interpolation);

    /// Waits until the newest publish is done and its copies are in host memory: host_view() and tiles() then give it.
    /// Errors: bad_argument (nothing was asked for), not_ready (nothing was published yet), device_lost.
    Status wait();

    bool published() const { return published_ > 0; }
    /// Of the current set.
    std::uint64_t published_step() const { return sets_[current()].step; }

    /// Errors: bad_argument (not asked for), not_ready (not published yet).
    Result<OutputView> view(Output output, OutputSet set) const;
    /// Copies cells within the grid of an output into an image of the host's, on the device and behind everything submitted; `to`
    /// must have room. Errors: those of view(), not_supported (a device without the host's images), not_ready (it would overtake
    /// recorded work).
    Status copy_to_image(Output output, OutputSet set, const Region& cells, const compute::HostImage& to);
    /// The newest copy in host memory; its rows are row_pitch bytes apart. Errors: bad_argument (not asked for), not_ready.
    struct HostView {
        const std::byte* data = nullptr;
        std::uint64_t row_pitch = 0, step = 0;
    };
    Result<HostView> host_view(Output output);
    /// The newest tiles in host memory. Errors: bad_argument (not asked for), not_ready.
    Result<Tiles> tiles();

  private:
    static constexpr std::size_t sets = HostCopies::sets;
    struct Asked {
        std::uint32_t mask = 0, host = 0;
        bool interpolate = false;
        bool operator==(const Asked&) const = default;
    };
    struct Set {
        std::uint64_t step = 0;
        compute::Ticket ticket;
    };

    static std::uint32_t fields_of(const Asked& asked);
    std::uint32_t interpolated() const;
    std::size_t current() const { return (next_ + sets - 1) % sets; }
    std::size_t previous() const { return published_ > 1 ? (next_ + sets - 2) % sets : current(); }
    std::uint64_t first_byte(Output output) const;
    compute::Buffer buffer(Output output, std::size_t set) const;
    std::vector<compute::BufferDesc> wanted_buffers(const Asked& asked) const;
    std::vector<HostCopies::Item> wanted_copies(const Asked& asked) const;
    Status change(const Asked& asked);
    Status restart();
    Status build_publish(compute::ProgramBuilder& builder, const Parity& parity, std::size_t set) const;
    Status build_interpolation(compute::ProgramBuilder& builder, const Parity& parity, std::size_t set) const;
    Status interpolate(double interpolation);

    WorldState& state_;
    Asked asked_;
    NamedBuffers buffers_;
    HostCopies copies_;
    std::array<std::optional<StateProgram>, sets> publish_, interpolate_;
    std::array<Set, sets> sets_{};
    std::size_t next_ = 0;                            // the set to be written next
    std::uint64_t published_ = 0;                     // since the mask changed
    bool jumped_ = false;                             // the state, since the last publish
    bool copied_ = false;                             // the current set, to host memory
    std::array<compute::Ticket, 2> interpolations_{}; // the newest
};

} // namespace wadi
