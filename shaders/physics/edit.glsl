// Shapes of edits. Lengths in cells; positions are whole 1/256 cells, so that differences are exact and mirrored and transposed
// edits give mirrored and transposed bits.
#ifndef PHYSICS_EDIT
#define PHYSICS_EDIT
#include "../physics/scalar.glsl"

#define STAMP_SAMPLES 8 // most samples of a stamp along a side of a cell

// Weight at (x, y) of a capsule: 1 inside, falling to 0 at its radius over 1/inv_fade by 3 s^2 - 2 s^3. Length 0: a disc.
FN float capsule_weight(float x, float y, EditInput edit) {
    float rx = x - edit.from_x;
    float ry = y - edit.from_y;
    float along = wclamp((rx * edit.along_x + ry * edit.along_y) * edit.inv_length2, 0.0f, 1.0f);
    float ax = rx - along * edit.along_x;
    float ay = ry - along * edit.along_y;
    float inside = edit.radius - wsqrt(ax * ax + ay * ay);
    float s = wclamp(inside * edit.inv_fade, 0.0f, 1.0f);
    return s * s * (3.0f - 2.0f * s);
}

// Share of a square that lies on the inner side of a straight edge: `inside` is how far its middle lies within, a and b the
// square's side times the components of the edge's normal.
FN float covered_share(float inside, float a, float b) {
    float most = wmax(wabs(a), wabs(b));
    float least = wmin(wabs(a), wabs(b));
    float left = 0.5f * (most + least) - wabs(inside);
    float corner = 0.5f * divide_or_zero(divide_or_zero(left, least) * left, most);
    float tail = left < least ? corner : divide_or_zero(left - 0.5f * least, most);
    tail = left > 0.0f ? tail : 0.0f;
    return inside > 0.0f ? 1.0f - tail : tail;
}

// Share of the cell at (x, y) that a capsule with a hard rim covers, from rim_parts x rim_parts squares in which the rim counts as straight.
// Where it bends round an end, the mean distance over a square of side h is that of its middle and h^2/12 more, squared. Shares
// are whole 2^-18, so that sums of 64 are exact: their order does not count.
FN float capsule_share(float x, float y, EditInput edit) {
    int parts = edit.rim_parts;
    float h = wdiv(1.0f, float(parts));
    float sum = 0.0f;
    for (int q = 0; q < parts; ++q) {
        for (int p = 0; p < parts; ++p) {
            float rx = x - 0.5f + (float(p) + 0.5f) * h - edit.from_x;
            float ry = y - 0.5f + (float(q) + 0.5f) * h - edit.from_y;
            float along = wclamp((rx * edit.along_x + ry * edit.along_y) * edit.inv_length2, 0.0f, 1.0f);
            float ax = rx - along * edit.along_x;
            float ay = ry - along * edit.along_y;
            float square_of = ax * ax + ay * ay;
            float distance = wsqrt(square_of);
            bool bent = along <= 0.0f || along >= 1.0f;
            float inside = edit.radius - (bent ? wsqrt(square_of + h * h * 0.0833333333f) : distance);
            float share = covered_share(inside, h * divide_or_zero(ax, distance), h * divide_or_zero(ay, distance));
            sum += wtrunc(share * 262144.0f + 0.5f);
        }
    }
    return sum * (1.0f / 262144.0f) * (h * h);
}

// The nearest whole quantum; the depth itself for Q = 0.
FN float nearest_quanta(float depth, float quantum, float inv_quantum) {
    float t = wtrunc(depth * inv_quantum + (depth < 0.0f ? -0.5f : 0.5f)) * quantum;
    return quantum > 0.0f ? t : depth;
}

// What of a change fits: no more than `room` up, no more than `held` down.
FN float limit_change(float wanted, float room, float held) { return wmax(wmin(wanted, room), -held); }

FN float drawn_towards(float velocity, float target, float weight, float limit) {
    return flush(wclamp(velocity + weight * (target - velocity), -limit, limit));
}

#endif
