// Everything that a host does to a running world, with its step: remembered, written as bytes, and played into another world of
// the same level, which then goes through the same states to the bit.
#pragma once
#include "engine/edits/regions.hpp"
#include "engine/edits/source_changes.hpp"
#include "engine/edits/value_writes.hpp"
#include "engine/settings/rules/cost.hpp"
#include <map>
#include <optional>
#include <variant>

namespace wadi {

struct RegionWrite {
    std::uint64_t step = 0;
    EditLayer layer = EditLayer::terrain;
    Region region;
    std::vector<float> values;
};
struct Trim {
    std::uint64_t step = 0;
};
struct MaterialChange {
    std::uint64_t step = 0;
    int key = 0; // of material_keys()
    double value = 0;
};
/// A command and the step ahead of which it counts. Edits and sources run with that step, the others as soon as the one before
/// is done.
using Command = std::variant<Edit, RegionWrite, Trim, MaterialChange, SourceChange>;
std::uint64_t step_of(const Command& command);
/// 0 of all but edits and sources.
std::uint32_t player_of(const Command& command);

/// A log may bring so many edits into a step, and so many other commands, each of which waits for the device: seconds of work.
inline constexpr std::uint32_t LOG_EDITS_MOST = 4096, LOG_COMMANDS_MOST = 256;

/// What the bytes of a log hold.
struct CommandList {
    std::uint64_t level = 0; // level_digest()
    std::vector<Stamp> stamps;
    std::vector<Command> commands;
};
std::vector<std::byte> write_commands(std::uint64_t level, std::span<const Stamp> stamps, std::span<const Command> commands);
/// Errors: bad_file (no command log, a newer version, truncated, changed).
Result<CommandList> read_commands(std::span<const std::byte> bytes);

struct CommandCounts {
    std::uint32_t edits = 0, others = 0;
};

/// The way for commands into a world: runs or queues them and remembers them where that was asked for.
class CommandLog {
  public:
    CommandLog(WorldState& state, Stepper& stepper, Edits& edits, ValueWrites& values, SourceChanges& sources)
        : state_(state), stepper_(stepper), edits_(edits), values_(values), sources_(sources) {}

    /// Queues edits for their steps. Errors: bad_argument, and nothing is queued; not_supported here and below where a log that
    /// is remembered could not be played, with more in one step than LOG_EDITS_MOST or LOG_COMMANDS_MOST.
    Status edit(std::span<const Edit> edits);
    /// Queues a source for its step. Errors: bad_argument, not_supported.
    Status set_source(SourceChange change);
    /// The state between two steps is changed: what is left of a step begun in parts runs first. Errors: regions.hpp.
    Status write_region(EditLayer layer, const Region& region, std::span<const float> values);
    /// The same for values that the log could not remember. Errors: not_supported (it is on), ValueWrites::write().
    Status write_values(EditLayer layer, const Region& region, const ValueSource& from);
    Status trim();
    /// A number of the material, by its index in material_keys(), from the next step on. Errors, nothing changed:
    /// check_material_change(), Stepper::set_material().
    Status set_material(int key, double value);

    /// Begins an empty log, or drops it.
    void remember(bool on);
    /// All of it, with every stamp of the world.
    std::vector<std::byte> bytes() const;
    /// What counts ahead of step `since` or a later one, of one player or of all, with the stamps that it uses.
    std::vector<std::byte> bytes(std::uint64_t since, std::optional<std::uint32_t> player) const;
    /// Queues the commands of a log. Errors: bad_file (read_commands), bad_argument (of another level, or with a command that
    /// this world would refuse), out_of_memory; nothing is queued then.
    Status play(std::span<const std::byte> bytes);
    /// What play() would cost; nothing is queued. Errors: those of play().
    Result<Cost> cost(std::span<const std::byte> bytes) const;

    /// Runs what was played for this boundary between two steps.
    Status at_boundary();
    /// `most`, or fewer steps: those to the next boundary for which something was played.
    std::uint64_t undisturbed(std::uint64_t most) const {
        return played_.empty() ? most : std::min(most, played_.begin()->first - state_.steps);
    }
    /// The world went to another step: forgets what waits and what was remembered of later steps.
    void went_to(std::uint64_t step);

  private:
    void note(const Command& command);
    /// Numbers of the world's stamps that are those of a log, made where the world has none like them.
    Result<std::vector<std::uint32_t>> take_stamps(std::span<const Stamp> stamps);
    /// ok, or bad_argument: a step that is done or under way.
    Status check_step(const char* function, std::uint64_t step) const;
    /// Whether what is remembered has room for so many more of one step.
    Status check_room(const char* function, std::uint64_t step, bool edits, std::uint32_t more) const;
    Status check(const CommandList& list) const;
    /// Of what was played; it is remembered already.
    Status run(const Command& command);
    Status change_material(int key, double value);

    WorldState& state_;
    Stepper& stepper_;
    Edits& edits_;
    ValueWrites& values_;
    SourceChanges& sources_;
    bool remember_ = false;
    std::vector<Command> remembered_;
    std::map<std::uint64_t, CommandCounts> counts_; // of remembered_, by step
    std::multimap<std::uint64_t, Command> played_;  // all but edits and sources: they wait for their step, in order
};

} // namespace wadi
