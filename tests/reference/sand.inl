// The sand substep: heights, velocity, exchange with the water inside the sand (2.4a, 2.5, 2.7, 2.8).
#pragma once
#include "tests/reference/slope.inl"
#include <array>

namespace wadi::reference {

template <class Real> void Solver<Real>::limit_sand_outflow() { limit_outflow(Layer::sand, P.k_sand, sand_scale); }

template <class Real> void Solver<Real>::compute_sand_flux() { limited_flux(Layer::sand, P.k_sand, sand_scale, sand_flux); }

template <class Real> void Solver<Real>::integrate_sand_height() {
    const Axis x = axis(false);
    sand_before = sand;
    for (std::size_t c = 0; c < cells(); ++c) mixed_before[c] = in_pores(c);
    for (int j = 0; j < x.ny; ++j)
        for (int i = 0; i < x.nx; ++i) {
            Real& h = sand[x.cell(i, j)];
            h = filled(h, gain(sand_flux, i, j));
        }
    split_water();
    if (!has(EFFECT_OPEN_SIDES)) return;
    for (const bool is_y : {false, true}) {
        const Axis ax = axis(is_y);
        const Field<Real>& flux = sand_flux.along(ax);
        for (int b = 0; b < ax.across(); ++b)
            sand_added += static_cast<double>(flux[ax.face(0, b)]) - static_cast<double>(flux[ax.face(ax.along(), b)]);
    }
}

/// 2.7: gravity that keeps sand waves stable.
template <class Real> Real Solver<Real>::sand_gravity(Real deepest) const {
    if (P.sand_gravity_cap <= Real(0) || deepest <= Real(0)) return P.gravity;
    return std::min(P.gravity, P.sand_gravity_cap / (P.k_sand * P.k_sand * deepest));
}

/// Force of the stress on an inner face.
template <class Real> void Solver<Real>::add_stress(const Axis& ax, int a, int b) {
    // Shear at the corner between the cells a - 1, a along and b - 1, b across; 0 on the wall.
    const auto corner = [&](int row) {
        if (row == 0 || row == ax.across()) return Real(0);
        const std::array<std::size_t, 4> c = {ax.cell(a - 1, row - 1), ax.cell(a, row), ax.cell(a, row - 1), ax.cell(a - 1, row)};
        if (mean_corner_shear || has(EFFECT_PUBLISHED)) {
            Real sum(0);
            for (const std::size_t n : c) sum += sand[n] * sxy[n];
            return sum / Real(4);
        }
        const Real thinnest = std::min(std::min(sand[c[0]], sand[c[1]]), std::min(sand[c[2]], sand[c[3]]));
        return thinnest * (((sxy[c[0]] + sxy[c[1]]) + (sxy[c[2]] + sxy[c[3]])) / Real(4));
    };
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    Real& u = sand_velocity.along(ax)[ax.face(a, b)];
    const Field<Real>& normal = ax.is_y ? syy : sxx;
    const Real force = (sand[R] * normal[R] - sand[L] * normal[L]) + (corner(b + 1) - corner(b));
    const Real hb = mean(sand[L], sand[R]);
    u = hb < P.film / Real(2) ? Real(0) : u + P.k_sand * force / (P.rho_s * hb);
}

/// 2.7 and 2.18: gravity and the wet/dry rule with S = H + hs + (rho_w/rho_s) h_w.
template <class Real> void Solver<Real>::add_gravity(const Faces<Real>& old, const Axis& ax, int a, int b) {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const std::size_t f = ax.face(a, b);
    const Real ratio = P.rho_w / P.rho_s;
    const auto open_water = [&](std::size_t c) { return water[c] - std::min(water[c], pore_room(sand[c])); };
    const auto surface = [&](std::size_t c) { return terrain[c] + sand[c] + ratio * open_water(c); };
    const Real S_L = surface(L);
    const Real S_R = surface(R);
    const Real g_f = sand_gravity(std::max(sand[L], sand[R]));
    Real& u = sand_velocity.along(ax)[f];
    const bool pushed = sand[L] + sand[R] > Real(0);
    const Slope slope = has(EFFECT_SLOPE_NORMAL) ? slope_at(ax, a, b) : Slope{Real(0), Real(1), Real(1), Real(0), Real(0)};
    friction_limit.along(ax)[f] = pushed ? slope.C * level_friction(ax, a, b) + slope.clings * adhesion(L, R) : Real(0);
    if (has(EFFECT_SLOPE_NORMAL)) {
        const Pores pores = pores_at(L, R);
        const Real own = slope.C * slope.r * slope.d;
        const Real borne = std::max(Real(1) - ratio * P.displaces * pores.full, Real(0)); // by the water's pressure
        // What drag brings of held water: the fall of the water's surface, where 2.4c lets it.
        const Real eta_L = felt_surface(L);
        const Real eta_R = felt_surface(R);
        const Real brought = blocked(mixed[L], mixed[R], eta_L, eta_R, P.eps) ? Real(0) : eta_R - eta_L;
        const Real weight = std::max(Real(1) - ratio * (P.displaces * pores.full - pores.held), Real(0));
        const Real down = borne * own + ratio * pores.held * (own - brought) + weight * wedge_push(ax, a, b, slope, own);
        // Rankine's passive pressure, (1 + sin phi)/(1 - sin phi) times the sand's own, where no stress bears it.
        const Real sine = P.friction / std::sqrt(Real(1) + P.friction * P.friction);
        const Real passive = (Real(1) + sine) / (Real(1) - sine);
        const Real k = stressed(deeper_cohesion(L, R));
        const Real K = k + (Real(1) - k) * passive;
        // 2.23: pressure drives the grains, too; uphill they meet the sand above.
        const Real withheld = (K - slope.C * slope.r) * slope.d * borne;
        const Real grains = ratio * P.pressed * pores.full * brought;
        const Real side = withheld > Real(0) ? Real(1) : Real(-1);
        const Real uphill = std::max(-side * (down + grains), Real(0));
        const Real met = side * std::min({uphill, std::abs(withheld), std::abs(grains)});
        u -= P.k_sand * g_f * (down + grains + met);
        withheld_push.along(ax)[f] = pushed ? P.k_sand * g_f * (withheld - met) : Real(0);
    } else {
        u -= P.k_sand * g_f * (S_R - S_L);
    }
    const bool stands = has(EFFECT_SLOPE_NORMAL) ? beyond_head(old, ax, a, b, u) : blocked(sand[L], sand[R], S_L, S_R, P.film);
    if (stands) u = Real(0);
}

template <class Real> void Solver<Real>::integrate_sand_velocity() {
    const Faces<Real> old = sand_velocity;
    advect(EFFECT_SECOND_ORDER_SAND, sand, sand_flux, old, P.k_sand, sand_velocity);
    for_inner_faces([&](const Axis& ax, int a, int b) {
        if (has(EFFECT_SLOPE_NORMAL)) sand_velocity.along(ax)[ax.face(a, b)] += bend_gain.along(ax)[ax.face(a, b)];
        if (has(EFFECT_INTERNAL_FRICTION)) {
            slow_from_within(old, ax, a, b);
            shear_in_plane(old, ax, a, b);
        }
        if (has(EFFECT_ELASTOPLASTIC)) add_stress(ax, a, b);
        add_gravity(old, ax, a, b);
    });
}

/// 2.4a: momentum follows the water that changes between the pure and the mixed layer.
template <class Real>
void Solver<Real>::exchange_split(const Field<Real>& mixed_old, const Field<Real>& pure_old, const Field<Real>& mixed_new) {
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const Real d_L = mixed_new[L] - mixed_old[L];
        const Real d_R = mixed_new[R] - mixed_old[R];
        const Real pos = mean(std::max(d_L, Real(0)), std::max(d_R, Real(0)));
        const Real neg = mean(std::max(-d_L, Real(0)), std::max(-d_R, Real(0)));
        const Real m = std::max(mean(mixed_old[L], mixed_old[R]) - neg, Real(0));
        const Real w = std::max(mean(pure_old[L], pure_old[R]) - pos, Real(0));
        Real& um = mixed_velocity.along(ax)[ax.face(a, b)];
        Real& uw = pure_velocity.along(ax)[ax.face(a, b)];
        const Real um_old = um;
        const Real uw_old = uw;
        if (m + pos > P.eps) um = (m * um_old + pos * uw_old) / (m + pos);
        if (w + neg > P.eps) uw = (w * uw_old + neg * um_old) / (w + neg);
    });
}

template <class Real> void Solver<Real>::compute_momentum_exchange() {
    Field<Real> pure_before(cells());
    for (std::size_t c = 0; c < cells(); ++c) pure_before[c] = water[c] - mixed_before[c];
    exchange_split(mixed_before, pure_before, mixed);
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t f = ax.face(a, b);
        Real& um = mixed_velocity.along(ax)[f];
        um -= mixed_push.along(ax)[f];
        if (!has(EFFECT_DRAG)) um = clamped(um, P.clamp); // with drag 2.8 clamps it
    });
}

/// 2.8: implicit pair of drag and Coulomb friction, on every inner face from the velocities before it.
template <class Real> void Solver<Real>::apply_friction() {
    const bool two_layers = has(EFFECT_MIXTURE);
    const bool drag = has(EFFECT_DRAG); // otherwise the water is left alone, clamp and all
    Faces<Real>& partner = two_layers ? mixed_velocity : pure_velocity;
    const Faces<Real> us_old = sand_velocity;
    const Faces<Real> um_old = partner;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const std::size_t f = ax.face(a, b);
        const Real um_cross = across_face(um_old, ax, a, b);
        const Real hs_bar = mean(sand[L], sand[R]);
        const Real hm_bar = mean(mixed[L], mixed[R]);
        Real& us = sand_velocity.along(ax)[f];
        Real& um = partner.along(ax)[f];
        if (std::max(sand[L], sand[R]) <= P.film) {
            us = Real(0);
            if (drag) um = two_layers && hm_bar <= Real(0) ? Real(0) : clamped(um, P.clamp);
            return;
        }
        // Per bed area: inertia of the partner layer and of the sand, and the drag impulse per velocity difference.
        // In the two-layer form both sides are divided by h_m, so that thin layers divide by nothing small.
        const Real r = hm_bar / (P.rho_s * hs_bar);
        // 2.19: of the water that pores hold back nothing moves on its own.
        const Real slip = um_old.along(ax)[f] - us_old.along(ax)[f];
        Real free(1);
        if (has(EFFECT_RETENTION)) {
            const Real left = relative_permeability(L);
            const Real right = relative_permeability(R);
            free = slip > Real(0) ? left : slip < Real(0) ? right : std::max(left, right);
        }
        const Real inertia = two_layers ? P.rho_w : P.rho_w * mean(water[L], water[R]);
        const Real kd = P.substep * P.exchange * (two_layers ? Real(1) : hm_bar);
        Real kappa(0);
        if (drag && kd > Real(0) && hm_bar > P.eps)
            kappa = (two_layers ? r : Real(1) / (P.rho_s * hs_bar)) * inertia * kd / (inertia * free + kd);
        const Real carried = kappa * um_old.along(ax)[f];
        Real p = us_old.along(ax)[f] + carried;
        Real p_cross = across_face(us_old, ax, a, b) + kappa * um_cross;
        if (has(EFFECT_SLOPE_NORMAL)) { // 2.18: what the water brings uphill meets the whole push
            const Real up = withheld_push.along(ax)[f];
            const Real up_cross = across_face(withheld_push, ax, a, b);
            const Real length = std::hypot(up, up_cross);
            if (length > Real(0)) {
                const Real uphill = (carried * up + kappa * um_cross * up_cross) / length;
                const Real moves = (p * up + p_cross * up_cross) / length;
                const Real met = std::max(std::min({uphill, length, moves}), Real(0));
                p -= met * up / length;
                p_cross -= met * up_cross / length;
            }
        }
        const Real size = std::sqrt(p * p + p_cross * p_cross);
        const Real N = friction_limit.along(ax)[f];
        const Real kept = size > Real(0) ? std::max(Real(1) - N / size, Real(0)) / (Real(1) + kappa) : Real(0);
        us = shortened(kept * p, kept * p_cross, P.clamp_sand);
        if (!drag) return;
        if (two_layers && hm_bar <= Real(0)) // mixed water that is not there stands still
            um = Real(0);
        else if (drag && inertia * free + kd > Real(0))
            um = (inertia * free * um_old.along(ax)[f] + kd * us) / (inertia * free + kd);
        um = clamped(um, P.clamp);
    });
}

} // namespace wadi::reference
