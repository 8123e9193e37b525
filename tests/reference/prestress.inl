// Sand in balance (2.20).
#pragma once
#include "tests/reference/transport.inl"

namespace wadi::reference {

/// Cohesion c_c(phi) of sand `depth` deep [Pa]: the paper's piecewise linear law, capped for thin layers (2.7).
template <class Real> Real Solver<Real>::cohesion(Real phi, Real depth) const {
    Real c(0);
    if (phi < P.phi1)
        c = P.c0 + phi * (P.c1 - P.c0) / P.phi1;
    else if (phi < P.phi2)
        c = P.c1 + (phi - P.phi1) * (P.c2 - P.c1) / (P.phi2 - P.phi1);
    else if (phi <= P.phi3)
        c = P.c2 * (P.phi3 - phi) / (P.phi3 - P.phi2);
    if (P.cohesion_cap > Real(0)) c = std::min(c, Real(2) * P.yield_friction * P.cohesion_cap * P.rho_s * P.gravity * depth);
    return c;
}

/// The strain V* - 1 at which sand `depth` deep with `held` of water is in balance.
template <class Real> Real Solver<Real>::balance(Real depth, Real held) const {
    if (!settings.method.prestress || !(depth > Real(0)) || !has(EFFECT_ELASTOPLASTIC)) return Real(0);
    const auto real = [](double x) { return static_cast<Real>(x); };
    const Material& m = settings.material;
    const Real c = cohesion(has(EFFECT_COHESION) ? held / (held + depth) : Real(0), depth);
    const Real wet = std::min(held, depth) / depth;
    Real kr(1);
    if (has(EFFECT_RETENTION)) {
        const Real retained = real(m.retention);
        const Real drained = std::clamp((held / depth - retained) / (Real(1) - retained), Real(0), Real(1));
        kr = drained * drained * drained;
    }
    const Real leans = P.exchange > Real(0) ? Real(1) - kr : Real(0);
    const Real carried = std::max(Real(1) + P.rho_w / P.rho_s * wet * wet * (leans - kr), Real(0));
    const Real T = P.rho_s * sand_gravity(depth) * depth / Real(2) * carried;
    const Real chi = real(m.slope_normal);
    Real least(1); // C*
    if (chi > Real(0)) {
        const Real steepest = P.friction + std::sqrt(P.friction * P.friction + Real(1) / chi);
        least = Real(1) / (Real(1) + chi * steepest * steepest);
    }
    const Real whole = P.yield_friction * P.rho_s * P.gravity * depth;
    const Real w = whole > Real(0) ? std::min(Real(1), Real(4) * c / whole) : Real(0);
    const Real tension = std::min(T * w * (least + w * (Real(1) - least)), c / (Real(2) * P.yield_friction));
    // The root of tr = strain exp(tr) below 1, by halves.
    const Real strain = std::min(tension / (P.lambda + P.shear), real(0.36));
    Real low(0), high(1);
    for (int n = 0; n < 60; ++n) {
        const Real half = (low + high) / Real(2);
        (half < strain * std::exp(half) ? low : high) = half;
    }
    const Real tip = c / (P.yield_friction * Real(2) * (P.lambda + P.shear));
    return std::expm1(std::min(low, tip) / Real(2));
}

/// Sand of a cell is about to become `added` deeper, or shallower.
template <class Real> void Solver<Real>::change_strain(std::size_t cell, Real added) {
    const Real before = Real(1) + balance(sand[cell], water[cell]);
    const Real after = Real(1) + balance(sand[cell] + added, water[cell]);
    const Real keep = added > Real(0) ? sand[cell] / (sand[cell] + added) : Real(1);
    Vxx[cell] = after + keep * (Vxx[cell] - before);
    Vxy[cell] = keep * Vxy[cell];
    Vyy[cell] = after + keep * (Vyy[cell] - before);
    rotation[cell] = keep * rotation[cell];
}

} // namespace wadi::reference
