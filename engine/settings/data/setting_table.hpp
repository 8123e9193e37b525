// The settings that are one number, flag or choice each: a row says where it stands in a level file, its range, unit and meaning.
// The level reader, validate(), material keys, the level digest, the schema and the tables of pages walk these rows; defaults
// are those of the structs in settings.hpp.
#pragma once
#include "engine/settings/data/settings.hpp"
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wadi {

/// How a level file writes a setting.
enum class SettingKind : std::uint8_t {
    number,
    whole, // a whole number
    flag,  // true or false: 1 or 0
    choice // one of `names`: its index, the enumerator's value
};

/// Whether the level digest covers a setting, so that a snapshot of a level with another value is refused.
enum class InDigest : std::uint8_t {
    no, // how a world is run: changes no bit
    yes,
    where_set // added later: where it is not the default, so that levels without it keep their digest
};

/// The values that a setting takes.
struct Values {
    double least = 0, most = 0;
    std::span<const char* const> names = {}; // of a choice
    std::span<const int> among = {};         // where it must be one of these; empty = any from least to most
};

/// A setting as a number in the settings of a world.
struct SettingAccess {
    SettingKind kind;
    double (*get)(const Settings& settings);
    void (*set)(Settings& settings, double value);
};

struct Setting {
    const char* path; // as a level file has it: "dt", "material.friction", "material.saturation[0]"
    SettingAccess at;
    Values values;
    const char* unit;     // "" = none
    std::uint32_t effect; // through which alone it acts; 0 = several
    const char* meaning;
    InDigest in_digest = InDigest::yes;

    /// "material"; "" for what stands beside it.
    std::string_view object() const;
    /// "friction", "saturation[0]".
    std::string_view key() const;
    /// True for a number of a list, "saturation[0]".
    bool element() const { return key().ends_with(']'); }
    /// The default.
    double normal() const;
    /// Must be given: the default is out of range.
    bool required() const;
};

/// In the order in which the digest takes them: new rows come last within their object.
std::span<const Setting> setting_table();
/// Null for an unknown path.
const Setting* find_setting(std::string_view path);

/// What the method published can follow: its transport of velocities looks one cell back.
inline constexpr double PUBLISHED_CLAMP_MOST = 1;

inline constexpr int GRID_MOST = 16384;
inline constexpr double DX_LEAST = 1e-4, DX_MOST = 1e4; // [m]
inline constexpr double DT_LEAST = 1e-7, DT_MOST = 100; // [s]
inline constexpr double RAIN_MOST = 1;                  // rain and evaporation [m/s]
inline constexpr double RAIN_TIMES_MOST = 100;          // of rain by a map
inline constexpr double FADING_MOST = 1e5;              // half-lives of foam and wetness [s]
inline constexpr double FOAM_ENERGY_LEAST = 1e-3;       // [J/m2]
inline constexpr double SILT_SPEED_LEAST = 1e-3;        // [m/s]
inline constexpr double RATE_MOST = 1e4;                // of a source [m/s]
inline constexpr double MANNING_MOST = 1;               // n of a material, of a cell's roughness [s/m^(1/3)]
inline constexpr double SPEED_MOST = 1e4;               // set by a source or as an initial velocity [m/s]
inline constexpr double DISCHARGE_MOST = 1e9;           // through a side [m3/s]
inline constexpr std::size_t EDITS_MOST = 1000;         // of a level
inline constexpr std::uint64_t STEP_EDITS_MOST = 256;   // that a level brings into one step
inline constexpr double EDIT_TIME_MOST = 1e9;           // of a level's edit [s]
inline constexpr double EDIT_EVERY_LEAST = 1e-3;        // [s]
inline constexpr double SATURATION_GAP = 1e-3;          // least distance of 0, phi1, phi2 and phi3

/// As level files write them, indexed by SideName.
const std::vector<std::string>& side_names();

} // namespace wadi
