// Hashes and noise. Integer hashes: the same picture on every device. Patterns of materials are in metres.
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

// Gradient noise in space with its derivatives, from the image that bake.comp makes: x value, about -1 ... 1; yzw d/dp. It repeats
// after NOISE_PERIOD, which turned octaves hide.
const float NOISE_PERIOD = 8.0;
vec4 noise_in_space(vec3 p) { return textureLod(noise_image, p / NOISE_PERIOD, 0.0); }

const mat3 TURNED = mat3(0.00, 0.80, 0.60, -0.80, 0.36, -0.48, -0.60, -0.48, 0.64);

// Octaves of it from `wave` [m] down, each 0.45 as long, `keep` as steep as the last, and turned: x value, yzw slope. Those that a pixel
// no longer shows fade out, and close to the eye those that are far longer than the shortest that it shows, so that their number is
// bounded. crease: 0 = round lumps, 1 = lumps that meet in sharp creases.
vec4 rough(vec3 place, float wave, float keep, float crease, float pixel) {
    vec4 sum = vec4(0.0);
    float steep = 1.0;
    mat3 turn = TURNED;
    // Loops are bounded by a count: some drivers give up on others.
    float longest = 6.0 * pixel * pow(2.2222, F.domain.w), shift = 0.0;
    for (int n = 0; n < 12 && wave > longest; ++n, shift += 17.3) {
        wave *= 0.45;
        steep *= keep;
        turn = turn * TURNED;
    }
    for (int n = 0; n < int(F.domain.w); ++n, shift += 17.3) {
        float seen = resolved(wave, pixel) * (1.0 - smoothstep(0.5 * longest, longest, wave));
        if (seen <= 0.0 && wave < longest * 0.4) break;
        vec4 g = noise_in_space(place * turn / wave + shift);
        g = mix(g, g.x > 0.0 ? g : -g, crease) - vec4(0.3 * crease, vec3(0.0));
        sum += steep * seen * vec4(g.x, turn * g.yzw);
        wave *= 0.45;
        steep *= keep;
        turn = turn * TURNED;
    }
    return sum;
}

// Cells round random points (S. Worley, A Cellular Texture Basis Function, 1996): how much farther the second nearest point is than
// the nearest, 0 on the walls between cells.
float from_cell_wall(vec2 p) {
    ivec2 base = ivec2(floor(p));
    float nearest = 9.0, second = 9.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 k = base + ivec2(x, y);
            uint h = hash_of(uvec2(k));
            vec2 to = vec2(k) + vec2(unit_of(h), unit_of(h * 747796405u + 3u)) - p;
            float far2 = dot(to, to);
            second = min(second, max(nearest, far2));
            nearest = min(nearest, far2);
        }
    }
    return sqrt(second) - sqrt(nearest);
}
