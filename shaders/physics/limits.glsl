// Counts of what mark_limits marks, of one layer.
#ifndef PHYSICS_LIMITS
#define PHYSICS_LIMITS

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
    count.clamped += (marks >> 2) & 7u;
    count.capped += (marks >> 5) & 3u;
    count.limited += (marks >> 7) & 1u;
}

#endif
