// Counts of what mark_limits marks of a layer.
#ifndef PHYSICS_LIMITS
#define PHYSICS_LIMITS

#include "../physics/limit_marks.glsl"

struct LimitCount {
    uint wet, clamped, capped, limited;
};

FN LimitCount no_limits() {
    LimitCount none;
    none.wet = 0u;
    none.clamped = 0u;
    none.capped = 0u;
    none.limited = 0u;
    return none;
}

FN void add_marks(REF(LimitCount) count, uint marks) {
    count.wet += marks & 3u;
    count.clamped += ((marks >> 2) & 3u) + ((marks >> 4) & 3u);
    count.capped += ((marks >> 6) & 1u) + ((marks >> 7) & 1u);
    count.limited += (marks >> 8) & 1u;
}

FN bool any_clamped(uint marks) { return (marks & (3u * MARK_CLAMPED_x + 3u * MARK_CLAMPED_y)) != 0u; }
FN bool any_capped(uint marks) { return (marks & (MARK_CAPPED_x + MARK_CAPPED_y)) != 0u; }

#endif
