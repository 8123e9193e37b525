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
    if (held <= Real(0)) return Real(0);
    return held < room ? std::min(held / P.porosity, depth) : held + (depth - room);
}

template <class Real> Real Solver<Real>::standing(std::size_t c) const { return standing(water[c], sand[c]); }

template <class Real> Real Solver<Real>::water_surface(std::size_t c) const { return terrain[c] + standing(c); }

/// The water of a cell whose surface stands at `level`.
template <class Real> Real Solver<Real>::water_at_level(std::size_t c, Real level) const {
    const Real depth = std::max(level - terrain[c], Real(0));
    return depth < sand[c] ? P.porosity * depth : depth - (sand[c] - pore_room(sand[c]));
}

/// 2.4e: by how many quanta one more of water lifts the surface of two cells at most.
template <class Real> Real Solver<Real>::lifts(std::size_t one, std::size_t other) const {
    const bool full = water[one] >= pore_room(sand[one]) && water[other] >= pore_room(sand[other]);
    return full ? Real(1) : Real(1) / P.porosity;
}

} // namespace wadi::reference
