#version 450
#extension GL_GOOGLE_include_directive : require
// The light that comes from what the eye meets, in linear units, tone-mapped and averaged over samples.
#include "frame.glsl"
#include "march.glsl"
#include "noise.glsl"
#include "sky.glsl"
#include "beyond.glsl"
#include "ground.glsl"
#include "waves.glsl"
#include "false_colour.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 21, rgba32f) readonly uniform image2D seen_image;
layout(set = 0, binding = 22, rgba16f) uniform image2D to_colour;

// A filmic curve: linear in the shadows, rolling off towards 1.
vec3 tone_mapped(vec3 c) {
    c *= F.sunlight.w;
    vec3 mapped = (c * (2.35 * c + 0.14)) / (c * (2.28 * c + 0.70) + 0.17);
    return clamp(mapped, vec3(0.0), vec3(1.0));
}

// The plane below the block, with the block's shadow.
vec3 shade_plinth(vec3 place, vec3 along) {
    float sun = 1.0;
    int axis;
    vec3 start = place + vec3(0.0, 0.0, 1e-3 * F.domain.x);
    vec2 span = block_span(start, F.sun.xyz, axis);
    if (span.x < span.y && span.x > 0.0) {
        vec3 entry = start + F.sun.xyz * span.x;
        bool wall = entry.z < heights_at(entry.xy).x;
        sun = wall || march(start, F.sun.xyz, span.x, span.y, MARCH_SOLID, F.march_steps.y).t >= 0.0 ? 0.0 : 1.0;
    }
    vec2 outside = max(max(-place.xy, place.xy - F.domain.yz), vec2(0.0));
    float height = summit() - F.plinth.w;
    float open = 1.0 - 0.55 * exp(-2.0 * length(outside) / height);
    vec3 colour = F.plinth.rgb * (F.sunlight.rgb * (F.sun.z * sun) + ambient_on(vec3(0.0, 0.0, 1.0), open));
    vec2 middle = 0.5 * F.domain.yz;
    float far = length(place.xy - middle) / max(F.domain.y, F.domain.z);
    return mix(colour, F.horizon.rgb, smoothstep(0.8, 6.0, far));
}

// Cut faces show the layers: rock below, sand on it.
vec3 shade_wall(vec3 place, vec3 normal, float pixel) {
    vec4 h = heights_at(place.xy);
    float pores = textureLod(matter, texture_of(place.xy), 0.0).x;
    float bedding = noise_slopes(vec2((place.x + place.y) * 0.05, place.z) / (1.4 * F.domain.x)).x;
    vec3 rock = F.rock.rgb * vec3(0.62, 0.58, 0.55) * (1.0 + 0.18 * bedding);
    vec3 sand = mix(F.sand_dry.rgb, F.sand_wet.rgb, max(smoothstep(0.0, 0.4, pores), h.y > h.x ? 1.0 : 0.0));
    vec3 albedo = mix(rock, sand, smoothstep(-pixel, pixel, place.z - (h.x - h.w)) * smoothstep(0.3 * F.rock.w, F.rock.w, h.w));
    float foot = 1.0 - 0.5 * exp(-3.0 * (place.z - F.plinth.w) / (summit() - F.plinth.w));
    return albedo * (F.sunlight.rgb * max(dot(normal, F.sun.xyz), 0.0) + ambient_on(normal, foot));
}

// What comes through `path` metres of water from below. lights: what shines into it; mud: see mud_in.
vec3 through_water(vec3 below, float path, vec3 mud, vec3 lights) {
    vec3 through = exp(-(F.water.rgb + mud) * path);
    vec3 glow = mix(F.water_glow.rgb, 1.5 * F.sand_wet.rgb, mud / (F.water.rgb + mud + 1e-6));
    return below * through + glow * lights * (1.0 - through);
}

float fresnel_of(vec3 normal, vec3 along) { return 0.02 + 0.98 * pow(1.0 - clamp(-dot(normal, along), 0.0, 1.0), 5.0); }

// Foam takes the colour of the water that it is whipped from; mud: see mud_in.
vec3 foam_colour(vec3 normal, vec4 lit, vec3 mud) {
    float facing = 0.35 + 0.65 * max(dot(normal, F.sun.xyz), 0.0);
    vec3 white = mix(vec3(0.8), 1.6 * F.sand_wet.rgb, 0.75 * (1.0 - exp(-mud)));
    return white * (F.sunlight.rgb * (lit.x * facing) + ambient_on(normal, lit.y));
}

// The land beyond the block. Shadows, foam and wet ground of the rim fade out from it.
vec3 shade_beyond(vec3 place, vec3 along, bool water, float pixel) {
    vec2 rim = on_block(place.xy), uv = texture_of(rim);
    float away = length(place.xy - rim) / max(F.domain.y, F.domain.z), near = exp(-20.0 * away);
    vec2 inside = vec2(equal(rim, place.xy));
    vec4 h = heights_at(rim), slope = textureLod(slopes, uv, 0.0) * inside.xyxy;
    Ground g = ground_at(vec3(rim, place.z), -along, pixel);
    g.place = place;
    g.normal = normalize(vec3(-slope.xy, 1.0));
    g.sun = mix(1.0, g.sun, near);
    g.sky = mix(1.0, g.sky, near);
    g.wet *= near;
    vec4 lit = vec4(g.sun, g.sky, 0.0, 0.0);
    vec3 colour = vec3(0.0);
    WHERE (water) {
        vec4 state = textureLod(matter, uv, 0.0), moving = textureLod(flow, uv, 0.0);
        float depth = h.y - h.x, cover = smoothstep(0.0, 3.0 * F.water.w, depth);
        Carried carried = carried_at(place.xy, moving.xy);
        vec3 normal = normalize(vec3(-slope.zw - ripple_slopes(carried, length(moving.xy), pixel) * cover, 1.0));
        vec3 mirrored = reflect(along, normal);
        float path = depth / max(-refract(along, normal, 0.75).z, 0.1);
        vec3 mud = mud_in(state.w, depth) * cover;
        g.drowned = cover;
        g.sun *= caustics_at(place.xy, depth, pixel) * exp(-0.35 * dot(F.water.rgb, vec3(0.33)) * depth);
        g.place = vec3(place.xy, h.x);
        vec3 lights = F.sunlight.rgb * (0.75 * lit.x * F.sun.z) + ambient_on(vec3(0.0, 0.0, 1.0), lit.y);
        colour = through_water(shade_ground(g), path, mud, lights);
        colour = mix(colour, sky_in(normalize(vec3(mirrored.xy, max(mirrored.z, 0.01)))), drawn(REFLECTION) ? fresnel_of(normal, along) * cover : 0.0);
        colour += F.sunlight.rgb * (lit.x * cover * 2.5 * pow(max(dot(mirrored, F.sun.xyz), 0.0), 350.0));
        colour = mix(colour, foam_colour(normal, lit, mud), near * foam_cover(carried, state.y, depth, pixel) * cover);
    }
    WHERE (!water) colour = shade_ground(g);
    return colour;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, F.image.xy))) return;
    vec4 seen = imageLoad(seen_image, pixel);
    int kind = int(seen.w + 0.5);
    vec3 place = seen.xyz;
    vec3 along = ray_through(vec2(pixel));
    float distance = length(place - eye_place());
    float pixel_size = F.lens.w * distance;
    bool water = kind == KIND_WATER || kind == KIND_WATER_WALL;
    bool wall = kind == KIND_SOLID_WALL || kind == KIND_WATER_WALL;
    vec2 uv = texture_of(place.xy);
    vec3 to_wall = vec3(0.0);
    WHERE (wall) {
        vec2 to_low = abs(place.xy), to_high = abs(place.xy - F.domain.yz);
        float nearest = min(min(to_low.x, to_low.y), min(to_high.x, to_high.y));
        to_wall = to_low.x == nearest ? vec3(-1, 0, 0) : to_low.y == nearest ? vec3(0, -1, 0) : to_high.x == nearest ? vec3(1, 0, 0) : vec3(0, 1, 0);
    }

    // Water bends the ray down to the ground below and mirrors another.
    vec3 ground = place, normal = vec3(0.0, 0.0, 1.0), mirrored = along;
    float path = 0.0, foam = 0.0, cover = 0.0, fresnel = 0.0;
    vec4 lit = vec4(1.0);
    vec3 mirror_colour = vec3(0.0), mud = vec3(0.0);
    bool lost = false; // the bent ray leaves the block without meeting ground
    WHERE (water) {
        vec4 state = textureLod(matter, uv, 0.0);
        vec2 velocity = textureLod(flow, uv, 0.0).xy;
        lit = textureLod(light, uv, 0.0);
        if (!drawn(SHADOWS)) lit.x = 1.0;
        vec4 h = heights_at(place.xy);
        cover = smoothstep(0.0, 3.0 * F.water.w, h.y - h.x);
        Carried carried = carried_at(place.xy, velocity);
        mud = mud_in(state.w, h.y - h.x) * cover;
        foam = foam_cover(carried, state.y, h.y - h.x, pixel_size) * cover;
        vec2 slope = textureLod(slopes, uv, 0.0).zw + ripple_slopes(carried, length(velocity), pixel_size) * cover;
        normal = wall ? normalize(to_wall + vec3(0.15 * slope, 0.0)) : normalize(vec3(-slope, 1.0));
        if (dot(normal, along) > -0.02) normal = normalize(normal - along * (dot(normal, along) + 0.02));
        vec3 bent = drawn(REFRACTION) ? refract(along, normal, mix(1.0, 0.75, cover)) : along;
        int axis;
        vec3 inside = place - (wall ? to_wall * (1e-3 * F.domain.x) : vec3(0.0));
        vec2 span = block_span(inside, bent, axis);
        float most = 8.0 / max(F.water.z, 1e-3);
        Hit bed = march(inside, bent, 0.0, min(span.y, most), MARCH_SOLID, F.march_steps.z);
        path = bed.t >= 0.0 ? bed.t : min(span.y, most);
        lost = bed.t < 0.0 && span.y < most;
        if (lost && goes_on()) { // on to the bed beyond the block
            path = min((place.z - h.x) / max(-bent.z, 0.1), most);
            lost = false;
        }
        ground = inside + bent * path;
        fresnel = drawn(REFLECTION) ? fresnel_of(normal, along) * cover : 0.0;
        mirrored = reflect(along, normal);
        if (!wall) mirrored = normalize(vec3(mirrored.xy, max(mirrored.z, 0.01)));
        mirror_colour = mirrored.z > 0.0 ? sky_in(mirrored) : F.plinth.rgb * F.sunlight.rgb * F.sun.z;
        if (wall) fresnel = min(fresnel, 0.06);
    }

    // Ground that is seen directly or through water, then ground in the mirror.
    vec3 colour = vec3(0.0);
    WHERE (kind == KIND_SOLID || water) {
        int turns = 1;
        vec3 other = place;
        WHERE (water && !wall && F.march_steps.y > 0 && fresnel > 0.015) {
            int axis;
            vec2 span = block_span(place, mirrored, axis);
            Hit bank = march(place, mirrored, 0.05 * F.domain.x, span.y, MARCH_SOLID, F.march_steps.y);
            if (bank.t >= 0.0) {
                other = place + mirrored * bank.t;
                turns = 2;
            }
        }
        for (int turn = 0; turn < turns; ++turn) {
            Ground g = ground_at(turn == 0 ? ground : other, turn == 0 ? -along : -mirrored, pixel_size);
            if (turn == 0 && water) {
                g.drowned = max(cover, 0.0);
                // Sunlight on its way down, spread by the waves.
                float down = max(heights_at(ground.xy).y - ground.z, 0.0);
                g.sun = mix(g.sun, lit.x, 0.5) * caustics_at(ground.xy, down, pixel_size) * exp(-0.35 * dot(F.water.rgb, vec3(0.33)) * down);
            }
            vec3 light_back = shade_ground(g);
            WHERE (F.features.y != 0 && kind == KIND_SOLID) { // what the water has left
                float left = textureLod(matter, uv, 0.0).y;
                light_back = mix(light_back, foam_colour(g.normal, vec4(g.sun, g.sky, 0.0, 0.0), vec3(0.0)), foam_cover(carried_at(place.xy, vec2(0.0)), left, 0.0, pixel_size));
            }
            if (turn == 0) colour = light_back;
            else mirror_colour = light_back;
        }
    }
    WHERE (kind == KIND_SKY) colour = sky_in(along) + sun_disc(along);
    WHERE (kind == KIND_PLINTH) colour = shade_plinth(place, along);
    WHERE (kind == KIND_SOLID_WALL) colour = shade_wall(place, to_wall, pixel_size);
    WHERE (water) {
        if (lost) colour = ambient_on(vec3(0.0, 0.0, 1.0), 1.0) * 0.5;
        vec3 lights = F.sunlight.rgb * (0.75 * lit.x * F.sun.z) + ambient_on(vec3(0.0, 0.0, 1.0), lit.y);
        colour = through_water(colour, path, mud, lights);
        float glint = pow(max(dot(reflect(along, normal), F.sun.xyz), 0.0), 350.0);
        colour = mix(colour, mirror_colour, fresnel) + F.sunlight.rgb * (lit.x * cover * 2.5 * glint);
        colour = mix(colour, foam_colour(normal, lit, mud), wall ? 0.0 : foam);
    }
    WHERE (kind >= KIND_FAR_SOLID) colour = shade_beyond(place, along, kind == KIND_FAR_WATER, pixel_size);
    WHERE (goes_on() && kind >= KIND_SOLID) colour = through_air(colour, along, distance);
    colour = tone_mapped(colour);
    WHERE (F.view.x != 0 && kind >= KIND_SOLID) {
        vec2 slope = textureLod(slopes, uv, 0.0).xy;
        float shape = wall ? 0.6 : 0.55 + 0.45 * max(dot(normalize(vec3(-slope, 1.0)), F.sun.xyz), 0.0) / F.sun.z;
        float x = (quantity_at(F.view.x, place.xy) - F.range.x) / (F.range.y - F.range.x);
        colour = ramp(x) * shape;
    }
    bool marked = F.view.y != 0 || F.view.z != 0;
    WHERE (marked && (kind == KIND_SOLID || kind == KIND_WATER)) colour = draw_marks(colour, place.xy, pixel_size);

    if (F.image.z > 0) colour = mix(imageLoad(to_colour, pixel).rgb, colour, F.lens.z);
    imageStore(to_colour, pixel, vec4(colour, 1.0));
}
