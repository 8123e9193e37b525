// Friction of sand by thickness and speed (NUMERICS 2.8; O. Pouliquen 1999, Y. Forterre and O. Pouliquen 2003, A. N. Edwards and others 2019).
#ifndef PHYSICS_FLOW_FRICTION
#define PHYSICS_FLOW_FRICTION
#include "../physics/scalar.glsl"

struct FlowFriction {
    float scale; // L: some grains [m]
    float beta, gamma;
};

// Of what friction may rise by, the share that it does: L (Fr + gamma)/(L (Fr + gamma) + beta h), h the thickness normal to a bed whose
// angle has that cosine, Fr = speed/sqrt(g depth cosine^2). depth: upright.
FN float flow_share(float depth, float cosine2, float speed, float gravity, FlowFriction law) {
    float thickness = depth * lean_root(cosine2);
    float wave = lean_root(wmax(gravity * depth * cosine2, 1.0e-28f));
    float runs = law.scale * (speed + law.gamma * wave);
    return lean_divide_or_zero(runs, runs + law.beta * (thickness * wave));
}

#endif
