// Diffusion of mixed water as a flux through a face [m per step], positive east and north (paper 4.1.1; NUMERICS 2.1, 2.15, 2.19).
#ifndef PHYSICS_DIFFUSION
#define PHYSICS_DIFFUSION
#include "../physics/drag.glsl"
#include "../physics/pores.glsl"
#include "../physics/scalar.glsl"

// What of a cell moves mixed water: the depth at which that stands, the sand's, the free surface [m], and by how much a depth of water lifts it.
struct WetSand {
    float water, sand, surface, lifts;
};

FN WetSand wet_sand_of(float ground, float sand, PoreWater within) {
    WetSand w;
    w.water = within.depth;
    w.sand = sand;
    w.surface = ground + within.depth;
    w.lifts = within.lifts;
    return w;
}

FN float mixed_of(WetSand cell) { return wmin(cell.water, cell.sand); }

// The smaller of the gradients of the mixed height and of the free surface, none where they disagree in sign or the surface is as level as
// rounding leaves it, so that a lake at rest stays at rest. number = n c dt/dx^2.
FN float limited_diffusion(WetSand low, WetSand high, float number, float dry, float rest_surface) {
    float fall = high.surface - low.surface;
    float s = minmod(mixed_of(high) - mixed_of(low), fall);
    bool sand = both(low.sand > dry, high.sand > dry);
    return both(wabs(fall) > rest_surface * wmax(low.lifts, high.lifts), both(s != 0.0f, sand)) ? -number * s : 0.0f;
}

// By the height alone, sand or not (method published).
FN float laplace_diffusion(WetSand low, WetSand high, float number) { return number * (mixed_of(low) - mixed_of(high)); }

// Share of a flux that the cell which it would leave lets go.
FN float let_go(float flux, WetSand low, WetSand high, float retained, float inv_drainable) {
    float free_low = relative_permeability(low.water, low.sand, retained, inv_drainable);
    return upstream_permeability(flux, free_low, relative_permeability(high.water, high.sand, retained, inv_drainable));
}

#endif
