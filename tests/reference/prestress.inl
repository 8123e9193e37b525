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

/// The tension at which sand `depth` deep with `held` of water is in balance [Pa].
template <class Real> Real Solver<Real>::balancing_tension(Real depth, Real held) const {
    if (!settings.method.prestress || !(depth > Real(0)) || !has(EFFECT_ELASTOPLASTIC)) return Real(0);
    const auto real = [](double x) { return static_cast<Real>(x); };
    const Material& m = settings.material;
    const Real c = cohesion(has(EFFECT_COHESION) ? held / (held + depth) : Real(0), depth);
    const Real wet = std::min(held, depth) / depth;
    const Real full = full_depth(depth, held) / depth;
    Real pushes = (wet - full) - full; // of the water's weight
    if (!has(EFFECT_SLOPE_NORMAL)) {
        const Real kr = has(EFFECT_RETENTION) ? full * full * full : Real(1);
        pushes = wet * wet * ((P.exchange > Real(0) ? Real(1) - kr : Real(0)) - kr);
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
    return std::min(T * w * (least + w * (Real(1) - least)), c / (Real(2) * P.yield_friction));
}

/// The strain V* - 1 at which it is, where neighbours leave it a share of that tension.
template <class Real> Real Solver<Real>::balance(Real depth, Real held, Real share) const {
    const Real tension = share * balancing_tension(depth, held);
    if (!(tension > Real(0))) return Real(0);
    const Real c = cohesion(has(EFFECT_COHESION) ? held / (held + depth) : Real(0), depth);
    // The root of tr = strain exp(tr) below 1, by halves.
    const Real strain = std::min(tension / (P.lambda + P.shear), static_cast<Real>(0.36));
    Real low(0), high(1);
    for (int n = 0; n < 60; ++n) {
        const Real half = (low + high) / Real(2);
        (half < strain * std::exp(half) ? low : high) = half;
    }
    const Real tip = c / (P.yield_friction * Real(2) * (P.lambda + P.shear));
    return std::expm1(std::min(low, tip) / Real(2));
}

/// Depth times tension N falls no faster than push and friction bear: along each direction of the grid what a cell further on has
/// and what may rise on the way back from it, nowhere below 0, is the most that N may be.
template <class Real> void Solver<Real>::bound_balance() {
    const Axis x = axis(false);
    const auto real = [](double value) { return static_cast<Real>(value); };
    Field<Real> weight(cells()), clings(cells()), pull(cells());
    for (std::size_t c = 0; c < cells(); ++c) {
        if (!(sand[c] > Real(0))) continue;
        const Real full = full_depth(sand[c], water[c]);
        weight[c] = std::max(Real(1) + P.rho_w / P.rho_s * (std::min(water[c], sand[c]) - Real(2) * full) / sand[c], Real(0));
        const Real whole = cohesion(water[c] / (water[c] + sand[c]), std::numeric_limits<Real>::infinity());
        clings[c] = P.adhesion * whole / P.yield_cohesion;
        pull[c] = sand[c] * balancing_tension(sand[c], water[c]);
    }
    const auto rise = [&](std::size_t c, std::size_t n) { // of N from n to c beside it
        const Real unit = P.rho_s * P.gravity;
        const Real fall = (terrain[c] + sand[c]) - (terrain[n] + sand[n]);
        const Real borne = unit * mean(weight[c], weight[n]) * mean(sand[c], sand[n]) * (fall + real(0.8) * P.friction * P.dx) +
                           real(0.8) * P.dx * mean(clings[c], clings[n]);
        return std::max(borne, unit / Real(2) * (weight[c] * sand[c] * sand[c] - weight[n] * sand[n] * sand[n]));
    };
    for (int j = 0; j < x.ny; ++j) {
        for (int i = 0; i < x.nx; ++i) {
            const std::size_t c = x.cell(i, j);
            Real most = pull[c];
            for (const auto& [di, dj] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                for (int n = 1; n <= 64; ++n) {
                    const int a = i + n * di, b = j + n * dj;
                    if (a < 0 || b < 0 || a >= x.nx || b >= x.ny || sand[x.cell(a, b)] <= P.eps) break;
                    Real back = pull[x.cell(a, b)];
                    for (int k = n; k > 0; --k)
                        back = std::max(back + rise(x.cell(i + (k - 1) * di, j + (k - 1) * dj), x.cell(i + k * di, j + k * dj)),
                                        Real(0));
                    most = std::min(most, back);
                }
            }
            if (most < pull[c]) Vxx[c] = Vyy[c] = Real(1) + balance(sand[c], water[c], most / pull[c]);
        }
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
