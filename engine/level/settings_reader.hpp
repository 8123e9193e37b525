// The settings of a level file: grid, time step, material, method, sides, sources, rain, edits, effects.
#pragma once
#include "engine/level/json_reader.hpp"
#include "engine/level/level_files.hpp"
#include "engine/settings/data/settings.hpp"
#include <string>

namespace wadi {

/// Reads every settings key of the root object. Ranges that validate() checks are left to it. Series files come from
/// `files`. Errors go to the reader's status.
void read_settings(ObjectReader& root, LevelFiles& files, Settings& settings);

/// The level's own edits.
std::vector<ScriptedEdit> read_edits(const Json& value, Status& status);

/// A number, a list of [time, value], or {"file": "series.csv"}.
TimeSeries read_series(const Json& value, const std::string& path, LevelFiles& files, Status& status);

/// "time,value" lines; empty lines, lines that start with # and one heading line are skipped.
Result<TimeSeries> read_series_file(const std::string& path, LevelFiles& files);

} // namespace wadi
