// What water leaves on the surface to be seen (2.25, 2.26).
#pragma once
#include "tests/reference/rules.hpp"
#include "tests/reference/solver.hpp"

namespace wadi::reference {

/// Water above the sand, as it is seen.
template <class Real> Real Solver<Real>::open_water(std::size_t c) const {
    return has(EFFECT_SAND) ? std::max(seen_depth(c) - sand[c], Real(0)) : water[c];
}

/// 2.25: what a step leaves of something that halves in a time, 0 = never.
template <class Real> Real Solver<Real>::after_fading(Real amount, double half_life, Real least) const {
    if (half_life <= 0) return amount;
    if (amount < least) return Real(0);
    const Real share = static_cast<Real>(1 - std::exp2(-settings.dt / half_life));
    return std::max(amount - (std::floor(amount * share / surface_quantum) + 1) * surface_quantum, Real(0));
}

/// 2.25.
template <class Real> void Solver<Real>::carry_foam() {
    if (!has(EFFECT_FOAM)) return;
    Field<Real> left(cells()), afloat(cells()), scale(cells(), Real(1)), gained(cells(), Real(0));
    for (std::size_t c = 0; c < cells(); ++c) {
        left[c] = after_fading(foam[c], settings.surface.foam_half_life, std::exp2(Real(-16)));
        afloat[c] = left[c] * std::min(open_water(c) / Real(0.02), Real(1));
    }
    const auto raw = [&](const Axis& ax, int a, int b) {
        const Real u = pure_velocity.along(ax)[ax.face(a, b)];
        const bool up = u > Real(0), outside = up ? a == 0 : a == ax.along();
        return outside ? Real(0) : P.k / Real(0.85) * u * afloat[up ? ax.cell(a - 1, b) : ax.cell(a, b)];
    };
    const Axis along_x = axis(false), along_y = axis(true);
    for (int j = 0; j < along_x.ny; ++j) {
        for (int i = 0; i < along_x.nx; ++i) {
            const Real leaves = (std::max(raw(along_x, i + 1, j), Real(0)) + std::max(-raw(along_x, i, j), Real(0))) +
                                (std::max(raw(along_y, j + 1, i), Real(0)) + std::max(-raw(along_y, j, i), Real(0)));
            const std::size_t c = along_x.cell(i, j);
            const Real safe = left[c] * (Real(1) - Real(4) * std::numeric_limits<Real>::epsilon());
            if (leaves > safe) scale[c] = safe / leaves;
        }
    }
    for (const bool is_y : {false, true}) {
        const Axis ax = axis(is_y);
        for (int b = 0; b < ax.across(); ++b) {
            for (int a = 0; a <= ax.along(); ++a) {
                const Real meant = raw(ax, a, b);
                if (meant == Real(0)) continue;
                const std::size_t donor = ax.cell(meant > Real(0) ? a - 1 : a, b);
                const Real moved = std::trunc(meant * scale[donor] / surface_quantum) * surface_quantum;
                if (a > 0) gained[ax.cell(a - 1, b)] -= moved;
                if (a < ax.along()) gained[ax.cell(a, b)] += moved;
            }
        }
    }
    for (int j = 0; j < along_x.ny; ++j) {
        for (int i = 0; i < along_x.nx; ++i) {
            const std::size_t c = along_x.cell(i, j);
            const Real h = open_water(c);
            foam[c] = left[c] + gained[c];
            const Real fall = std::clamp((pure_velocity.x[along_x.face(i, j)] - pure_velocity.x[along_x.face(i + 1, j)]) +
                                             (pure_velocity.y[along_y.face(j, i)] - pure_velocity.y[along_y.face(j + 1, i)]),
                                         Real(0), Real(1e4));
            if (h > P.eps && fall > Real(0)) {
                const Real rise = h * fall / P.dx, wave = std::sqrt(P.gravity * h);
                const Real breaks =
                    wave > Real(0) ? std::clamp((rise / wave - Real(0.15)) / Real(0.5), Real(0), Real(1)) : Real(0);
                const Real energy = P.rho_w * h * (wave * P.dx / 2) * (fall / P.dx) * (fall / P.dx) * P.dt;
                const Real born = breaks * std::min(energy / static_cast<Real>(settings.surface.foam_energy), Real(1));
                foam[c] += std::min(std::floor(born / surface_quantum) * surface_quantum, std::max(Real(1) - foam[c], Real(0)));
            }
            foam[c] = std::min(foam[c], Real(4));
        }
    }
}

/// 2.26.
template <class Real> void Solver<Real>::wet_ground() {
    if (!has(EFFECT_WETNESS)) return;
    for (std::size_t c = 0; c < cells(); ++c)
        wetness[c] =
            open_water(c) > P.eps ? Real(1) : after_fading(wetness[c], settings.surface.wetness_half_life, Real(1) / Real(256));
}

} // namespace wadi::reference
