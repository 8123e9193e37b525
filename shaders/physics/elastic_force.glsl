// Force of the stress in sand (paper 3.3.2, 4.2.3; NUMERICS 2.7).
#ifndef PHYSICS_ELASTIC_FORCE
#define PHYSICS_ELASTIC_FORCE
#include "../physics/scalar.glsl"

// Compression that the stress of a cell bears beyond what its cohesion alone gives, c/c_f: passive pressure and all where its cohesion holds
// it upright, nothing where it holds no half of that. Such sand pushes and is rubbed by its slope alone. stressed: stress_share;
// yield_pressure: c/c_f.
FN float own_pressure(float passive, float stressed, float yield_pressure) { return passive * stressed - (1.0f - stressed) * yield_pressure; }

// Four times the shear at a corner of four cells: their least height times the sum of their stresses, so that a thick cell's shear does
// not act on a film beside it (NUMERICS section 0, row 12). Cells outside the grid have no stress, not even 0.
FN float corner_shear(float least, float s_sw, float s_se, float s_nw, float s_ne) {
    float force = least * ((s_sw + s_ne) + (s_se + s_nw));
    return least > 0.0f ? force : 0.0f;
}

// Divergence of depth times stress at a face, times dx: normal stress of its two cells, shear at its two corners.
FN float elastic_force(float height_low, float height_high, float stress_low, float stress_high, float shear_left, float shear_right) {
    return (height_high * stress_high - height_low * stress_low) + 0.25f * (shear_right - shear_left);
}

#endif
