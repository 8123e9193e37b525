// Fused files: several stages as one pass over windows in shared memory, written from the stages' own text (shaders/README.md,
// "Fused stages").
#pragma once
#include "shaders/stage_table.hpp"
#include "stage_file.hpp"

namespace stagec {

/// Cells around a group's own ones for which a phase runs too.
struct Margins {
    int west = 0, south = 0, east = 0, north = 0;
};

/// A stage inside a fused one: which field each of its bindings reads and writes.
struct FusedPart {
    Stage stage;
    std::map<std::string, std::string> reads, writes; // binding name -> field name
    unsigned condition = 0;                           // runs only if all these effects are on
    std::string place;                                // of its RUN, for messages
    std::size_t phase = 0;
    Reach reach; // cells from its own index to the farthest that it reads with what the fused stage allows
};

/// Where a field that the parts write lives until the pass ends.
enum class Keeping { nowhere, own_index, window };

/// What later passes read of a field: all of it, or its outer faces alone, and under which effects.
struct Kept {
    bool rim = false;
    unsigned condition = 0;
    std::string place; // of its KEEP
};

/// Groups whose cells hold nothing of some fields, as far as the group reads them.
struct Content {
    std::vector<std::string> without; // those fields; none: no group is looked at
    std::string place;                // of the words, for messages
};

/// What a group without content writes in place of running the phases.
struct Empty : Content {
    std::map<std::string, std::string> copies; // kept field -> field of memory that it equals then; the others are 0
    unsigned never = 0;                        // effects with which no group is taken for empty
};

/// Effects without which such a group runs the phases; what it keeps under them is 0.
struct Lean : Content {
    unsigned less = 0;
};

struct FusedStage {
    Stage stage; // name, struct name, extent, bindings and tested effects, as of a stage that is written by hand
    unsigned needs = 0, without = 0;
    int groups = 6;     // on a multiprocessor, for which CUDA keeps registers
    int cells_each = 2; // of a column, that a thread computes at once
    std::vector<Margins> phases;
    std::vector<FusedPart> parts;
    std::map<std::string, Keeping> fields; // fields that parts write
    std::map<std::string, Kept> kept;      // those that later passes read
    std::vector<std::string> staged;       // fields of memory that a group copies to shared memory ahead of its phases
    std::string staged_place;              // of STAGED, for messages
    Empty empty;
    Lean lean;
};

/// Threads of a group of a fused stage along i and j; it covers FUSED_COLUMNS x FUSED_ROWS cells.
inline constexpr int fused_group_x = wadi::compute::fused_group_x, fused_group_y = wadi::compute::fused_group_y;

/// Rows of a field that a group shares: those of its own cells and some around.
struct SharedRows {
    std::string field;
    int south = 0, north = 0;
    int rows() const { return FUSED_ROWS + south + north; }
};
/// A shared row: a group's own cells and, so that it begins at a multiple of four as they do, four more on either side.
inline constexpr int shared_beside = 4, shared_pitch = FUSED_COLUMNS + 2 * shared_beside;
/// Bytes of shared memory of a group: what every backend may use, and CUDA.
inline constexpr std::size_t shared_bytes_everywhere = wadi::compute::fused_shared_bytes, shared_bytes_cuda = 49152;
/// Fields that one phase gives a later one.
std::vector<SharedRows> windows(const FusedStage& fused);
/// Copies of fields of memory, with all that the parts read around them.
std::vector<SharedRows> staged(const FusedStage& fused);
std::size_t shared_bytes(const FusedStage& fused);
/// The same with the last staged fields left out that `bytes` of shared memory do not hold.
FusedStage fitted(FusedStage fused, std::size_t bytes);
std::vector<std::string> fields_kept(const FusedStage& fused, Keeping keeping);

/// Stages are looked for in the rooms of the folder stages beside the file's own.
FusedStage parse_fused(const std::string& path, const Effects& effects);

const Binding& binding_of(const Stage& stage, const std::string& name);
/// What of a binding's condition is still open in a fused stage; `never` where the binding cannot exist.
unsigned condition_of(const FusedStage& fused, const FusedPart& part, const Binding& b, const Effects& effects, bool& never);
bool writes_before(const FusedStage& fused, std::size_t part, const std::string& field);
/// The part that writes a field last; the number of parts where none does.
std::size_t last_writer(const FusedStage& fused, const std::string& field);

/// The parts' functions with their loads and stores redirected, one kernel function PART_kernel(i, j) each; and once more, as
/// lean_PART_kernel, without the effects that lean groups do without. `mask`: the effects' name in the language.
std::string part_functions(const FusedStage& fused, const Effects& effects, const std::string& mask);
/// Margins around a group's own cells from which the parts read memory.
Margins read_margins(const FusedStage& fused);
/// Copies the staged fields, and waits for them. `zero`: fields that hold only 0 there.
std::string staging(const FusedStage& fused, const std::vector<std::string>& zero);
/// Whether the group holds nothing of the fields of `content`, as a bool of that name; false at the grid's rim, where outer faces
/// keep what sides set.
std::string content_look(const FusedStage& fused, const Content& content, const std::string& name);
/// What an empty group writes, and a lean one where its phases write nothing.
std::string empty_writes(const FusedStage& fused);
std::string lean_writes(const FusedStage& fused, const Effects& effects);
/// The phases in order, or what a group without content writes. The language gives LANE, LANES (a group's threads), BARRIER, ANY
/// (whether a number is not 0 for one of them), ROLLED (a loop that is not unrolled), WIDE (elements that a thread copies at
/// once, 1 or 4), COPY(to, at, from, at) of so many, COPIED ahead of the barrier behind all copies, HOLDS(field, at), whether one
/// of WIDE elements is not 0, and KEEP_COPY(field, at, from) and KEEP_ZEROS(field, at), which store WIDE elements of another
/// field, or zeros.
std::string phase_loops(const FusedStage& fused, const Effects& effects);
/// Include lines of the parts' physics.
std::string physics_includes(const FusedStage& fused);
/// What fused stages keep for themselves, as declarations with `shared` ahead of arrays in shared memory.
std::string own_variables(const FusedStage& fused);
/// Macros for places in memory and in shared rows. They need own_i0, own_j0 and the language's type Place and PLACE.
extern const char* const index_macros;

} // namespace stagec
