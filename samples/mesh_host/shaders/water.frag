#version 450
#extension GL_GOOGLE_include_directive : require
// Water over the ground that is drawn already: its own colour covers more of it the longer the way through it is.
#include "scene.glsl"
layout(location = 0) in vec3 place;
layout(location = 0) out vec4 colour;

float surface(vec2 at) { return field(GROUND, at) + field(DEPTH, at); }

void main() {
    vec2 at = cells_of(place);
    float dx = S.sun.w, depth = place.z - field(GROUND, at), pixel = length(fwidth(place.xy)), reach = max(1.0, pixel / dx);
    if (depth <= 0.0) discard;
    vec2 east = vec2(reach, 0.0), north = vec2(0.0, reach);
    vec2 slope = vec2(surface(at + east) - surface(at - east), surface(at + north) - surface(at - north)) / (2.0 * reach * dx);
    for (int n = 0; n < 3; ++n) { // small waves that no cell holds
        float wave = max(1.1, 2.0 * dx) / float(1 + n * n), turn = 0.7 + 1.9 * float(n);
        vec2 moved = place.xy + vec2(cos(turn), sin(turn)) * (S.eye.w * sqrt(wave));
        slope += 0.025 * smoothstep(0.0, 0.3 * dx, depth) * noise(moved / wave, pixel / wave).yz;
    }
    vec3 normal = normalize(vec3(-slope, 1.0)), way = place - S.eye.xyz, along = normalize(way), mirrored = reflect(along, normal);
    mirrored = normalize(vec3(mirrored.xy, max(mirrored.z, 0.02)));
    float path = depth / max(-along.z, 0.2) / (0.02 * dx * float(S.grid.w)), cover = 1.0 - exp(-1.1 * path); // clear for a fiftieth of the grid
    vec3 body = mix(vec3(0.040, 0.140, 0.145), vec3(0.006, 0.040, 0.070), 1.0 - exp(-0.4 * path));
    body *= SUNLIGHT * S.sun.z + sky_light(vec3(0.0, 0.0, 1.0));
    float fresnel = 0.02 + 0.98 * pow(1.0 - clamp(dot(normal, -along), 0.0, 1.0), 5.0);
    body = mix(body, sky(mirrored), fresnel) + SUNLIGHT * (2.0 * pow(max(dot(mirrored, S.sun.xyz), 0.0), 350.0));
    float foam = field(FOAM, at) * exp(-0.1 * distance(place.xy / dx - 0.5, at)); // less beyond the rim
    float net = 0.5 + 0.3 * noise(place.xy / 0.8, pixel / 0.8).x + 0.2 * noise(place.yx / 0.23, pixel / 0.23).x;
    foam = 0.9 * smoothstep(1.0 - 0.8 * foam, 1.5 - 0.8 * foam, net); // it tears into a net
    body = mix(body, 0.7 * (SUNLIGHT * max(dot(normal, S.sun.xyz), 0.2) + sky_light(normal)), foam);
    cover = max(max(cover, fresnel), foam) * smoothstep(0.0, 0.03 * dx, depth); // no hard edge where it ends
    colour = shown(body, way, cover);
}
