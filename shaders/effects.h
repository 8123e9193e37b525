// Effects: the bits of the mask that decides which stages, buffers and branches exist.
// Shared by every stage (GLSL, C++, CUDA) and by the engine: plain #defines only.
// What each bit means to a user, and what it needs, are the tables in engine/settings/effect_table.cpp.
#ifndef WADI_EFFECTS_H
#define WADI_EFFECTS_H

#define EFFECT_WATER 1u         // water that flows: heights and velocities of W
#define EFFECT_SAND 2u          // sand that flows: heights, velocities, Coulomb friction
#define EFFECT_MIXTURE 4u       // the second water layer: water inside sand has its own velocity
#define EFFECT_DIFFUSION 8u     // diffusion of mixed water
#define EFFECT_DRAG 16u         // momentum exchange between mixed water and sand
#define EFFECT_ELASTOPLASTIC 32u // deformation gradient, stress and yield of the sand
#define EFFECT_COHESION 64u     // cohesion that depends on saturation
#define EFFECT_SOURCES 128u     // point, disc and box sources and sinks
#define EFFECT_RAIN 256u        // rain and evaporation
#define EFFECT_OPEN_SIDES 512u  // sides that are not walls
#define EFFECT_BED_FRICTION 1024u // Manning-like friction of pure water on its bed
#define EFFECT_BED_SHEAR 2048u // pure water drags the sand under it along


// Choices of method: bits of the same mask, from settings.method and never from content (choice_table in engine/settings/effect_table.cpp).
#define EFFECT_SEMI_LAGRANGIAN 4096u // velocities are traced back instead of moved by the mass fluxes
#define EFFECT_WHOLE_STRAIN 8192u // sand keeps F with its rotation, and F follows the velocity ahead of friction
#define EFFECT_DIRECT_STRAIN 16384u // F is moved as it is, not as angle and stretch
#define EFFECT_EXPLICIT_DRAG 32768u // drag is an explicit step of its own ahead of friction
#define EFFECT_LAPLACE_DIFFUSION 65536u // mixed water spreads by the Laplacian of its height
#define EFFECT_SECOND_ORDER_WATER 131072u // heights and flux-form velocities of water move by limited slopes
#define EFFECT_HALF_STORAGE 262144u // velocities and stretch lie in memory as 16-bit floats

#endif
