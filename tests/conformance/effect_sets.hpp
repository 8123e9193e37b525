// Effects and sets of them that the suites' tables name.
#pragma once
#include "shaders/effect_rows.hpp"
#include <cstdint>

namespace wadi::conformance {

inline constexpr std::uint32_t WATER_IN_SAND = EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE | EFFECT_DIFFUSION | EFFECT_DRAG;
inline constexpr std::uint32_t WET = WATER_IN_SAND | EFFECT_SHOCK_VISCOSITY;
inline constexpr std::uint32_t ELASTIC = EFFECT_ELASTOPLASTIC;
inline constexpr std::uint32_t PUBLISHED = EFFECT_PUBLISHED, DIRECT = EFFECT_PUBLISHED | EFFECT_DIRECT_STRAIN;
inline constexpr std::uint32_t SECOND = EFFECT_SECOND_ORDER_WATER, SAND_SECOND = EFFECT_SECOND_ORDER_SAND;
inline constexpr std::uint32_t SLOPES = EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION;
inline constexpr std::uint32_t FLOWING = EFFECT_FLOW_FRICTION;
inline constexpr std::uint32_t SOAKING = EFFECT_INFILTRATION;
inline constexpr std::uint32_t SEEN = EFFECT_FOAM | EFFECT_WETNESS;
inline constexpr std::uint32_t ALL_PUBLISHED = PUBLISHED | (all_effects & ~never_published);
inline constexpr std::uint32_t ALL = all_effects | EFFECT_SHOCK_VISCOSITY; // the default method

} // namespace wadi::conformance
