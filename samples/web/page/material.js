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

const same = { retention: 0.4925, internal_friction: 0.4, sand_viscosity: 0.05, grain_size: 0.001 };
export const SANDS = [
  { name: "dry", about: "runs and heaps", numbers: { ...same, friction: 0.6, cohesion_dry: 0, cohesion_wet: 0, cohesion_capillary: 0, exchange_rate: 1e5, diffusion_rate: 0.01 } },
  { name: "damp", about: "holds a wall", numbers: { ...same, friction: 0.6, cohesion_dry: 210, cohesion_wet: 8500, cohesion_capillary: 8500, exchange_rate: 1e5, diffusion_rate: 0.01 } },
  { name: "mud", about: "slides slowly", numbers: { ...same, friction: 0.15, cohesion_dry: 100, cohesion_wet: 300, cohesion_capillary: 300, exchange_rate: 1e6, diffusion_rate: 0.001, sand_viscosity: 0.5, grain_size: 0.0001 } },
  { name: "gravel", about: "steep, drains at once", numbers: { ...same, friction: 0.8, cohesion_dry: 0, cohesion_wet: 0, cohesion_capillary: 0, retention: 0, exchange_rate: 1e4, diffusion_rate: 0.05, grain_size: 0.02 } },
];
