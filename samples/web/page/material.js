// Numbers of the material: effects that are on while one of theirs is above 0, with a value for levels that have none, and kinds of sand
// (samples/viewer/material_presets.cpp).
export const EFFECTS = [
  { name: "elastoplastic", title: "damp sand holds its shape", numbers: { young_modulus: 3e5 } },
  { name: "drag", title: "water and sand drag each other", numbers: { exchange_rate: 1e5 } },
  { name: "diffusion", title: "water spreads inside sand", numbers: { diffusion_rate: 0.01 } },
  { name: "internal_friction", title: "sand rubs within", numbers: { internal_friction: 0.4, sand_viscosity: 0.05 } },
  { name: "bed_friction", title: "the bed slows water", numbers: { bed_friction: 0.01 } },
  { name: "bed_shear", title: "fast water carries its bed along", numbers: { bed_shear: 0.02 } },
];

const NUMBERS = ["friction", "cohesion_dry", "cohesion_wet", "cohesion_capillary", "retention", "exchange_rate", "diffusion_rate",
  "internal_friction", "sand_viscosity", "grain_size"];
const sand = (name, about, ...values) => ({ name, about, numbers: Object.fromEntries(NUMBERS.map((key, n) => [key, values[n]])) });
export const SANDS = [
  sand("dry", "runs and heaps", 0.6, 0, 0, 0, 0.4925, 1e5, 0.01, 0.4, 0.05, 0.001),
  sand("damp", "holds a wall", 0.6, 210, 8500, 8500, 0.4925, 1e5, 0.01, 0.4, 0.05, 0.001),
  sand("mud", "slides slowly", 0.15, 100, 300, 300, 0.4925, 1e6, 0.001, 0.4, 0.5, 0.0001),
  sand("gravel", "steep, drains at once", 0.8, 0, 0, 0, 0, 1e4, 0.05, 0.4, 0.05, 0.02),
];
