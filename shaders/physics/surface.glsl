// What a viewer sees of a column of ground and sand; water: the depth at which its surface stands (pores.glsl).
#ifndef PHYSICS_SURFACE
#define PHYSICS_SURFACE
#include "../physics/pores.glsl"

// Water above the sand; the rest is inside it.
FN float pure_depth(float water, float sand) { return water - wmin(water, sand); }

// d/(d + hs) (NUMERICS 2.7), 0 where there is no sand.
FN float saturation_of(float water, float sand, float dry) {
    float phi = divide_or_zero(water, water + sand);
    return sand > dry ? flush(phi) : 0.0f;
}

FN float visible_surface(float terrain, float sand, float water) { return terrain + wmax(water, sand); }

#endif
