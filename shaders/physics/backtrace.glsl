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

// The eight neighbours of a face among the faces of its direction: low and high along it, left and right across it, opposite ones
// first in every sum.
struct Ring {
    float low, high, left, right, low_left, high_right, high_left, low_right;
};

FN float ring_sum(Ring a) { return ((a.low + a.high) + (a.left + a.right)) + ((a.low_left + a.high_right) + (a.high_left + a.low_right)); }

FN float lends(float type, float inside) { return both(inside > 0.0f, type == FACE_TRACKED) ? 1.0f : 0.0f; }

FN float lent(float value, float weight) { return weight > 0.0f ? value : 0.0f; }

// Mean of the tracked neighbours, 0 without any. type: their boundary types; has_left, has_right: 1 where the grid goes on across the
// face's direction.
FN float extrapolate(float own, float own_type, Ring value, Ring type, float has_left, float has_right) {
    Ring weight;
    weight.low = lends(type.low, 1.0f);
    weight.high = lends(type.high, 1.0f);
    weight.left = lends(type.left, has_left);
    weight.right = lends(type.right, has_right);
    weight.low_left = lends(type.low_left, has_left);
    weight.high_right = lends(type.high_right, has_right);
    weight.high_left = lends(type.high_left, has_left);
    weight.low_right = lends(type.low_right, has_right);
    Ring from;
    from.low = lent(value.low, weight.low);
    from.high = lent(value.high, weight.high);
    from.left = lent(value.left, weight.left);
    from.right = lent(value.right, weight.right);
    from.low_left = lent(value.low_left, weight.low_left);
    from.high_right = lent(value.high_right, weight.high_right);
    from.high_left = lent(value.high_left, weight.high_left);
    from.low_right = lent(value.low_right, weight.low_right);
    float mean = divide_or_zero(ring_sum(from), ring_sum(weight));
    return own_type == FACE_UNTRACKED ? mean : own;
}

// Bilinear value so many cells back from the face along its direction and across it, both within +-1, as increments: a uniform
// velocity keeps its bits.
FN float sample_back(float own, Ring value, float back_along, float back_across) {
    float a = wclamp(back_along, -1.0f, 1.0f);
    float b = wclamp(back_across, -1.0f, 1.0f);
    float low = wmax(a, 0.0f);
    float high = wmax(-a, 0.0f);
    float left = wmax(b, 0.0f);
    float right = wmax(-b, 0.0f);
    float middle_along = 1.0f - wabs(a);
    float middle_across = 1.0f - wabs(b);
    float along = low * middle_across * (value.low - own) + high * middle_across * (value.high - own);
    float across = left * middle_along * (value.left - own) + right * middle_along * (value.right - own);
    float rising = low * left * (value.low_left - own) + high * right * (value.high_right - own);
    float falling = high * left * (value.high_left - own) + low * right * (value.low_right - own);
    return own + ((along + across) + (rising + falling));
}

#endif
