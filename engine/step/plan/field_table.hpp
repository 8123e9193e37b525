// The fields of a step plan by name: a row says what a field is for, where it lies, its unit and who else knows it. The plan, the
// hash, reading on the host and the tables of pages walk these rows.
#pragma once
#include "shaders/params.hpp"
#include <cstdint>
#include <span>
#include <string_view>

namespace wadi {

enum class FieldRole : std::uint8_t {
    state,     // lasts from step to step
    rim,       // state of the outer faces: four numbers each, in the order of RIM stages
    scratch,   // alive within one step
    ledger,    // counts quanta in and out
    fixed,     // from the level, never changes
    shapes,    // of the sources
    tiles,     // active tiles; where there are two lists also as ..._water and ..._sand
    published, // in no plan: computed by a publish stage when it is read
};

enum class FieldPlace : std::uint8_t { cell, west_face, south_face, none };

struct FieldRow {
    std::string_view name;
    FieldRole role;
    FieldPlace place;
    bool hashed;         // in the order of the rows: never reorder those, or every golden hash changes
    int host;            // its number in wadi_field; -1 = hosts do not read it
    const char* symbol;  // of NUMERICS, and the name by which hosts dump it; "" = none
    const char* unit;    // "1" = a number, "" = no quantity
    std::uint32_t needs; // effects and choices without which it does not exist
    const char* meaning; // "": that of the row above, along another axis
};

std::span<const FieldRow> field_table();
/// By a name without "_next"; null where the table lacks it.
const FieldRow* find_field(std::string_view name);
/// The same for names that must be there. Throws std::logic_error.
const FieldRow& field_row(std::string_view name);
/// By its number in wadi_field; null for any other number.
const FieldRow* find_host_field(int host);

} // namespace wadi
