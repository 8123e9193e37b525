#version 450
#extension GL_GOOGLE_include_directive : require
// Rock and sand. Light comes from the cells themselves, per pixel: the mesh may be as coarse as it likes.
#include "scene.glsl"
layout(location = 0) in vec3 place;
layout(location = 0) out vec4 colour;

float sunlit(vec2 at) { // the share of the sun that passes the relief
    float lit = 1.0, away = 1.2, start = field(GROUND, at), steep = S.sun.z / length(S.sun.xy);
    for (int n = 0; n < 36 && lit > 0.0; ++n, away *= 1.14) {
        float above = start + steep * away * S.sun.w - field(GROUND, at + normalize(S.sun.xy) * away);
        lit = min(lit, 0.5 + above / (0.12 * away * S.sun.w)); // the penumbra grows with the distance
    }
    return smoothstep(0.0, 1.0, lit);
}

void main() {
    vec2 at = cells_of(place);
    float dx = S.sun.w, pixel = length(fwidth(place.xy)), reach = max(1.0, pixel / dx); // [m], [m], [cells]
    vec2 east = vec2(reach, 0.0), north = vec2(0.0, reach);
    vec4 around = vec4(field(GROUND, at + east), field(GROUND, at - east), field(GROUND, at + north), field(GROUND, at - north));
    vec2 slope = vec2(around.x - around.y, around.z - around.w) / (2.0 * reach * dx);
    float drowned = smoothstep(0.0, 0.02 * dx, field(DEPTH, at)), wet = max(smoothstep(0.02, 0.42, field(SATURATION, at)), drowned);
    float cover = smoothstep(0.02, 0.2, field(SAND, at) / dx), steep = smoothstep(0.3, 1.2, length(slope));

    // Patterns in metres: lumps and grit of sand, stones, and beds of rock that a cliff cuts. They grow where cells are wide.
    float stone = max(1.6, 3.0 * dx), bed = max(0.5, 1.5 * dx);
    vec3 lumps = noise(place.xy / 0.9, pixel / 0.9), grit = noise(place.xy / 0.04, pixel / 0.04);
    vec3 stones = noise(place.xy / stone, pixel / stone) + 0.5 * noise(place.yx / (0.37 * stone), pixel / (0.37 * stone));
    float beds = noise(vec2(0.04 * (place.x + place.y), place.z) / bed, pixel / bed).x;
    vec3 sand = vec3(0.58, 0.42, 0.24) * (1.0 + 0.07 * lumps.x + 0.12 * grit.x) * mix(vec3(1.0), vec3(0.42, 0.37, 0.32), wet);
    vec3 rock = mix(vec3(0.27, 0.23, 0.18) * (1.0 + 0.22 * stones.x), vec3(0.33, 0.25, 0.18) * (1.0 + 0.45 * beds), steep);
    rock *= 1.0 - 0.45 * drowned;
    slope += mix((1.0 - 0.6 * steep) * 0.10 * stones.yz, 0.04 * lumps.yz + 0.06 * grit.yz, cover);

    vec3 normal = normalize(vec3(-slope, 1.0)), way = place - S.eye.xyz, to_eye = -normalize(way);
    float hollow = dot(around, vec4(0.25)) - field(GROUND, at), open = clamp(1.0 - 1.5 * hollow / (reach * dx), 0.4, 1.0); // to the sky
    vec3 sun = SUNLIGHT * sunlit(at);
    vec3 light = mix(rock, sand, cover) * (sun * max(dot(normal, S.sun.xyz), 0.0) + sky_light(normal) * open);
    // Wet ground mirrors some of the sky, and the sun broadly.
    float fresnel = 0.02 + 0.5 * pow(1.0 - max(dot(normal, to_eye), 0.0), 5.0);
    float gloss = pow(max(dot(normal, normalize(to_eye + S.sun.xyz)), 0.0), 60.0);
    light += wet * (fresnel * sky(reflect(-to_eye, normal)) + 0.15 * gloss * sun);
    colour = shown(light, way, 1.0);
}
