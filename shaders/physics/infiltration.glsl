// Water that enters sand from above (W. H. Green and G. A. Ampt 1911; NUMERICS 2.24).
#ifndef PHYSICS_INFILTRATION
#define PHYSICS_INFILTRATION
#include "../physics/scalar.glsl"

// What sinks into pores in a step, before it is cut to what there is and to what they have room for: a front goes down ahead of `inside`,
// driven by its own weight, the depth of water above and the sand's suction. The first centimetre counts as one.
FN float sinking(float above, float inside, float by_weight, float suction, float inv_porosity) {
    return by_weight * (1.0f + wdiv(above + suction, wmax(inside * inv_porosity, 0.01f)));
}

#endif
