// The land beyond the block: its rim goes on, straight out from each side and level at the corners.
vec2 on_block(vec2 xy) { return clamp(xy, vec2(0.0), F.domain.yz); }
float top_beyond(vec2 xy) {
    vec4 h = heights_at(on_block(xy));
    return max(h.x, h.y);
}

// Where the ray meets it for t in [t0, t_end] [m]; -1 = nowhere. Steps follow the height above it, then the meeting is halved in.
float meet_beyond(vec3 from, vec3 along, float t0, float t_end) {
    float last = t0, t = t0;
    for (int n = 0; n < 128 && t < t_end; ++n) {
        vec3 place = from + along * t;
        float above = place.z - top_beyond(place.xy);
        if (above <= 0.0) {
            for (int turn = 0; turn < 12; ++turn) {
                float middle = 0.5 * (last + t);
                vec3 p = from + along * middle;
                if (p.z > top_beyond(p.xy)) last = middle;
                else t = middle;
            }
            return t;
        }
        last = t;
        t = min(t + max(0.4 * above, 0.008 * t + 0.3 * F.domain.x), t_end);
    }
    return -1.0;
}

bool goes_on() { return F.eye.w != 0.0; }

// The eye, pushed up out of ground and water.
vec3 eye_place() {
    bool over_land = goes_on() || on_block(F.eye.xy) == F.eye.xy;
    float lowest = top_beyond(F.eye.xy) + 0.002 * max(F.domain.y, F.domain.z);
    return vec3(F.eye.xy, over_land ? max(F.eye.z, lowest) : F.eye.z);
}
