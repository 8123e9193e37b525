// Rays through the height fields. The pyramid skips blocks that a ray passes above; in a patch between four cell centres the
// surfaces are bilinear, a ray is quadratic over them, and the first root is exact.
const float NO_ROOT = -1e30, NEVER = 1e18;
const int MARCH_SOLID = 1, MARCH_WATER = 2;

// First t in [t0, t1] at which the ray is at or below the bilinear patch with corners h (x: west south, y: east south,
// z: west north, w: east north); NO_ROOT = none. p, d: place in the patch and direction, in cells; z, dz: height.
float patch_root(vec4 h, vec2 p, vec2 d, float z, float dz, float t0, float t1) {
    float gx = h.y - h.x, gy = h.z - h.x, gxy = h.x - h.y - h.z + h.w;
    // z + dz t - h(p + d t) = c + b t + a t^2
    float a = -gxy * d.x * d.y;
    float b = dz - gx * d.x - gy * d.y - gxy * (p.x * d.y + p.y * d.x);
    float c = z - h.x - gx * p.x - gy * p.y - gxy * p.x * p.y;
    if (c + t0 * (b + a * t0) <= 0.0) return t0;
    float root;
    if (abs(a) < 1e-7 * abs(b)) {
        root = b < 0.0 ? -c / b : NO_ROOT;
    } else {
        float discriminant = b * b - 4.0 * a * c;
        if (discriminant < 0.0) return NO_ROOT;
        float q = -0.5 * (b + (b < 0.0 ? -sqrt(discriminant) : sqrt(discriminant)));
        float r0 = q / a, r1 = q != 0.0 ? c / q : NO_ROOT;
        float low = min(r0, r1), high = max(r0, r1);
        root = low >= t0 ? low : high;
    }
    return root >= t0 && root <= t1 ? root : NO_ROOT;
}

struct Hit {
    float t; // [m]; -1 = none
    int surface;
};

// From `from` along the unit vector `along` for t in [t0, t_end] [m], within the block.
Hit march(vec3 from, vec3 along, float t0, float t_end, int surfaces, int most_steps) {
    vec2 o = cell_of(from.xy) + 1.0; // patch (a, b) is [a, a + 1) x [b, b + 1)
    vec2 d = along.xy / F.domain.x;
    vec2 inverse = vec2(abs(d.x) > 1e-9 ? 1.0 / d.x : 1e18, abs(d.y) > 1e-9 ? 1.0 / d.y : 1e18);
    vec2 ahead = vec2(greaterThan(d, vec2(0.0)));
    float nudge = 1e-3 * F.domain.x / max(max(abs(d.x), abs(d.y)) * F.domain.x, 1e-3);
    int top = F.grid.z - 1, level = top;
    float t = t0;
    Hit hit = Hit(-1.0, 0);
    for (int n = 0; n < most_steps && t < t_end; ++n) {
        float size = exp2(float(level));
        vec2 q = o + d * t;
        vec2 block = floor(q / size);
        vec2 leave = ((block + ahead) * size - o) * inverse;
        float t1 = min(min(max(leave.x, t), max(leave.y, t)) + nudge + 4e-7 * t, t_end);
        float highest = texelFetch(pyramid, pyramid_texel(ivec2(block), level), 0).x;
        float z = from.z + along.z * t;
        float lowest = min(z, from.z + along.z * t1);
        if (lowest > highest) {
            t = t1;
            level = min(level + 1, top);
        } else if (level > 0) {
            if (z > highest) t = max(t, (highest - from.z) / along.z); // falls to the block's top: nothing before
            level -= 1;
        } else {
            vec2 base = floor(q), p = q - base; // from here on, not from the eye: far away the quadratic would lose its digits
            vec2 corner = clamp(base, vec2(0.0), vec2(F.grid.xy)) / vec2(F.grid.xy); // textureGather takes the four texels round it
            float early = max(t - 2.0 * nudge, t0) - t, late = t1 - t;
            if ((surfaces & MARCH_SOLID) != 0) {
                vec4 g = textureGather(heights, corner, 0);
                float root = patch_root(vec4(g.w, g.z, g.x, g.y), p, d, z, along.z, early, late);
                if (root >= early) hit = Hit(t + root, MARCH_SOLID);
            }
            if ((surfaces & MARCH_WATER) != 0) {
                vec4 g = textureGather(heights, corner, 1);
                float root = patch_root(vec4(g.w, g.z, g.x, g.y), p, d, z, along.z, early, late);
                if (root >= early && (hit.t < 0.0 || t + root < hit.t)) hit = Hit(t + root, MARCH_WATER);
            }
            if (hit.t >= 0.0) break;
            t = t1;
        }
    }
    return hit;
}

// Where a ray is inside the block's footprint and below its top: x = enter, y = leave; enter > leave = never. axis: the wall
// it enters by, 0 = east or west, 1 = south or north, 2 = top or inside.
vec2 block_span(vec3 from, vec3 along, out int axis) {
    vec2 inverse = vec2(abs(along.x) > 1e-9 ? 1.0 / along.x : 1e18, abs(along.y) > 1e-9 ? 1.0 / along.y : 1e18);
    vec2 a = -from.xy * inverse, b = (F.domain.yz - from.xy) * inverse;
    vec2 near = min(a, b), far = max(a, b);
    float enter = max(near.x, near.y), leave = min(far.x, far.y);
    axis = near.x > near.y ? 0 : 1;
    if (along.z < 0.0) {
        float falls = (summit() - from.z) / along.z;
        if (falls > enter) { enter = falls; axis = 2; }
        leave = min(leave, (F.plinth.w - from.z) / along.z);
    } else if (along.z > 0.0) {
        leave = min(leave, (summit() - from.z) / along.z);
    }
    if (enter <= 0.0) { enter = 0.0; axis = 2; }
    return vec2(enter, leave);
}
