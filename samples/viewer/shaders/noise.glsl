// Hashes and gradient noise. Integer hashes: the same picture on every device.
uint hash_of(uvec2 v) {
    uint h = v.x * 0x9E3779B1u ^ (v.y + 0x7F4A7C15u) * 0x85EBCA77u;
    h ^= h >> 15; h *= 0x2C1B3C6Du;
    h ^= h >> 12; h *= 0x297A2D39u;
    return h ^ (h >> 15);
}
float unit_of(uint h) { return float(h >> 8) * (1.0 / 16777216.0); }

// Value noise in [-1, 1] with its derivatives: x value, yz d/dp.
vec3 noise_slopes(vec2 p) {
    vec2 cell = floor(p), f = p - cell;
    uvec2 k = uvec2(ivec2(cell));
    float a = unit_of(hash_of(k)), b = unit_of(hash_of(k + uvec2(1u, 0u)));
    float c = unit_of(hash_of(k + uvec2(0u, 1u))), d = unit_of(hash_of(k + uvec2(1u, 1u)));
    vec2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0), du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    float e = a - b - c + d;
    float value = a + (b - a) * u.x + (c - a) * u.y + e * u.x * u.y;
    return vec3(2.0 * value - 1.0, 2.0 * du * vec2(b - a + e * u.y, c - a + e * u.x));
}

// How much of a pattern of this wavelength a pixel of this size still shows.
float resolved(float wavelength, float pixel) { return clamp(0.5 * wavelength / pixel - 0.5, 0.0, 1.0); }
