// What a viewer sees of a column of ground H, sand hs and water W.
#ifndef PHYSICS_SURFACE
#define PHYSICS_SURFACE
#include "../physics/scalar.glsl"

// Water above the sand; the rest is inside it.
FN float pure_depth(float water, float sand) { return water - wmin(water, sand); }

FN float visible_surface(float terrain, float sand, float water) { return terrain + wmax(water, sand); }

#endif
