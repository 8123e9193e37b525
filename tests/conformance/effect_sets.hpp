// Effects and sets of them that the suites' tables name.
#pragma once
#include "shaders/effect_rows.hpp"
#include <cstdint>

namespace wadi::conformance {

inline constexpr std::uint32_t WET =
    EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE | EFFECT_DIFFUSION | EFFECT_DRAG | EFFECT_SHOCK_VISCOSITY;
inline constexpr std::uint32_t ELASTIC = EFFECT_ELASTOPLASTIC;
inline constexpr std::uint32_t TRACED = EFFECT_SEMI_LAGRANGIAN;
inline constexpr std::uint32_t POLAR = EFFECT_WHOLE_STRAIN, DIRECT = EFFECT_WHOLE_STRAIN | EFFECT_DIRECT_STRAIN;
inline constexpr std::uint32_t PAPER_LIKE = TRACED | POLAR | EFFECT_EXPLICIT_DRAG | EFFECT_LAPLACE_DIFFUSION;
inline constexpr std::uint32_t PRINTED_WATER = EFFECT_WHOLE_PRESSURE | EFFECT_EXPLICIT_EXCHANGE | EFFECT_DIFFUSION_AHEAD;
inline constexpr std::uint32_t PRINTED_SAND = EFFECT_ALGORITHM_1 | EFFECT_CENTRAL_SHEAR | EFFECT_STRAIN_BEYOND;
inline constexpr std::uint32_t PUBLISHED = PAPER_LIKE | PRINTED_WATER | PRINTED_SAND;
inline constexpr std::uint32_t SECOND = EFFECT_SECOND_ORDER_WATER, SAND_SECOND = EFFECT_SECOND_ORDER_SAND;
inline constexpr std::uint32_t SLOPES = EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION;
inline constexpr std::uint32_t ALL_PUBLISHED = PUBLISHED | (all_effects & ~never_algorithm_1);
inline constexpr std::uint32_t ALL = all_effects | EFFECT_SHOCK_VISCOSITY; // the default method

} // namespace wadi::conformance
