// Sand on its slope: factors of weight and friction, friction and viscosity within it (2.18), its cohesion on the ground (2.8),
// water that pores hold back (2.19).
#pragma once
#include "tests/reference/bends.inl"
#include <array>
#include <limits>

namespace wadi::reference {

/// Rise of the bed of sand, or of the ground under it, over a face to its far side; 0 where sand cannot pass it or a cell lies
/// outside.
template <class Real> Real Solver<Real>::open_rise(const Axis& ax, int a, int b, bool of_ground) const {
    if (a <= 0 || a >= ax.along() || b < 0 || b >= ax.across()) return Real(0);
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real low = terrain[L] + (of_ground ? Real(0) : sand[L]);
    const Real high = terrain[R] + (of_ground ? Real(0) : sand[R]);
    return blocked(sand[L], sand[R], low, high, P.eps) ? Real(0) : high - low;
}

template <class Real> auto Solver<Real>::slope_at(const Axis& ax, int a, int b) const -> Slope {
    if (!has(EFFECT_SLOPE_NORMAL)) return {Real(0), Real(1), Real(1), Real(0), Real(0)};
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real d = (terrain[R] + sand[R]) - (terrain[L] + sand[L]);
    const Axis other = axis(!ax.is_y); // the faces across: their `along` is this axis' row
    const auto across = [&](bool of_ground) {
        const auto rise = [&](int row, int column) { return open_rise(other, row, column, of_ground); };
        return ((rise(b, a - 1) + rise(b + 1, a - 1)) + (rise(b, a) + rise(b + 1, a))) / Real(4);
    };
    const Real e = across(false);
    const Real q = (d * d + e * e) / (P.dx * P.dx);
    const Real limit = P.wedge * P.wedge;
    const Real depth = d > Real(0) ? sand[R] : sand[L];
    Slope slope{d, Real(1) / (Real(1) + P.chi * std::min(q, limit)), Real(1), Real(0), q};
    if (q > limit) slope.r = P.wedge / std::sqrt(q);
    // Cohesion that could hold a cliff of this depth: its weight follows the ground, its push Culmann's plane.
    const Real share = std::min(deeper_cohesion(L, R), Real(1));
    const Real bed_d = terrain[R] - terrain[L];
    const Real bed_e = across(true);
    const Real q_bed = std::min((bed_d * bed_d + bed_e * bed_e) / (P.dx * P.dx), q);
    const Real C_bed = Real(1) / (Real(1) + P.chi * std::min(q_bed, limit));
    const Real in_one_cell = depth > Real(0) ? std::min((d * d + e * e) / (depth * depth), Real(1)) : Real(0);
    slope.clings = slope.C / C_bed;
    slope.C += share * (C_bed - slope.C);
    // What balances the tension of 2.20, which follows the depth, within friction: of that the ground's fall askew takes a part.
    const Real S = std::sqrt(q);
    const Real follows = S > Real(0) ? (d * bed_d + e * bed_e) / (P.dx * P.dx) / S : Real(0);
    const Real askew = (bed_d * bed_d + bed_e * bed_e) / (P.dx * P.dx) - follows * follows;
    const Real grip = std::sqrt(std::max(P.friction * C_bed * P.friction * C_bed - std::max(askew, Real(0)), Real(0)));
    const Real at_rest = S - std::max(follows + grip, Real(0));
    slope.r += share * (culmann_share(S, std::sqrt(q_bed), C_bed, at_rest, in_one_cell) - slope.r);
    return slope;
}

/// 2.18: R of the deeper cell, of equal depths the larger one.
template <class Real> Real Solver<Real>::deeper_cohesion(std::size_t L, std::size_t R) const {
    if (sand[L] == sand[R]) return std::max(cohesive_share[L], cohesive_share[R]);
    return cohesive_share[sand[L] > sand[R] ? L : R];
}

/// 2.18: F(S) of Culmann's plane.
template <class Real> Real Solver<Real>::culmann_excess(Real S) const {
    const Real c_f = P.yield_friction;
    const Real C = Real(1) / (Real(1) + P.chi * std::min(S * S, P.wedge * P.wedge));
    const Real plane = std::sqrt((Real(1) + S * S) * (Real(1) + c_f * c_f)) - Real(1) - c_f * S;
    return (P.rankine + P.adhesion * C / (Real(2) * S)) * plane;
}

/// 2.18: r_h, the share of its push that a face of slope S on ground of slope S_b has by Culmann.
template <class Real> Real Solver<Real>::culmann_share(Real S, Real S_b, Real C_b, Real at_rest, Real in_one_cell) const {
    const Real m = std::max({P.friction, S_b, Real(1e-10)});
    const Real wedge = std::max(P.friction, P.wedge);
    if (S <= m) return S > wedge ? wedge / S : Real(1);
    const Real upright = std::max(C_b * std::min(m, wedge) + S - m, at_rest);
    Real push = C_b * std::min(m, wedge) + (culmann_excess(S) - culmann_excess(m));
    push = std::min(std::max(push, at_rest), upright);
    push += in_one_cell * (upright - push);
    return push / (C_b * S);
}

/// 2.19: depth of sand with full pores.
template <class Real> Real Solver<Real>::full_depth(Real depth, Real stands) const {
    if (!has(EFFECT_RETENTION)) return std::min(stands, depth);
    return std::clamp((stands - P.retained * depth) / (Real(1) - P.retained), Real(0), depth);
}

template <class Real> auto Solver<Real>::pores_at(std::size_t L, std::size_t R) const -> Pores {
    const Real depth = sand[L] + sand[R];
    if (depth <= Real(0)) return {Real(0), Real(0)};
    const Real full = (full_depth(sand[L], standing(L)) + full_depth(sand[R], standing(R))) / depth;
    return {full, (mixed[L] + mixed[R]) / depth - P.porosity * full};
}

/// 2.7: k, how much of its weight's pressure the stress of a cell bears.
template <class Real> Real Solver<Real>::stressed(Real cohesive) const {
    return std::clamp(cohesive / Real(2) - Real(1), Real(0), Real(1));
}

/// 2.8: what cohesion on level ground takes from a velocity in a substep.
template <class Real> Real Solver<Real>::adhesion(std::size_t L, std::size_t R) const {
    const auto of_material = [&](std::size_t c) { // c_m/rho_s
        return cohesive_share[c] * sand[c] * P.gravity * P.yield_friction / (Real(4) * P.yield_cohesion);
    };
    return P.adhesion * P.substep * (of_material(L) + of_material(R)) / (sand[L] + sand[R]);
}

/// 2.18: depth of the sand that touches across a face.
template <class Real> Real Solver<Real>::shared_depth(std::size_t one, std::size_t other) const {
    const Real top = std::min(terrain[one] + sand[one], terrain[other] + sand[other]);
    return std::max(top - std::max(terrain[one], terrain[other]), Real(0));
}

/// 2.8: what Coulomb friction of a substep takes from a velocity on level ground.
template <class Real> Real Solver<Real>::level_friction(const Axis& ax, int a, int b) const {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real hs_bar = mean(sand[L], sand[R]);
    Real wet = hs_bar > Real(0) ? P.displaces * mean(mixed[L], mixed[R]) / P.porosity / hs_bar : Real(0);
    if (has(EFFECT_SLOPE_NORMAL)) { // what pores hold back weighs as the sand does
        const Pores pores = pores_at(L, R);
        wet = P.displaces * pores.full - pores.held;
    }
    const Real weight = std::max(Real(1) - P.rho_w / P.rho_s * wet, Real(0));
    const Real g =
        sand_gravity(std::max(sand[L], sand[R])) + (has(EFFECT_SLOPE_NORMAL) ? bed_lift.along(ax)[ax.face(a, b)] : Real(0));
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
    // A wedge slides as a whole: it does not rub within.
    const Real sheared = has(EFFECT_SLOPE_NORMAL) ? Real(1) - wedge_share(L, R) : Real(1);
    const Real N = P.spread_friction * sheared * slope_at(ax, a, b).C * level_friction(ax, a, b);
    sand_velocity.along(ax)[ax.face(a, b)] *= std::max(Real(1) - N * y / ((p + y) * p), Real(0));
}

/// 2.18: viscosity in the plane, from the velocities before this stage; walls slip.
template <class Real> void Solver<Real>::shear_in_plane(const Faces<Real>& old, const Axis& ax, int a, int b) {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real hb = mean(sand[L], sand[R]);
    if (hb <= Real(0)) return;
    const Field<Real>& u = old.along(ax);
    const Real own = u[ax.face(a, b)];
    // Depth of the corner between the rows row - 1 and row times the rise of u from this row to the other one.
    const auto beside = [&](int row, int other) {
        if (row == 0 || row == ax.across()) return Real(0);
        Real top = std::numeric_limits<Real>::infinity();
        Real ground = -top;
        for (const std::size_t c : {ax.cell(a - 1, row - 1), ax.cell(a, row - 1), ax.cell(a - 1, row), ax.cell(a, row)}) {
            top = std::min(top, terrain[c] + sand[c]);
            ground = std::max(ground, terrain[c]);
        }
        return std::max(top - ground, Real(0)) * (u[ax.face(a, other)] - own);
    };
    const Real here = shared_depth(L, R);
    const Real depth_L = a > 1 ? std::min(here, shared_depth(ax.cell(a - 2, b), L)) : here;
    const Real depth_R = a + 1 < ax.along() ? std::min(here, shared_depth(R, ax.cell(a + 1, b))) : here;
    const Real stretch = depth_R * (u[ax.face(a + 1, b)] - own) - depth_L * (own - u[ax.face(a - 1, b)]);
    const Real shear = beside(b + 1, b + 1) + beside(b, b - 1);
    sand_velocity.along(ax)[ax.face(a, b)] += P.shear_number * (stretch + shear) / hb;
}

/// 2.19: permeability of a cell's sand for its water, relative to full pores.
template <class Real> Real Solver<Real>::relative_permeability(std::size_t c) const {
    const Real stands = standing(c);
    if (stands >= sand[c]) return Real(1);
    const Real s = (stands / sand[c] - P.retained) / (Real(1) - P.retained);
    return s > Real(0) ? s * s * s : Real(0);
}

} // namespace wadi::reference
