// Numerical viscosity of water where it is compressed, so that bores do not ring (NUMERICS 2.3).
#ifndef PHYSICS_SHOCK_VISCOSITY
#define PHYSICS_SHOCK_VISCOSITY
#include "../physics/scalar.glsl"

// How fast a cell and the two beside it are compressed along one axis [m/s]: velocity at the low face less that at the high one.
struct Compression {
    float low, own, high;
};

// The flux of the faster of a cell's two faces, without its sign; where the other is nearly as fast that one's comes in, so that no
// rounding says which of two equally fast ones (both at the velocity clamp, say) counts: of their fluxes the larger one does then.
FN float faster_flux(float u_low, float u_high, float flux_low, float flux_high) {
    float speed_low = wabs(u_low);
    float speed_high = wabs(u_high);
    float fast = wmax(speed_low, speed_high);
    float low = speed_low >= speed_high ? wabs(flux_low) : 0.0f;
    float high = speed_high >= speed_low ? wabs(flux_high) : 0.0f;
    float faster = wmax(low, high); // of both for equal speeds: the same for a scene and for its image
    float larger = wmax(wabs(flux_low), wabs(flux_high));
    float nearly = lean_divide_or_zero(wmax(4.0f * wmin(speed_low, speed_high) - 3.0f * fast, 0.0f), fast);
    return faster + nearly * (larger - faster);
}

// Viscous flux of a cell (NUMERICS 2.3, after von Neumann and Richtmyer 1950, limited after Christensen 1990): of what the neighbours'
// compression does not explain. Three times it does, so that no smooth wave is damped but at its crest, where 12 k times the rest is
// next to nothing. 0.12 keeps the explicit step stable at a step of the depth. The faster of its two faces bounds it by what it carries;
// a film that runs into a lake at speed brings it next to nothing.
FN float shock_flux(Compression at, float height, float u_low, float u_high, float flux_low, float flux_high, float viscosity, float k) {
    float rest = wmax(at.own - wmax(3.0f * wmin(at.low, at.high), 0.0f), 0.0f);
    float flux = 0.0f;
    if (UNIFORM(rest > 0.0f)) {
        float carried = faster_flux(u_low, u_high, flux_low, flux_high);
        float depth = wmax(height, 0.0f);
        float number = wmin(wmin(viscosity * lean_root(wmax(depth, 1.0e-28f)), 12.0f * k * rest), 0.12f);
        flux = -wmin(number * depth, 4.0f * carried) * rest;
    }
    return flux;
}

#endif
