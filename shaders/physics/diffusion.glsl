// Diffusion of mixed water as a flux through a face [m per step], positive east and north (paper 4.1.1; NUMERICS 2.1, 2.15, 2.19).
#ifndef PHYSICS_DIFFUSION
#define PHYSICS_DIFFUSION
#include "../physics/drag.glsl"
#include "../physics/scalar.glsl"

// What of a cell moves mixed water: its heights and its free surface [m].
struct WetSand {
    float water, sand, surface;
};

FN float mixed_of(WetSand cell) { return wmin(cell.water, cell.sand); }

// The smaller of the gradients of the mixed height and of the free surface, none where they disagree in sign or the surface is as level as
// rounding leaves it, so that a lake at rest stays at rest. number = c dt/dx^2.
FN float limited_diffusion(WetSand low, WetSand high, float number, float dry, float rest_surface) {
    float fall = high.surface - low.surface;
    float s = minmod(mixed_of(high) - mixed_of(low), fall);
    bool sand = both(low.sand > dry, high.sand > dry);
    return both(wabs(fall) > rest_surface, both(s != 0.0f, sand)) ? -number * s : 0.0f;
}

// By the height alone, sand or not (method published).
FN float laplace_diffusion(WetSand low, WetSand high, float number) { return number * (mixed_of(low) - mixed_of(high)); }

// Share of a flux that the cell which it would leave lets go.
FN float let_go(float flux, WetSand low, WetSand high, float retained, float inv_drainable) {
    float free_low = relative_permeability(low.water, low.sand, retained, inv_drainable);
    return upstream_permeability(flux, free_low, relative_permeability(high.water, high.sand, retained, inv_drainable));
}

#endif
