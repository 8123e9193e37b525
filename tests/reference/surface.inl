// What water leaves on the surface to be seen (2.25 to 2.27).
#pragma once
#include "tests/reference/rules.hpp"
#include "tests/reference/solver.hpp"

namespace wadi::reference {

/// Water above the sand, as it is seen.
template <class Real> Real Solver<Real>::open_water(std::size_t c) const {
    return has(EFFECT_SAND) ? std::max(seen_depth(c) - sand[c], Real(0)) : water[c];
}

/// 2.25: what is left of an amount that loses a share of itself.
template <class Real> Real Solver<Real>::less_share(Real amount, Real share, Real least) {
    if (amount < least) return Real(0);
    return std::max(amount - (std::floor(amount * share / surface_quantum) + 1) * surface_quantum, Real(0));
}

/// 2.25: what a step leaves of something that halves in a time, 0 = never.
template <class Real> Real Solver<Real>::after_fading(Real amount, double half_life, Real least) const {
    return half_life <= 0 ? amount : less_share(amount, static_cast<Real>(1 - std::exp2(-settings.dt / half_life)), least);
}

/// 2.25, 2.27: what pure water brings to each cell, less what it takes, of an amount of which `moves` drifts `pace` times as
/// fast.
template <class Real> Field<Real> Solver<Real>::drift(const Field<Real>& held, const Field<Real>& moves, Real pace) const {
    Field<Real> scale(cells(), Real(1)), gained(cells(), Real(0));
    const auto raw = [&](const Axis& ax, int a, int b) {
        const Real u = pure_velocity.along(ax)[ax.face(a, b)];
        const bool up = u > Real(0), outside = up ? a == 0 : a == ax.along();
        return outside ? Real(0) : P.k * pace * u * moves[up ? ax.cell(a - 1, b) : ax.cell(a, b)];
    };
    const Axis along_x = axis(false), along_y = axis(true);
    for (int j = 0; j < along_x.ny; ++j) {
        for (int i = 0; i < along_x.nx; ++i) {
            const Real leaves = (std::max(raw(along_x, i + 1, j), Real(0)) + std::max(-raw(along_x, i, j), Real(0))) +
                                (std::max(raw(along_y, j + 1, i), Real(0)) + std::max(-raw(along_y, j, i), Real(0)));
            const std::size_t c = along_x.cell(i, j);
            const Real safe = held[c] * (Real(1) - Real(4) * std::numeric_limits<Real>::epsilon());
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
    return gained;
}

/// 2.25.
template <class Real> void Solver<Real>::carry_foam() {
    if (!has(EFFECT_FOAM)) return;
    Field<Real> left(cells()), afloat(cells());
    for (std::size_t c = 0; c < cells(); ++c) {
        left[c] = after_fading(foam[c], settings.surface.foam_half_life, std::exp2(Real(-16)));
        afloat[c] = left[c] * std::min(open_water(c) / Real(0.02), Real(1));
    }
    const Field<Real> gained = drift(left, afloat, 1 / Real(0.85));
    const Axis along_x = axis(false), along_y = axis(true);
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

/// 2.27.
template <class Real> void Solver<Real>::carry_silt() {
    if (!has(EFFECT_SILT)) return;
    Field<Real> left(cells(), Real(0));
    const Real falls = static_cast<Real>(settings.surface.silt_settling) * P.dt;
    for (std::size_t c = 0; c < cells(); ++c) {
        const Real h = open_water(c);
        if (h <= P.eps) continue;
        left[c] = falls > Real(0) ? less_share(silt[c], std::min(falls / h, Real(1)), std::exp2(Real(-14))) : silt[c];
    }
    const Field<Real> gained = drift(left, left, Real(1));
    const Axis along_x = axis(false), along_y = axis(true);
    const auto past_sand = [&](const Axis& ax, int a, int b) {
        const auto face = [&](int at) {
            return pure_velocity.along(ax)[ax.face(at, b)] - sand_velocity.along(ax)[ax.face(at, b)];
        };
        return (face(a) + face(a + 1)) / 2;
    };
    for (int j = 0; j < along_x.ny; ++j) {
        for (int i = 0; i < along_x.nx; ++i) {
            const std::size_t c = along_x.cell(i, j);
            silt[c] = left[c] + gained[c];
            const Real h = open_water(c);
            if (h > P.eps && sand[c] > P.eps) {
                const Real u = past_sand(along_x, i, j), v = past_sand(along_y, j, i),
                           least = static_cast<Real>(settings.surface.silt_speed);
                const Real excess = std::max((u * u + v * v) / (least * least) / std::cbrt(h) - 1, Real(0));
                const Real rises = std::min(static_cast<Real>(settings.surface.silt_rate) * P.dt * excess, Real(8));
                silt[c] += std::floor(rises / surface_quantum) * surface_quantum;
            }
            silt[c] = std::min(silt[c], Real(8));
        }
    }
}

} // namespace wadi::reference
