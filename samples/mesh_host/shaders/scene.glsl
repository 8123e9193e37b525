// What every shader reads: numbers of the picture (Scene in drawing.hpp), chunks of the mesh, and the plugin's outputs in place.
layout(set = 0, binding = 0) uniform Scene {
    mat4 to_screen, from_screen; // from and to metres; depth is 1 near the eye and 0 infinitely far
    vec4 eye;                    // [m], w: simulated time [s]
    vec4 sun;                    // unit vector to the sun, w: side of a cell [m]
    vec4 lod;                    // the eye, its height above the relief's middle, and the mesh's reach [cells]
    ivec4 grid;                  // cells east, cells north, cells of a root chunk, cells of the longest side
    ivec4 rows[5];               // of each output: its first cell, and how far rows are apart [floats]
} S;
layout(set = 0, binding = 1) readonly buffer Chunks { ivec4 chunks[]; };
layout(set = 0, binding = 2) readonly buffer Output { float cells[]; } outputs[5];
const int GROUND = 0, SAND = 1, DEPTH = 2, SATURATION = 3, FOAM = 4; // World::OUTPUTS
ivec2 inside(ivec2 c) { return clamp(c, ivec2(0), S.grid.xy - 1); } // beyond the grid its rim goes on
float cell(int which, ivec2 c) { return outputs[which].cells[S.rows[which].x + inside(c).y * S.rows[which].y + inside(c).x]; }
float field(int which, vec2 at) { // bilinear between the centres of cells
    ivec2 c = ivec2(floor(at));
    vec2 f = at - vec2(c), south = vec2(cell(which, c), cell(which, c + ivec2(1, 0)));
    vec2 rows = mix(south, vec2(cell(which, c + ivec2(0, 1)), cell(which, c + 1)), f.y);
    return mix(rows.x, rows.y, f.x);
}
vec2 cells_of(vec3 place) { return clamp(place.xy / S.sun.w - 0.5, vec2(0.0), vec2(S.grid.xy - 1)); }
vec3 noise(vec2 p, float pixel) { // smooth, -1 ... 1, and its slopes; faded out where a pixel cannot show it
    vec2 base = floor(p), f = p - base, u = f * f * (3.0 - 2.0 * f);
    float corner[4];
    for (int n = 0; n < 4; ++n) {
        uvec2 q = uvec2(ivec2(base) + ivec2(n & 1, n >> 1));
        uint h = (q.x * 0x27d4eb2du) ^ (q.y * 0x165667b1u);
        h = (h ^ (h >> 15)) * 0x85ebca6bu;
        corner[n] = float((h ^ (h >> 13)) & 0xffffu) / 32767.5 - 1.0;
    }
    vec2 along_x = mix(vec2(corner[0], corner[1]), vec2(corner[2], corner[3]), u.y);
    vec2 along_y = mix(vec2(corner[0], corner[2]), vec2(corner[1], corner[3]), u.x);
    vec2 slope = 6.0 * f * (1.0 - f) * vec2(along_x.y - along_x.x, along_y.y - along_y.x);
    return vec3(mix(along_x.x, along_x.y, u.x), slope) * clamp(1.5 - 2.0 * pixel, 0.0, 1.0);
}
const vec3 SUNLIGHT = vec3(2.7, 2.25, 1.7);
vec3 sky(vec3 along) {
    float up = clamp(along.z, 0.0, 1.0), to_sun = max(dot(along, S.sun.xyz), 0.0);
    vec3 colour = mix(vec3(0.66, 0.76, 0.88), vec3(0.12, 0.29, 0.64), 1.0 - pow(1.0 - up, 3.0));
    return colour + SUNLIGHT * (0.05 * pow(to_sun, 10.0) + 0.2 * pow(to_sun, 300.0));
}
vec3 sky_light(vec3 normal) { return mix(vec3(0.16, 0.13, 0.10), vec3(0.32, 0.42, 0.60), 0.5 + 0.5 * normal.z); }
vec4 shown(vec3 light, vec3 way, float cover) { // after so many metres of haze; a filmic curve; the display's encoding
    float lengths = length(way) / (S.sun.w * float(S.grid.w));
    light = 0.72 * mix(sky(normalize(vec3(way.xy, 0.0))), light, exp(-pow(lengths / 9.0, 1.5)));
    light = light * (2.35 * light + 0.14) / (light * (2.28 * light + 0.70) + 0.17);
    return vec4(pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.2)), cover);
}
