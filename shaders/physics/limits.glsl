// What mark_limits marks of a layer, and counts of it.
#ifndef PHYSICS_LIMITS
#define PHYSICS_LIMITS

#define MARK_WET 1u        // each face beside a wet cell: up to 2
#define MARK_CLAMPED_x 4u  // the west face at the clamp, of water once for each of its layers: up to 2
#define MARK_CLAMPED_y 16u // the south face
#define MARK_CAPPED_x 64u  // its gravity is capped
#define MARK_CAPPED_y 128u
#define MARK_LIMITED 256u  // what leaves the cell is limited
#define SAND_MARKS 16      // bits from those of water to those of sand

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

// Whether one of a cell's four faces is at the clamp, or capped, by the marks of the cell and its neighbours to the east and north.
FN bool clamped_beside(uint own, uint east, uint north) {
    return ((own & (3u * MARK_CLAMPED_x + 3u * MARK_CLAMPED_y)) | (east & (3u * MARK_CLAMPED_x)) | (north & (3u * MARK_CLAMPED_y))) != 0u;
}
FN bool capped_beside(uint own, uint east, uint north) {
    return ((own & (MARK_CAPPED_x + MARK_CAPPED_y)) | (east & MARK_CAPPED_x) | (north & MARK_CAPPED_y)) != 0u;
}

#endif
