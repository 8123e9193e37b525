// Light that solid ground sends to the eye: rock, and sand from dry to soaked.

// Wind ripples and grains as slopes to add to those of the height field.
vec2 sand_ripples(vec2 xy, vec2 slope, float pixel, float dry) {
    float wave = 0.45 * F.domain.x; // between crests [m]
    vec2 sum = vec2(0.0);
    float seen = resolved(wave, pixel) * dry;
    WHERE (seen > 0.0) {
        vec2 bend = noise_slopes(xy / (wave * 9.0)).yz;
        vec2 q = xy / wave + 1.6 * bend;
        float steep = clamp(1.0 - 1.2 * length(slope), 0.0, 1.0); // they do not stand on slopes that slide
        sum += vec2(0.92, 0.39) * (cos(6.2831853 * dot(q, vec2(0.92, 0.39))) * 0.11 * seen * steep);
    }
    float grains = 0.16 * F.domain.x;
    seen = resolved(grains, pixel);
    WHERE (seen > 0.0) sum += noise_slopes(xy / grains).yz * (0.10 * seen);
    return sum;
}

// Grains that mirror the sun towards the eye: a random normal per grain, grains as large as a pixel at least.
float glitter_on(vec3 place, vec3 normal, vec3 halfway, float pixel) {
    float size = exp2(ceil(log2(max(pixel, 0.004 * F.domain.x))));
    uvec3 k = uvec3(ivec3(floor(place / size)));
    uint h = hash_of(k.xy + k.z * 7919u);
    vec3 grain = vec3(unit_of(h), unit_of(h * 747796405u + 1u), unit_of(h * 2891336453u + 7u)) * 2.0 - 1.0;
    float facing = dot(normalize(normal + 0.9 * grain), halfway);
    return smoothstep(0.994, 1.0, facing);
}

vec3 rock_colour(vec3 place, vec3 normal, float pixel) {
    float layer = 0.35 * F.domain.x * 4.0;
    float strata = resolved(layer, pixel) * noise_slopes(vec2(place.z / layer, (place.x + place.y) * 0.02 / layer)).x;
    float spots = noise_slopes(mat2(0.80, 0.60, -0.60, 0.80) * place.xy / (7.0 * F.domain.x)).x;
    vec3 flat_ground = F.rock.rgb * (1.0 + 0.12 * spots);
    vec3 cliff = F.rock.rgb * vec3(0.80, 0.72, 0.66) * (1.0 + 0.16 * strata);
    return mix(cliff, flat_ground, smoothstep(0.55, 0.85, normal.z));
}

struct Ground {
    vec3 place, normal; // normal of the height field
    vec3 to_eye;
    float pixel;    // size of a pixel there [m]
    float sand;     // depth [m]
    float pores;    // saturation, 0.5 = full
    float sun, sky; // light that arrives, 0 ... 1
    float drowned;  // 1 under water
};

vec3 shade_ground(Ground g) {
    float cover = smoothstep(0.3 * F.rock.w, F.rock.w, g.sand);
    float damp = mix(smoothstep(0.0, 0.22, g.pores), 1.0, g.drowned);
    float soaked = mix(smoothstep(0.25, 0.48, g.pores), 1.0, g.drowned);
    float dry = (1.0 - damp) * cover;

    vec2 slope = -g.normal.xy / max(g.normal.z, 0.05);
    vec2 detail = vec2(0.0);
    WHERE (cover > 0.0) detail = sand_ripples(g.place.xy, slope, g.pixel, dry) * cover * (1.0 - 0.5 * soaked);
    WHERE (cover < 1.0) {
        // Two turned octaves: value noise alone would show its grid.
        float bump = 1.9 * F.domain.x, fine = 0.43 * F.domain.x;
        vec2 p = mat2(0.80, 0.60, -0.60, 0.80) * g.place.xy, q = mat2(0.34, -0.94, 0.94, 0.34) * g.place.xy;
        vec2 rough = noise_slopes(p / bump + g.place.z / bump * 0.4).yz * (0.07 * resolved(bump, g.pixel));
        WHERE (resolved(fine, g.pixel) > 0.0) rough += noise_slopes(q / fine + g.place.z / fine * 0.4).yz * (0.05 * resolved(fine, g.pixel));
        detail += rough * (1.0 - cover);
    }
    vec3 n = normalize(g.normal - vec3(detail * g.normal.z, 0.0));

    vec3 damp_sand = mix(F.sand_dry.rgb, F.sand_wet.rgb, 0.62);
    vec3 sand = mix(mix(F.sand_dry.rgb, damp_sand, damp), F.sand_wet.rgb, soaked);
    WHERE (cover > 0.0) sand *= 1.0 + 0.06 * noise_slopes(g.place.xy / (2.3 * F.domain.x)).x;
    vec3 rock = vec3(0.0);
    WHERE (cover < 1.0) rock = rock_colour(g.place, g.normal, g.pixel) * mix(1.0, 0.62, g.drowned);
    vec3 albedo = mix(rock, sand, cover);

    float lambert = max(dot(n, F.sun.xyz), 0.0);
    // Dry sand scatters between its grains: the terminator is sharper and the lit side flatter than Lambert's.
    float grainy = clamp(1.9 * dot(normalize(n * vec3(1.0, 1.0, 0.45)), F.sun.xyz), 0.0, 1.0);
    float diffuse = mix(lambert, grainy, 0.4 * dry);
    vec3 sun = F.sunlight.rgb * g.sun;
    vec3 seen = albedo * (sun * diffuse + ambient_on(n, g.sky));
    seen += albedo * albedo * sun * (0.25 * (1.0 - g.sky)); // light from lit neighbours warms hollows

    float grazing = pow(1.0 - clamp(dot(g.normal, g.to_eye), 0.0, 1.0), 4.0);
    seen += F.horizon.rgb * albedo * (grazing * F.sand_wet.w * dry * g.sky);
    vec3 halfway = normalize(F.sun.xyz + g.to_eye);
    float along = max(dot(n, halfway), 0.0);
    seen += sun * (0.10 * dry * pow(along, 24.0));
    // A film of water on soaked sand reflects like water.
    float sheen = soaked * cover * (1.0 - g.drowned);
    WHERE (sheen > 0.0) {
        float fresnel = 0.02 + 0.98 * pow(1.0 - clamp(dot(n, g.to_eye), 0.0, 1.0), 5.0);
        seen = mix(seen, sky_in(reflect(-g.to_eye, n)), sheen * 0.6 * fresnel * g.sky);
        seen += sun * (sheen * 0.35 * pow(along, 90.0));
    }
    WHERE (F.sand_dry.w > 0.0 && dry > 0.0)
        seen += sun * (F.sand_dry.w * dry * lambert * glitter_on(g.place, g.normal, halfway, g.pixel));
    return seen;
}

Ground ground_at(vec3 place, vec3 to_eye, float pixel) {
    vec2 uv = texture_of(place.xy);
    vec2 slope = textureLod(slopes, uv, 0.0).xy;
    vec4 lit = textureLod(light, uv, 0.0);
    Ground g;
    g.place = place;
    g.normal = normalize(vec3(-slope, 1.0));
    g.to_eye = to_eye;
    g.pixel = pixel;
    g.sand = heights_at(place.xy).w;
    g.pores = textureLod(matter, uv, 0.0).x;
    g.sun = lit.x;
    g.sky = lit.y;
    g.drowned = 0.0;
    return g;
}
