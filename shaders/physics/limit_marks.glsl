// Bits by which mark_limits says where guards are at work: plain #defines, which hosts read too.
#ifndef PHYSICS_LIMIT_MARKS
#define PHYSICS_LIMIT_MARKS

#define MARK_WET 1u        // each face beside a wet cell: up to 2
#define MARK_CLAMPED_x 4u  // the west face at the clamp, of water once for each of its layers: up to 2
#define MARK_CLAMPED_y 16u // the south face
#define MARK_CAPPED_x 64u  // its gravity is capped
#define MARK_CAPPED_y 128u
#define MARK_LIMITED 256u  // what leaves the cell is limited
#define MARK_HIGH 512u     // the column stands above the largest height
#define SAND_MARKS 16      // bits from those of water to those of sand
#define FACE_MARKS_x ((3u * MARK_CLAMPED_x + MARK_CAPPED_x) * 65537u) // all of a west face
#define FACE_MARKS_y ((3u * MARK_CLAMPED_y + MARK_CAPPED_y) * 65537u)

// Of the LIMIT_WORDS that count_limits makes of them.
#define LIMIT_SUMS 9   // counts; behind them are floats by their bits
#define LIMIT_LEAST 12 // of those the one of which the least is wanted

#endif
