// Semi-Lagrangian transport of face velocities (paper 4.1.3, 4.2.3, 4.3; NUMERICS 2.12).
#ifndef PHYSICS_BACKTRACE
#define PHYSICS_BACKTRACE
#include "../physics/velocity.glsl"

// Boundary types of a face for one layer.
#define FACE_UNTRACKED 0.0f // both cells dry: its velocity means nothing
#define FACE_TRACKED 1.0f
#define FACE_FIXED 2.0f // on the rim, or between a wet cell and higher dry ground: keeps its velocity, lends it to nobody

FN float face_type(bool inner, float height_low, float height_high, float surface_low, float surface_high, float dry) {
    bool wet = either(height_low > dry, height_high > dry);
    bool wall = both(wet, blocked(height_low, height_high, surface_low, surface_high, dry));
    float kind = wet ? FACE_TRACKED : FACE_UNTRACKED;
    return either(!inner, wall) ? FACE_FIXED : kind;
}

// The eight neighbours of a face among the faces of its direction, opposite ones first in every sum.
struct Ring {
    float w, e, s, n, sw, ne, se, nw;
};

FN float ring_sum(Ring a) { return ((a.w + a.e) + (a.s + a.n)) + ((a.sw + a.ne) + (a.se + a.nw)); }

// Mean of the tracked neighbours, 0 without any. type: their boundary types; inside: 1 where the grid has them.
FN float extrapolate(float own, float own_type, Ring value, Ring type, Ring inside) {
    Ring weight;
    weight.w = both(inside.w > 0.0f, type.w == FACE_TRACKED) ? 1.0f : 0.0f;
    weight.e = both(inside.e > 0.0f, type.e == FACE_TRACKED) ? 1.0f : 0.0f;
    weight.s = both(inside.s > 0.0f, type.s == FACE_TRACKED) ? 1.0f : 0.0f;
    weight.n = both(inside.n > 0.0f, type.n == FACE_TRACKED) ? 1.0f : 0.0f;
    weight.sw = both(inside.sw > 0.0f, type.sw == FACE_TRACKED) ? 1.0f : 0.0f;
    weight.ne = both(inside.ne > 0.0f, type.ne == FACE_TRACKED) ? 1.0f : 0.0f;
    weight.se = both(inside.se > 0.0f, type.se == FACE_TRACKED) ? 1.0f : 0.0f;
    weight.nw = both(inside.nw > 0.0f, type.nw == FACE_TRACKED) ? 1.0f : 0.0f;
    Ring lent;
    lent.w = weight.w > 0.0f ? value.w : 0.0f;
    lent.e = weight.e > 0.0f ? value.e : 0.0f;
    lent.s = weight.s > 0.0f ? value.s : 0.0f;
    lent.n = weight.n > 0.0f ? value.n : 0.0f;
    lent.sw = weight.sw > 0.0f ? value.sw : 0.0f;
    lent.ne = weight.ne > 0.0f ? value.ne : 0.0f;
    lent.se = weight.se > 0.0f ? value.se : 0.0f;
    lent.nw = weight.nw > 0.0f ? value.nw : 0.0f;
    float mean = divide_or_zero(ring_sum(lent), ring_sum(weight));
    return own_type == FACE_UNTRACKED ? mean : own;
}

// Bilinear value at (-back_x, -back_y) cells from the face, both within +-1, as increments: a uniform velocity keeps its bits.
FN float sample_back(float own, Ring value, float back_x, float back_y) {
    float x = wclamp(back_x, -1.0f, 1.0f);
    float y = wclamp(back_y, -1.0f, 1.0f);
    float west = wmax(x, 0.0f);
    float east = wmax(-x, 0.0f);
    float south = wmax(y, 0.0f);
    float north = wmax(-y, 0.0f);
    float middle_x = 1.0f - wabs(x);
    float middle_y = 1.0f - wabs(y);
    float along = west * middle_y * (value.w - own) + east * middle_y * (value.e - own);
    float across = south * middle_x * (value.s - own) + north * middle_x * (value.n - own);
    float rising = west * south * (value.sw - own) + east * north * (value.ne - own);
    float falling = east * south * (value.se - own) + west * north * (value.nw - own);
    return own + ((along + across) + (rising + falling));
}

#endif
