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
#define FACE_MARKS_x ((3u * MARK_CLAMPED_x + MARK_CAPPED_x) * 65537u) // all of a west face
#define FACE_MARKS_y ((3u * MARK_CLAMPED_y + MARK_CAPPED_y) * 65537u)

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
