// Sand whose pores are a share of it (2.23).
#pragma once
#include "tests/reference/rules.hpp"
#include "tests/reference/solver.hpp"

namespace wadi::reference {

/// Water that the pores of so much sand hold.
template <class Real> Real Solver<Real>::pore_room(Real depth) const {
    const Real room = P.porosity * depth;
    return P.quantum > Real(0) ? std::floor(room / P.quantum) * P.quantum : room;
}

/// How deep such water stands, from the ground to its surface: in n of the sand up to its top, then above it.
template <class Real> Real Solver<Real>::standing(Real held, Real depth) const {
    const Real room = pore_room(depth);
    if (held == Real(0)) return Real(0); // below 0 where diffusion of 2.21 took more than there was: so does the surface stand
    return held < room ? std::min(held / P.porosity, depth) : held + (depth - room);
}

/// M, water in the pores: 2.24 has it as state.
template <class Real> Real Solver<Real>::in_pores(std::size_t c) const {
    const Real most = std::min(water[c], pore_room(sand[c]));
    return has(EFFECT_INFILTRATION) && pore_water[c] >= Real(0) ? std::min(most, pore_water[c]) : most;
}

/// 2.24: whether water stands on sand whose pores have room.
template <class Real> bool Solver<Real>::waits(std::size_t c) const {
    return water[c] > in_pores(c) && in_pores(c) < pore_room(sand[c]);
}

/// Of the water inside the sand; what waits above is none of it.
template <class Real> Real Solver<Real>::standing(std::size_t c) const {
    if (!has(EFFECT_INFILTRATION) || in_pores(c) >= pore_room(sand[c])) return standing(water[c], sand[c]);
    return std::min(in_pores(c) / P.porosity, sand[c]);
}

/// 2.24: of all water of a cell, as it is seen.
template <class Real> Real Solver<Real>::seen_depth(std::size_t c) const {
    return has(EFFECT_INFILTRATION) && waits(c) ? sand[c] + (water[c] - in_pores(c)) : standing(c);
}

/// 2.24: sand whose pores hold what is in them, where more waits above.
template <class Real> Real Solver<Real>::open_depth(std::size_t c) const {
    return has(EFFECT_INFILTRATION) && waits(c) ? std::min(in_pores(c) / P.porosity, sand[c]) : sand[c];
}

/// 2.24: how deep water stands for 2.1 and 2.16: on that sand.
template <class Real> Real Solver<Real>::transport_depth(std::size_t c) const {
    return has(EFFECT_INFILTRATION) && waits(c) ? open_depth(c) + (water[c] - in_pores(c)) : standing(c);
}

/// 2.24: of pure water, which then stands on the sand or would.
template <class Real> Real Solver<Real>::pure_surface(std::size_t c) const {
    return has(EFFECT_INFILTRATION) ? terrain[c] + (sand[c] + (water[c] - in_pores(c))) : water_surface(c);
}

template <class Real> Real Solver<Real>::coupled_depth(std::size_t c) const {
    return has(EFFECT_INFILTRATION) ? in_pores(c) / P.porosity + (water[c] - in_pores(c)) : standing(c);
}

template <class Real> Real Solver<Real>::water_surface(std::size_t c) const { return terrain[c] + standing(c); }

/// 2.24: of the water inside the sand, for the sand's substeps: what waited behind the water's step is left out in all of them.
template <class Real> Real Solver<Real>::felt_surface(std::size_t c) const {
    return has(EFFECT_INFILTRATION) ? terrain[c] + standing(felt_water[c], sand[c]) : water_surface(c);
}

/// The water of a cell whose surface stands at `level`.
template <class Real> Real Solver<Real>::water_at_level(std::size_t c, Real level) const {
    const Real depth = std::max(level - terrain[c], Real(0));
    Real room = pore_room(sand[c]);
    if (has(EFFECT_INFILTRATION) && pore_water[c] >= Real(0)) room = std::min(room, pore_water[c]);
    return depth < sand[c] ? P.porosity * depth : depth - (sand[c] - room);
}

/// 2.4e: by how many quanta one more of water lifts the surface of two cells at most.
template <class Real> Real Solver<Real>::lifts(std::size_t one, std::size_t other) const {
    const auto is_full = [&](std::size_t c) { return in_pores(c) >= pore_room(sand[c]); };
    const bool full = is_full(one) && is_full(other);
    return full ? Real(1) : Real(1) / P.porosity;
}

} // namespace wadi::reference
