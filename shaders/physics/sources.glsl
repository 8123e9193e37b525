// What sources and sinks add to a cell and take from it (NUMERICS 2.9).
#ifndef PHYSICS_SOURCES
#define PHYSICS_SOURCES
#include "../physics/pores.glsl"

// Where a piece of a box of sources lies: rows from ... to, without `to`, of a column.
struct SourcePiece {
    int column, from, to;
};

// box: i0, j0, i1, j1; in_box: number of the piece in it; rows: P.source_rows.
FN SourcePiece source_piece(vec4 box, int in_box, int rows) {
    int columns = int(box.z) - int(box.x);
    int end = int(box.w);
    SourcePiece piece;
    piece.column = int(box.x) + in_box % columns;
    piece.from = int(box.y) + in_box / columns * rows;
    piece.to = piece.from + rows < end ? piece.from + rows : end;
    return piece;
}

// Whether a source's shape holds a place. shape: disc (cx, cy, radius^2, 0) or box (x0, y0, x1, y1).
FN bool covers(vec4 shape, vec4 kind, float x, float y) {
    float rx = x - shape.x;
    float ry = y - shape.y;
    bool disc = rx * rx + ry * ry <= shape.z;
    bool box = x >= shape.x && y >= shape.y && x < shape.z && y < shape.w;
    return kind.x == float(SOURCE_DISC) ? disc : box;
}

// The water of a cell whose surface stands at a level; held: of water_in_pores, -1 without infiltration.
FN float water_at_level(float level, float ground, float sand, float held, float porosity, float quantum, float inv_quantum) {
    float depth = wmax(level - ground, 0.0f);
    float room = wmin(pore_room(sand, porosity, quantum, inv_quantum), most_in_pores(held));
    return whole_quanta(depth < sand ? porosity * depth : depth - (sand - room), quantum, inv_quantum);
}

// What a source would add to a cell in this step, or take from it; at_level: the cell's water at the source's level.
FN float source_wants(vec4 kind, vec4 now, float at_level, float water) {
    float lacks = wclamp(at_level - water, now.z > 0.0f ? -now.x : 0.0f, now.x);
    return kind.w > 0.0f ? lacks : now.x;
}

// What of that it does: nothing where it has no room, and it takes no more than is held.
FN float source_gives(float wanted, float room, float held) { return wanted > 0.0f ? (wanted <= room ? wanted : 0.0f) : -wmin(-wanted, held); }

#endif
