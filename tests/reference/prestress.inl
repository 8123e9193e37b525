// Sand in balance (2.20).
#pragma once
#include "tests/reference/transport.inl"
#include <limits>

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
    const Real stands = standing(held, depth);
    const Real c = cohesion(has(EFFECT_COHESION) ? stands / (stands + depth) : Real(0), depth);
    const Real wet = std::min(stands, depth) / depth;
    const Real full = full_depth(depth, stands) / depth;
    Real pushes = (std::min(held, pore_room(depth)) / depth - P.porosity * full) - P.displaces * full; // of the water's weight
    if (!has(EFFECT_SLOPE_NORMAL)) {
        const Real kr = has(EFFECT_RETENTION) ? full * full * full : Real(1);
        pushes = P.porosity * wet * wet * ((P.exchange > Real(0) ? Real(1) - kr : Real(0)) - kr);
    }
    const Real carried = std::max(Real(1) + P.rho_w / P.rho_s * pushes, Real(0));
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

/// Depth times tension falls no faster than push and friction bear: the least that all neighbours with sand allow.
template <class Real> void Solver<Real>::bound_balance() {
    const Axis x = axis(false);
    const auto real = [](double value) { return static_cast<Real>(value); };
    const auto weight = [&](std::size_t c) { // what pushes of it
        const Real full = full_depth(sand[c], standing(c));
        const Real held = std::min(water[c], pore_room(sand[c])) - P.porosity * full;
        return std::max(Real(1) + P.rho_w / P.rho_s * (held - P.displaces * full) / sand[c], Real(0));
    };
    const auto clings = [&](std::size_t c) {
        const Real whole = cohesion(standing(c) / (standing(c) + sand[c]), std::numeric_limits<Real>::infinity());
        return P.adhesion * whole / P.yield_cohesion;
    };
    Field<Real> pull(cells());
    for (std::size_t c = 0; c < cells(); ++c)
        pull[c] = sand[c] * (P.lambda + P.shear) * Real(2) * std::log(Vxx[c]) / (Vxx[c] * Vxx[c]);
    Field<Real> most = pull;
    for (bool changed = true; changed;) {
        changed = false;
        const auto bound = [&](std::size_t c, std::size_t n) {
            if (sand[n] <= P.eps || !(most[c] > Real(0))) return;
            const Real w = mean(weight(c), weight(n)), unit = P.rho_s * P.gravity;
            const Real rise = (terrain[c] + sand[c]) - (terrain[n] + sand[n]);
            const Real borne = unit * w * mean(sand[c], sand[n]) * (rise + real(0.8) * P.friction * P.dx) +
                               real(0.8) * P.dx * mean(clings(c), clings(n));
            const Real balanced = unit / Real(2) * (weight(c) * sand[c] * sand[c] - weight(n) * sand[n] * sand[n]);
            const Real allowed = std::max(most[n] + std::max(borne, balanced), Real(0));
            // What rounding makes of the balance once round some cells would lower them for ever.
            const Real sums = most[n] + unit / Real(2) * (weight(c) * sand[c] * sand[c] + weight(n) * sand[n] * sand[n]);
            if (allowed >= most[c] - Real(8) * std::numeric_limits<Real>::epsilon() * sums) return;
            changed = true;
            most[c] = allowed;
        };
        for (int j = 0; j < x.ny; ++j) {
            for (int i = 0; i < x.nx; ++i) {
                if (i > 0) bound(x.cell(i, j), x.cell(i - 1, j));
                if (i + 1 < x.nx) bound(x.cell(i, j), x.cell(i + 1, j));
                if (j > 0) bound(x.cell(i, j), x.cell(i, j - 1));
                if (j + 1 < x.ny) bound(x.cell(i, j), x.cell(i, j + 1));
            }
        }
    }
    for (std::size_t c = 0; c < cells(); ++c) {
        if (!(most[c] < pull[c])) continue;
        Vxx[c] = Real(1) + (Vxx[c] - Real(1)) * (most[c] / pull[c]);
        Vyy[c] = Vxx[c];
    }
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
