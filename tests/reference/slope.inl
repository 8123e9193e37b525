// Sand on its slope: factors of weight and friction, friction and viscosity within it (2.18), water that pores hold back (2.19).
#pragma once
#include "tests/reference/bends.inl"
#include <array>

namespace wadi::reference {

/// Rise of the bed of sand over a face to its far side; 0 where sand cannot pass it or a cell lies outside.
template <class Real> Real Solver<Real>::open_rise(const Axis& ax, int a, int b) const {
    if (a <= 0 || a >= ax.along() || b < 0 || b >= ax.across()) return Real(0);
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real low = terrain[L] + sand[L];
    const Real high = terrain[R] + sand[R];
    return blocked(sand[L], sand[R], low, high, P.eps) ? Real(0) : high - low;
}

template <class Real> auto Solver<Real>::slope_at(const Axis& ax, int a, int b) const -> Slope {
    if (!has(EFFECT_SLOPE_NORMAL)) return {Real(0), Real(1), Real(1), Real(0)};
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real d = (terrain[R] + sand[R]) - (terrain[L] + sand[L]);
    const Axis other = axis(!ax.is_y); // the faces across: their `along` is this axis' row
    const Real e =
        ((open_rise(other, b, a - 1) + open_rise(other, b + 1, a - 1)) + (open_rise(other, b, a) + open_rise(other, b + 1, a))) /
        Real(4);
    const Real q = (d * d + e * e) / (P.dx * P.dx);
    const Real limit = P.wedge * P.wedge;
    Slope slope{d, Real(1) / (Real(1) + P.chi * std::min(q, limit)), Real(1), q};
    if (q > limit) slope.r = P.wedge / std::sqrt(q);
    // Cohesion that could hold a cliff of this depth pushes as it pulls; of equal depths the larger share counts.
    Real share = sand[L] > sand[R] ? cohesive_share[L] : cohesive_share[R];
    if (sand[L] == sand[R]) share = std::max(cohesive_share[L], cohesive_share[R]);
    slope.C += share * (Real(1) - slope.C);
    slope.r += share * (Real(1) - slope.r);
    return slope;
}

/// 2.8: what Coulomb friction of a substep takes from a velocity on level ground.
template <class Real> Real Solver<Real>::level_friction(const Axis& ax, int a, int b) const {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real hs_bar = mean(sand[L], sand[R]);
    const Real wet = hs_bar > Real(0) ? mean(mixed[L], mixed[R]) / hs_bar : Real(0);
    const Real weight = std::max(Real(1) - P.rho_w / P.rho_s * wet, Real(0));
    const Real g = sand_gravity(std::max(sand[L], sand[R])) + (has(EFFECT_SLOPE_NORMAL) ? bed_lift.along(ax)[ax.face(a, b)] : Real(0));
    return P.friction * std::max(g, Real(0)) * P.substep * weight;
}

/// 2.18: friction within sand that gets thinner while it slides, from the velocities before this stage.
template <class Real> void Solver<Real>::slow_from_within(const Faces<Real>& old, const Axis& ax, int a, int b) {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Field<Real>& along = old.along(ax);
    const Field<Real>& cross = old.across(ax);
    const Real u = along[ax.face(a, b)];
    const Real v_sw = cross[ax.cross(a - 1, b)];
    const Real v_nw = cross[ax.cross(a - 1, b + 1)];
    const Real v_se = cross[ax.cross(a, b)];
    const Real v_ne = cross[ax.cross(a, b + 1)];
    const Real divergence =
        ((along[ax.face(a + 1, b)] - along[ax.face(a - 1, b)]) / Real(2) + ((v_nw + v_ne) - (v_sw + v_se)) / Real(2)) / P.dx;
    const Real y = std::min(sand[L], sand[R]) * std::max(divergence, Real(0));
    if (y <= Real(0)) return;
    const Real v = ((v_sw + v_nw) + (v_se + v_ne)) / Real(4);
    const Real p = std::sqrt(u * u + v * v + P.gravity * mean(sand[L], sand[R]) / Real(400));
    if (p <= Real(0)) return;
    const Real N = P.spread_friction * slope_at(ax, a, b).C * level_friction(ax, a, b);
    sand_velocity.along(ax)[ax.face(a, b)] *= std::max(Real(1) - N * y / ((p + y) * p), Real(0));
}

/// 2.18: viscosity in the plane, from the velocities before this stage; walls slip.
template <class Real> void Solver<Real>::shear_in_plane(const Faces<Real>& old, const Axis& ax, int a, int b) {
    const Real hs_L = sand[ax.cell(a - 1, b)];
    const Real hs_R = sand[ax.cell(a, b)];
    const Real hb = mean(hs_L, hs_R);
    if (hb <= Real(0)) return;
    const Field<Real>& u = old.along(ax);
    const Real own = u[ax.face(a, b)];
    // Depth of the corner between the rows row - 1 and row times the rise of u from this row to the other one.
    const auto beside = [&](int row, int other) {
        if (row == 0 || row == ax.across()) return Real(0);
        const Real thinnest = std::min(
            {sand[ax.cell(a - 1, row - 1)], sand[ax.cell(a, row - 1)], sand[ax.cell(a - 1, row)], sand[ax.cell(a, row)]});
        return thinnest * (u[ax.face(a, other)] - own);
    };
    const Real stretch = hs_R * (u[ax.face(a + 1, b)] - own) - hs_L * (own - u[ax.face(a - 1, b)]);
    const Real shear = beside(b + 1, b + 1) + beside(b, b - 1);
    sand_velocity.along(ax)[ax.face(a, b)] += P.shear_number * (stretch + shear) / hb;
}

/// 2.19: permeability of a cell's sand for its water, relative to full pores.
template <class Real> Real Solver<Real>::relative_permeability(std::size_t c) const {
    if (water[c] >= sand[c]) return Real(1);
    const Real s = (water[c] / sand[c] - P.retained) / (Real(1) - P.retained);
    return s > Real(0) ? s * s * s : Real(0);
}

} // namespace wadi::reference
