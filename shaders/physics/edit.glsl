// Shapes of edits. Lengths in cells; positions are whole 1/256 cells, so that differences are exact and mirrored and transposed
// edits give mirrored and transposed bits.
#ifndef PHYSICS_EDIT
#define PHYSICS_EDIT
#include "../physics/scalar.glsl"

// Weight at (x, y) of a capsule: 1 inside, falling to 0 at its radius over 1/inv_fade by 3 s^2 - 2 s^3. Length 0: a disc.
FN float capsule_weight(float x, float y, vec4 segment, float radius, float inv_fade, float inv_length2) {
    float rx = x - segment.x;
    float ry = y - segment.y;
    float along = wclamp((rx * segment.z + ry * segment.w) * inv_length2, 0.0f, 1.0f);
    float ax = rx - along * segment.z;
    float ay = ry - along * segment.w;
    float inside = radius - wsqrt(ax * ax + ay * ay);
    float s = wclamp(inside * inv_fade, 0.0f, 1.0f);
    return s * s * (3.0f - 2.0f * s);
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
