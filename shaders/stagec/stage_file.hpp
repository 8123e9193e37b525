// Stage files as stagec reads them: bindings, extent, tested effects.
#pragma once
#include "source.hpp"
#include <map>
#include <set>
#include <string>
#include <vector>

namespace stagec {

struct Binding {
    std::string name, type, access, condition;
    int slot = 0;
    std::string empty = "0.0f"; // what the stage writes where it is empty
};

/// Cells from the kernel's own index to the farthest that it reads.
struct Reach {
    int west = 0, south = 0, east = 0, north = 0;
};

/// Where these fields are 0 wherever the kernel reads them, the stage is empty, or one without the effects `less` writes the
/// same.
struct Lack {
    std::vector<std::string> fields;
    std::string less; // "0u": empty
};

struct Stage {
    std::string path, name, struct_name, extent;
    /// The file without comments, what it says once written out, physics included by paths from shaders/.
    Source source;
    Reach reach;
    std::string far; // effects without which it reads no further than one cell
    std::vector<Binding> bindings;
    std::vector<Lack> lacks;
    bool fused = false;
    std::vector<std::string> tested; // effect names that HAS() or a condition asks
};

inline constexpr const char* usual_choice = "EFFECT_SHOCK_VISCOSITY"; // the default method's, wherever there is water
inline constexpr const char* first_choice = "EFFECT_PUBLISHED";       // from its bit on the bits are choices of method

/// Refuses what it does not know, by file and line: words, types, extents, bindings out of order, a stage without a kernel.
Stage parse_stage(const std::string& path);
/// The stage's text with #line in front, for a generated file that goes on behind it.
std::string stage_text(const Stage& stage);
/// The path of a stage by its name, in one of the rooms of `folder`; empty where there is none.
std::string find_stage(const std::string& folder, const std::string& name);

using Effects = std::map<std::string, unsigned>; // name -> bit
Effects parse_effects(const std::string& path);
/// The bits of the effects that an expression names; `place` begins the message where one is unknown.
unsigned effect_bits(const std::string& expression, const Effects& effects, const std::string& place);
unsigned tested_bits(const Stage& stage, const Effects& effects);
/// Every mask that a stage can meet: the subsets of the bits it tests which a world can have together with `needs` and without
/// `without`.
std::vector<unsigned> masks(unsigned tested, unsigned needs = 0, unsigned without = 0);
/// Those that no other one with the same bits of `apart` includes.
std::vector<unsigned> largest(const std::vector<unsigned>& masks, unsigned apart = 0);

} // namespace stagec
