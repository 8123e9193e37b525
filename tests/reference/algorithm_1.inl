// The paper's own choices for water (2.21) and its sand substep (2.22).
#pragma once
#include "tests/reference/transport.inl"

namespace wadi::reference {

template <class Real> void Solver<Real>::diffuse_mixed_height() {
    const Field<Real> old = mixed;
    const Real number = P.diffusion * P.dt / (P.dx * P.dx);
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const Real moved = whole_quanta(number * (old[L] - old[R]), P.quantum, false);
        mixed[L] -= moved;
        mixed[R] += moved;
    });
}

template <class Real> void Solver<Real>::spread_mixed_water() {
    for (std::size_t c = 0; c < cells(); ++c) water[c] += mixed[c] - std::min(water[c], sand[c]);
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

template <class Real> void Solver<Real>::renew_split() {
    mixed_predicted = mixed;
    pure_predicted = pure;
}

template <class Real> void Solver<Real>::push_mixed_water() {
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t f = ax.face(a, b);
        Real& um = mixed_velocity.along(ax)[f];
        um = clamped(um - mixed_push.along(ax)[f], P.clamp);
        mixed_push.along(ax)[f] = Real(0);
    });
}

template <class Real> void Solver<Real>::exchange_layers() {
    if (!has(EFFECT_MIXTURE)) return;
    if (!has(EFFECT_EXPLICIT_EXCHANGE)) {
        compute_momentum_exchange();
        return;
    }
    mixed_predicted = mixed_before;
    measure_layer_exchange();
    give_layer_exchange();
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

/// Trace and deviator (dd, dxy) of the logarithm of a cell's stretch; false where it has none.
template <class Real> bool Solver<Real>::strain_of(std::size_t c, Real& tr, Real& dd, Real& dxy) const {
    const Real det = Vxx[c] * Vyy[c] - Vxy[c] * Vxy[c];
    const Real middle = mean(Vxx[c], Vyy[c]);
    const Real d = mean(Vxx[c], -Vyy[c]);
    const Real radius = std::hypot(d, Vxy[c]);
    tr = dd = dxy = Real(0);
    if (!(det > Real(1e-15) && middle > Real(0) && middle + radius < Real(1e15))) return false;
    const Real e1 = std::log(middle + radius);
    const Real e2 = std::log(det / (middle + radius));
    tr = e1 + e2;
    if (radius > Real(0)) {
        dd = (e1 - e2) / Real(2) * d / radius;
        dxy = (e1 - e2) / Real(2) * Vxy[c] / radius;
    }
    return true;
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
        Real tr, dd, dxy;
        if (!strain_of(c, tr, dd, dxy)) {
            Vxx[c] = Vyy[c] = Real(1);
            Vxy[c] = Real(0);
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
        Vxx[c] = E * std::cosh(h) + shape * dd;
        Vyy[c] = E * std::cosh(h) - shape * dd;
        Vxy[c] = shape * dxy;
    }
}

template <class Real> void Solver<Real>::compute_sand_stress() {
    for (std::size_t c = 0; c < cells(); ++c) {
        sxx[c] = sxy[c] = syy[c] = Real(0);
        Real tr, dd, dxy;
        if (sand[c] <= P.eps || !strain_of(c, tr, dd, dxy)) continue;
        const Real J = Vxx[c] * Vyy[c] - Vxy[c] * Vxy[c];
        const Real pressure = (P.lambda + P.shear) * tr / J;
        const Real along = Real(2) * P.shear * dd / J;
        const Real across = Real(2) * P.shear * dxy / J;
        const Real c2 = std::cos(Real(2) * rotation[c]);
        const Real s2 = std::sin(Real(2) * rotation[c]);
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

template <class Real> void Solver<Real>::step_sand_by_algorithm_1() {
    limit_sand_outflow();
    compute_sand_flux();
    integrate_sand_height();
    extrapolate_sand_velocity();
    backtrace_sand_velocity();
    push_sand();
    if (has(EFFECT_WHOLE_STRAIN)) {
        yield_right_stretch();
        advect_deformation_gradient();
        compute_sand_stress();
        apply_sand_stress();
        if (has(EFFECT_STRAIN_BEYOND)) {
            update_sand_boundary_types();
            extrapolate_sand_velocity();
        }
        stretch_deformation_gradient();
        if (has(EFFECT_STRAIN_BEYOND)) extrapolate_strain();
    }
    exchange_layers();
    apply_friction();
}

} // namespace wadi::reference
