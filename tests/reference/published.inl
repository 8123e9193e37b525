// The paper's method, Algorithm 1: water (2.21) and the sand substep (2.22).
#pragma once
#include "tests/reference/transport.inl"

namespace wadi::reference {

template <class Real> void Solver<Real>::diffuse_mixed_height() {
    const Field<Real> old = mixed;
    const Real number = P.diffusion * P.dt / (P.dx * P.dx);
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const Real moved = whole_quanta(number * (old[L] - old[R]), P.quantum, Real(0));
        mixed[L] -= moved;
        mixed[R] += moved;
    });
}

template <class Real> void Solver<Real>::spread_mixed_water() {
    for (std::size_t c = 0; c < cells(); ++c) water[c] += mixed[c] - std::min(water[c], sand[c]);
    mixed_diffused = mixed;
}

template <class Real> void Solver<Real>::measure_layer_exchange() {
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t f = ax.face(a, b);
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const auto gained = [&](std::size_t c) { return mixed[c] - mixed_predicted[c]; };
        const Real in = mean(std::max(gained(L), Real(0)), std::max(gained(R), Real(0)));
        const Real out = mean(std::min(gained(L), Real(0)), std::min(gained(R), Real(0)));
        layer_exchange.along(ax)[f] = in * pure_velocity.along(ax)[f] + out * mixed_velocity.along(ax)[f];
    });
}

template <class Real> void Solver<Real>::give_layer_exchange() {
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t f = ax.face(a, b);
        const Real given = layer_exchange.along(ax)[f];
        const Real h_m = mean(mixed[ax.cell(a - 1, b)], mixed[ax.cell(a, b)]);
        const Real h_w = mean(pure[ax.cell(a - 1, b)], pure[ax.cell(a, b)]);
        if (given == Real(0)) return;
        Real& um = mixed_velocity.along(ax)[f];
        Real& uw = pure_velocity.along(ax)[f];
        if (h_m > P.eps) um = clamped(um + given / h_m, P.clamp);
        if (h_w > P.eps) uw = clamped(uw - given / h_w, P.clamp);
    });
}

template <class Real> void Solver<Real>::push_water() {
    const Faces<Real> pure_old = pure_velocity;
    const Faces<Real> mixed_old = mixed_velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const std::size_t f = ax.face(a, b);
        const Real eta_L = terrain[L] + water[L];
        const Real eta_R = terrain[R] + water[R];
        const Real push = P.k * P.gravity * (eta_R - eta_L);
        const Real across = across_face(pure_old, ax, a, b);
        Real& uw = pure_velocity.along(ax)[f];
        uw = leaving_wet(uw - push, pure[L], pure[R], P.eps);
        uw = rubbed(uw, across, std::hypot(pure_old.along(ax)[f], across), P.dt * friction_rate(L, R));
        uw = shortened(uw, across, P.clamp);
        if (!has(EFFECT_MIXTURE)) return;
        Real& um = mixed_velocity.along(ax)[f];
        um = clamped(shortened(um, across_face(mixed_old, ax, a, b), P.clamp) - push, P.clamp);
        if (blocked(mixed[L], mixed[R], eta_L, eta_R, P.eps)) um = Real(0);
    });
}

template <class Real> Real Solver<Real>::sand_load(std::size_t c) const {
    return terrain[c] + sand[c] + P.rho_w / P.rho_s * (water[c] - std::min(water[c], sand[c]));
}

template <class Real> void Solver<Real>::push_sand() {
    const bool two_layers = has(EFFECT_MIXTURE);
    Faces<Real>& partner = two_layers ? mixed_velocity : pure_velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const Real h_s = mean(sand[L], sand[R]);
        const Real h_m = mean(mixed[L], mixed[R]);
        Real& us = sand_velocity.along(ax)[ax.face(a, b)];
        Real& um = partner.along(ax)[ax.face(a, b)];
        Real gained(0);
        if (has(EFFECT_DRAG) && h_m > P.eps && h_s > P.eps / Real(2)) {
            const Real impulse = P.substep * P.exchange * h_m * (um - us);
            gained = impulse / (P.rho_s * h_s);
            um -= impulse / (P.rho_w * (two_layers ? h_m : mean(water[L], water[R])));
        }
        us += gained - P.k_sand * P.gravity * (sand_load(R) - sand_load(L));
        if (h_s < P.eps / Real(2) || blocked(sand[L], sand[R], sand_load(L), sand_load(R), P.eps)) us = Real(0);
    });
}

/// Trace and deviator (dd, dxy) of the logarithm of a stretch; false where it has none.
template <class Real> bool Solver<Real>::strain_of(const Stretch& stretch, Real& tr, Real& dd, Real& dxy) {
    const auto [xx, xy, yy] = stretch;
    const Real det = xx * yy - xy * xy;
    const Real middle = mean(xx, yy);
    const Real d = mean(xx, -yy);
    const Real radius = std::hypot(d, xy);
    tr = dd = dxy = Real(0);
    if (!(det > Real(1e-15) && middle > Real(0) && middle + radius < Real(1e15))) return false;
    const Real e1 = std::log(middle + radius);
    const Real e2 = std::log(det / (middle + radius));
    tr = e1 + e2;
    if (radius > Real(0)) {
        dd = (e1 - e2) / Real(2) * d / radius;
        dxy = (e1 - e2) / Real(2) * xy / radius;
    }
    return true;
}

/// 2.13: the right stretch of a cell and the rotation (cs, sn) that F = R P is kept with.
template <class Real> auto Solver<Real>::right_stretch_of(std::size_t c, Real& cs, Real& sn) const -> Stretch {
    if (!has(EFFECT_DIRECT_STRAIN)) {
        cs = std::cos(rotation[c]);
        sn = std::sin(rotation[c]);
        return {Vxx[c], Vxy[c], Vyy[c]};
    }
    cs = Real(1);
    sn = Real(0);
    const Real fxy = Vxy[c] - rotation[c];
    const Real fyx = Vxy[c] + rotation[c];
    const Real size = std::hypot(Vxx[c] + Vyy[c], fyx - fxy);
    if (size > Real(0)) {
        cs = (Vxx[c] + Vyy[c]) / size;
        sn = (fyx - fxy) / size;
    }
    return {cs * Vxx[c] + sn * fyx, mean(cs * fxy + sn * Vyy[c], cs * fyx - sn * Vxx[c]), cs * Vyy[c] - sn * fxy};
}

template <class Real> void Solver<Real>::set_right_stretch(std::size_t c, const Stretch& stretch, Real cs, Real sn) {
    const auto [xx, xy, yy] = stretch;
    const bool direct = has(EFFECT_DIRECT_STRAIN);
    Vxx[c] = direct ? cs * xx - sn * xy : xx;
    Vyy[c] = direct ? cs * yy + sn * xy : yy;
    Vxy[c] = direct ? cs * xy + sn * mean(xx, -yy) : xy;
    if (direct) rotation[c] = sn * mean(xx, yy);
}

template <class Real> void Solver<Real>::yield_right_stretch() {
    const Real A = P.yield_friction * Real(2) * (P.lambda + P.shear);
    for (std::size_t c = 0; c < cells(); ++c) {
        if (sand[c] <= P.eps) continue;
        const Real phi = has(EFFECT_COHESION) ? water[c] / (water[c] + sand[c]) : Real(0);
        Real coh = P.c0;
        if (phi > P.phi3)
            coh = Real(0);
        else if (phi >= P.phi2)
            coh = P.c2 * (P.phi3 - phi) / (P.phi3 - P.phi2);
        else if (phi >= P.phi1)
            coh = P.c1 + (phi - P.phi1) * (P.c2 - P.c1) / (P.phi2 - P.phi1);
        else
            coh = P.c0 + phi * (P.c1 - P.c0) / P.phi1;
        Real cs, sn, tr, dd, dxy;
        if (!strain_of(right_stretch_of(c, cs, sn), tr, dd, dxy)) {
            set_right_stretch(c, {Real(1), Real(0), Real(1)}, cs, sn);
            continue;
        }
        const Real room = (coh - A * tr) / (Real(2) * P.shear); // for the size of the deviator
        const Real size = std::sqrt(Real(2) * (dd * dd + dxy * dxy));
        if (room <= Real(0)) {
            tr = coh / A;
            dd = dxy = Real(0);
        } else if (size > room) {
            dd *= room / size;
            dxy *= room / size;
        } else {
            continue;
        }
        const Real h = std::hypot(dd, dxy);
        const Real E = std::exp(tr / Real(2));
        const Real shape = h > Real(0) ? E * std::sinh(h) / h : E;
        set_right_stretch(c, {E * std::cosh(h) + shape * dd, shape * dxy, E * std::cosh(h) - shape * dd}, cs, sn);
    }
}

template <class Real> void Solver<Real>::compute_sand_stress() {
    for (std::size_t c = 0; c < cells(); ++c) {
        sxx[c] = sxy[c] = syy[c] = Real(0);
        Real cs, sn, tr, dd, dxy;
        if (sand[c] <= P.eps) continue;
        const Stretch right = right_stretch_of(c, cs, sn);
        if (!strain_of(right, tr, dd, dxy)) continue;
        const Real J = right.xx * right.yy - right.xy * right.xy;
        const Real pressure = (P.lambda + P.shear) * tr / J;
        const Real along = Real(2) * P.shear * dd / J;
        const Real across = Real(2) * P.shear * dxy / J;
        const Real c2 = cs * cs - sn * sn;
        const Real s2 = Real(2) * sn * cs;
        sxx[c] = pressure + (along * c2 - across * s2);
        syy[c] = pressure - (along * c2 - across * s2);
        sxy[c] = across * c2 + along * s2;
    }
}

template <class Real> void Solver<Real>::apply_sand_stress() {
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        add_stress(ax, a, b);
        if (blocked(sand[L], sand[R], sand_load(L), sand_load(R), P.eps)) sand_velocity.along(ax)[ax.face(a, b)] = Real(0);
    });
}

template <class Real> void Solver<Real>::extrapolate_rim_velocity() {
    update_sand_boundary_types();
    extrapolate_sand_velocity();
}

template <class Real> void Solver<Real>::extrapolate_strain() {
    const Axis x = axis(false);
    for (Field<Real>* component : {&Vxx, &Vxy, &Vyy, &rotation}) {
        const Field<Real> old = *component;
        const Real identity = component == &Vxx || component == &Vyy ? Real(1) : Real(0);
        for (int j = 0; j < x.ny; ++j)
            for (int i = 0; i < x.nx; ++i) {
                if (sand[x.cell(i, j)] > P.eps) continue;
                Real count(0);
                const auto lent = [&](int di, int dj) {
                    if (i + di < 0 || i + di >= x.nx || j + dj < 0 || j + dj >= x.ny) return Real(0);
                    const std::size_t other = x.cell(i + di, j + dj);
                    if (sand[other] <= P.eps) return Real(0);
                    count += Real(1);
                    return old[other] - identity;
                };
                const auto pair = [&](int di, int dj) { return lent(di, dj) + lent(-di, -dj); };
                const Real sum = (pair(1, 0) + pair(0, 1)) + (pair(1, 1) + pair(1, -1));
                (*component)[x.cell(i, j)] = identity + (count > Real(0) ? sum / count : Real(0));
            }
    }
}

/// 4.2.4: Coulomb friction and the clamps of what it is applied to.
template <class Real> void Solver<Real>::apply_frictional_force() {
    const bool two_layers = has(EFFECT_MIXTURE);
    Faces<Real>& partner = two_layers ? mixed_velocity : pure_velocity;
    const Faces<Real> us_old = sand_velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const std::size_t f = ax.face(a, b);
        const Real h_s = mean(sand[L], sand[R]);
        const Real h_m = mean(mixed[L], mixed[R]);
        Real& us = sand_velocity.along(ax)[f];
        Real& um = partner.along(ax)[f];
        if (has(EFFECT_DRAG)) um = two_layers && h_m <= Real(0) ? Real(0) : clamped(um, P.clamp);
        if (h_s <= P.eps / Real(2)) {
            us = Real(0);
            return;
        }
        const Real across = across_face(us_old, ax, a, b);
        const Real speed = std::sqrt(us * us + across * across);
        const Real borne = std::max(Real(1) - P.rho_w / P.rho_s * h_m / h_s, Real(0));
        const Real lost = P.friction * P.gravity * P.substep * borne;
        const Real kept = speed > Real(0) ? std::max(Real(1) - lost / speed, Real(0)) : Real(0);
        us = shortened(kept * us, kept * across, P.clamp_sand);
    });
}

template <class Real> void Solver<Real>::step_published_water() {
    split_water();
    update_water_boundary_types();
    limit_water_outflow();
    compute_water_flux();
    integrate_water_height();
    if (has(EFFECT_MIXTURE)) measure_layer_exchange();
    extrapolate_pure_velocity();
    backtrace_pure_velocity();
    if (has(EFFECT_MIXTURE)) {
        transport_mixed_velocity();
        give_layer_exchange();
    }
    push_water();
    carry_foam();
    wet_ground();
    carry_silt();
    if (has(EFFECT_BED_SHEAR)) compute_bed_load();
}

template <class Real> void Solver<Real>::step_published_sand() {
    update_open_sand_sides();
    update_sand_boundary_types();
    limit_sand_outflow();
    compute_sand_flux();
    integrate_sand_height();
    extrapolate_sand_velocity();
    backtrace_sand_velocity();
    push_sand();
    if (has(EFFECT_ELASTOPLASTIC)) {
        yield_right_stretch();
        advect_deformation_gradient();
        compute_sand_stress();
        apply_sand_stress();
        extrapolate_rim_velocity();
        stretch_deformation_gradient();
        extrapolate_strain();
    }
    if (has(EFFECT_MIXTURE)) {
        mixed_predicted = mixed_before;
        measure_layer_exchange();
        give_layer_exchange();
    }
    apply_frictional_force();
}

template <class Real> void Solver<Real>::step_published() {
    if (has(EFFECT_DIFFUSION)) {
        diffuse_mixed_velocity();
        diffuse_mixed_height();
        spread_mixed_water();
    }
    update_open_sides();
    if (has(EFFECT_WATER)) step_published_water();
    for (int substep = 0; has(EFFECT_SAND) && substep < P.substeps; ++substep) step_published_sand();
}

} // namespace wadi::reference
