// Stage files as stagec reads them: bindings, extent, tested effects.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

namespace stagec {

[[noreturn]] void fail(const std::string& message);
std::string read_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);
/// File name without folder and extension.
std::string stem(const std::string& path);
std::string strip_comments(const std::string& text);
/// The word (letters, digits, underscores) that begins at `at`.
std::string word_at(const std::string& text, std::size_t at);
/// The arguments of a macro call whose name ends at `at`, without blanks; empty when no parenthesis follows.
std::vector<std::string> arguments(const std::string& text, std::size_t at);
/// Names that begin with EFFECT_ in an expression.
std::set<std::string> effects_in(const std::string& expression);

struct Binding {
    std::string name, type, access, condition;
    int slot = 0;
    /// Lies in memory as 16-bit floats with EFFECT_HALF_STORAGE.
    bool narrow() const { return type == "float_or_half"; }
};

/// Cells from the kernel's own index to the farthest that it reads.
struct Reach {
    int west = 0, south = 0, east = 0, north = 0;
};

struct Stage {
    std::string path, name, struct_name, extent;
    Reach reach;
    std::string far; // effects without which it reads no further than one cell
    std::vector<Binding> bindings;
    bool fused = false;
    std::vector<std::string> tested; // effect names that HAS() or a condition asks
};

inline constexpr const char* half_storage = "EFFECT_HALF_STORAGE";    // asked by every stage with a narrow binding
inline constexpr const char* first_choice = "EFFECT_SEMI_LAGRANGIAN"; // from its bit on the bits are choices of method

Stage parse_stage(const std::string& path);
/// As generated code includes it: "stages/ROOM/NAME.stage".
std::string include_path(const Stage& stage);
/// The path of a stage by its name, in one of the rooms of `folder`; `asker` is named where there is none.
std::string find_stage(const std::string& folder, const std::string& name, const std::string& asker);

using Effects = std::map<std::string, unsigned>; // name -> bit
Effects parse_effects(const std::string& path);
/// The bits of the effects that an expression names.
unsigned effect_bits(const std::string& expression, const Effects& effects, const std::string& path);
unsigned tested_bits(const Stage& stage, const Effects& effects);
/// Every mask that a stage can meet: the subsets of the bits it tests which a world can have together with `needs` and without
/// `without`.
std::vector<unsigned> masks(unsigned tested, unsigned needs = 0, unsigned without = 0);
/// Those that no other one with the same bits of `apart` includes.
std::vector<unsigned> largest(const std::vector<unsigned>& masks, unsigned apart = 0);

} // namespace stagec
