// Where sources and sinks act, as apply_sources reads it.
#pragma once
#include "engine/settings/data/settings.hpp"
#include "shaders/params.hpp"
#include <vector>

namespace wadi {

/// Cells [i0, i1) x [j0, j1).
struct CellBox {
    int i0, j0, i1, j1;
};

/// The boxes that hold all sources, cut into pieces of `rows` rows of one column: as few rows as the counters of the source
/// ledger allow, since each piece counts in one of its own. Pieces are numbered box by box, row by row.
struct SourcePieces {
    std::vector<CellBox> boxes; // no two overlap
    std::vector<int> first;     // piece of each box
    std::vector<int> box_of;    // for each source; -1: outside the grid
    int rows = 1, count = 0;
};
SourcePieces source_pieces(const Settings& settings);

/// Two vec4 per source, MAX_SOURCES of them: its shape; kind, material, box and 1 if it holds a level. Then two per box: i0, j0,
/// i1, j1; its first piece.
std::vector<vec4> source_shapes(const Settings& settings);
/// Whether the sources of both lie in the same places, whatever they bring.
bool same_source_shapes(const Settings& a, const Settings& b);

} // namespace wadi
