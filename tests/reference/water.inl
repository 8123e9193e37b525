// The water step: diffusion, heights, pressure (2.1 to 2.4).
#pragma once
#include "tests/reference/slope.inl"

namespace wadi::reference {

template <class Real> void Solver<Real>::split_water() {
    for (std::size_t c = 0; c < cells(); ++c) {
        mixed[c] = has(EFFECT_SAND) ? in_pores(c) : Real(0);
        pure[c] = has(EFFECT_MIXTURE) ? water[c] - mixed[c] : water[c];
    }
}

template <class Real> Real Solver<Real>::diffusion(const Axis& ax, int a, int b) const {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    Real q(0);
    const auto wet = [&](std::size_t c) { return std::min(transport_depth(c), open_depth(c)); };
    const Real rise = (terrain[R] + transport_depth(R)) - (terrain[L] + transport_depth(L));
    const bool waiting = has(EFFECT_INFILTRATION) && (waits(L) || waits(R));
    const Real coarse = !waiting ? lifts(L, R) : std::max(waits(L) ? Real(1) : lifts(L, L), waits(R) ? Real(1) : lifts(R, R));
    if (has(EFFECT_PUBLISHED))
        q = -P.diffusion * (mixed[R] - mixed[L]) / P.dx;
    else if (open_depth(L) > P.eps && open_depth(R) > P.eps && std::abs(rise) > P.rest_surface * coarse)
        q = -P.porosity * P.diffusion * minmod(wet(R) - wet(L), rise) / P.dx;
    const std::size_t from = q > Real(0) ? L : R;
    return has(EFFECT_RETENTION) && !waits(from) ? q * relative_permeability(from) : q; // 2.24: what waits is over full pores
}

template <class Real> void Solver<Real>::diffuse_mixed_water() {
    if (!has(EFFECT_DIFFUSION)) return;
    for_inner_faces([&](const Axis& ax, int a, int b) { diffusion_flux.along(ax)[ax.face(a, b)] = diffusion(ax, a, b); });
}

/// 2.15 on faces: D div(u grad h) / h, centred; heights beyond the sides repeat the last one.
template <class Real> void Solver<Real>::diffuse_mixed_velocity() {
    const Faces<Real> old = mixed_velocity;
    const Real number = P.diffusion * P.dt / (P.dx * P.dx);
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const auto depth = [&](int cell, int row) {
            return mixed[ax.cell(std::clamp(cell, 0, ax.along() - 1), std::clamp(row, 0, ax.across() - 1))];
        };
        const auto at_face = [&](int face, int row) { return mean(depth(face - 1, row), depth(face, row)); };
        const Field<Real>& u = old.along(ax);
        const Real own = u[ax.face(a, b)];
        const Real h = at_face(a, b);
        if (h <= P.eps) return;
        const auto part = [&](int face, int row) { // mean velocity of the two faces times the rise of h to the other one
            const Real other = row < 0 || row >= ax.across() ? own : u[ax.face(face, row)];
            return mean(own, other) * (at_face(face, row) - h);
        };
        const Real spread = (part(a + 1, b) + part(a - 1, b)) + (part(a, b - 1) + part(a, b + 1));
        mixed_velocity.along(ax)[ax.face(a, b)] = clamped(own + number * spread / h, P.clamp);
    });
    for (Faces<Real>* flux : {&diffusion_flux, &mixed_flux}) { // 2.21: heights spread by themselves
        std::fill(flux->x.begin(), flux->x.end(), Real(0));
        std::fill(flux->y.begin(), flux->y.end(), Real(0));
    }
}

template <class Real> void Solver<Real>::limit_water_outflow() {
    limit_outflow(Layer::pure, P.k, pure_scale);
    if (has(EFFECT_MIXTURE)) limit_outflow(Layer::mixed, P.k, mixed_scale);
}

template <class Real> void Solver<Real>::compute_water_flux() {
    limited_flux(Layer::pure, P.k, pure_scale, pure_flux);
    if (has(EFFECT_MIXTURE)) limited_flux(Layer::mixed, P.k, mixed_scale, mixed_flux);
}

template <class Real> void Solver<Real>::integrate_water_height() {
    const Axis x = axis(false);
    for (int j = 0; j < x.ny; ++j) {
        for (int i = 0; i < x.nx; ++i) {
            const std::size_t c = x.cell(i, j);
            pure_predicted[c] = filled(pure[c], gain(pure_flux, i, j));
            mixed_predicted[c] = Real(0);
            if (has(EFFECT_MIXTURE)) mixed_predicted[c] = filled(mixed[c], gain(mixed_flux, i, j));
            water[c] = pure_predicted[c] + mixed_predicted[c];
        }
    }
    split_water();
    if (!has(EFFECT_OPEN_SIDES)) return;
    for (const bool is_y : {false, true}) {
        const Axis ax = axis(is_y);
        for (int b = 0; b < ax.across(); ++b) {
            const std::size_t first = ax.face(0, b);
            const std::size_t last = ax.face(ax.along(), b);
            water_added += static_cast<double>(pure_flux.along(ax)[first]) - static_cast<double>(pure_flux.along(ax)[last]);
            water_added += static_cast<double>(mixed_flux.along(ax)[first]) - static_cast<double>(mixed_flux.along(ax)[last]);
        }
    }
}

/// 2.24: Green and Ampt's rate, in whole quanta, over what flowed through the sides of sand that is not full.
template <class Real> void Solver<Real>::infiltrate() {
    if (!has(EFFECT_INFILTRATION)) return;
    const Real phase = P.quantum > Real(0) ? rounding_phase(Layer::pure, axis(false), 0) : Real(0);
    for (std::size_t c = 0; c < cells(); ++c) {
        const Real room = pore_room(sand[c]);
        const Real start = std::min(pore_water[c] >= Real(0) && pore_water[c] < room ? mixed_predicted[c] : water[c], room);
        const Real above = water[c] - start;
        const Real deep = std::max(start / P.porosity, Real(0.01));
        const Real rate = P.conductivity * (Real(1) + (above + P.suction) / deep);
        const Real inside = start + std::min({whole_quanta(P.dt * rate, P.quantum, phase), above, room - start});
        const bool fills = inside >= room, over = water[c] > inside;
        pore_water[c] = fills && over ? Real(-1) : inside;
        felt_water[c] = over && !fills ? inside : water[c];
    }
    split_water();
}

/// 2.24: to the quantum.
template <class Real> void Solver<Real>::open_pores() {
    for (std::size_t c = 0; c < cells(); ++c) {
        open_sand[c] = open_depth(c);
        if (P.quantum <= Real(0) || !waits(c)) continue;
        Real whole = std::floor(in_pores(c) / P.porosity / P.quantum) * P.quantum;
        for (int n = 0; n < 2 && pore_room(whole) < in_pores(c); ++n) whole += P.quantum;
        open_sand[c] = std::min(whole, sand[c]);
    }
}

/// 2.4b: gravity that keeps surface waves stable beside velocities up to `fastest`.
template <class Real> Real Solver<Real>::water_gravity(Real fastest, Real deepest) const {
    if (P.gravity_cap <= Real(0) || deepest <= Real(0)) return P.gravity;
    const Real room = std::max(Real(0.15), P.gravity_cap - P.k * fastest);
    return std::min(P.gravity, room * room / (P.k * P.k * deepest));
}

/// 2.4: c of the stresses on the bed between two cells under water so deep.
template <class Real> Real Solver<Real>::bed_drag(std::size_t L, std::size_t R, Real depth) const {
    const Real n_L = P.manning + roughness[L];
    const Real n_R = P.manning + roughness[R];
    Real c = P.bed_friction + P.gravity * mean(n_L * n_L, n_R * n_R) / std::cbrt(depth);
    if (mean(sand[L], sand[R]) > P.eps) c += P.bed_shear;
    return c;
}

/// c/hb between two cells, 0 without water.
template <class Real> Real Solver<Real>::friction_rate(std::size_t L, std::size_t R) const {
    const Real depth = mean(pure[L], pure[R]);
    return depth > Real(0) ? bed_drag(L, R, depth) / depth : Real(0);
}

/// 2.4f: how much of the pure water of `from` stands beside the sand of `to`, whose pores are not full.
template <class Real> Real Solver<Real>::depth_beside(std::size_t from, std::size_t to) const {
    if (!has(EFFECT_MIXTURE) || !has(EFFECT_SLOPE_NORMAL) || P.exchange <= Real(0)) return Real(0);
    if (has(EFFECT_INFILTRATION)) return Real(0); // 2.24
    const Real top = terrain[to] + sand[to];
    if (water_surface(to) >= top) return Real(0);
    const Real upper = std::min(water_surface(from), top);
    return std::max(upper - std::max(terrain[from] + sand[from], terrain[to]), Real(0));
}

/// 2.4f: pure water that flows into sand from beside it and the water of the face's sand become as fast as both together.
template <class Real> void Solver<Real>::enter_sand(Real& uw, Real& um, std::size_t L, std::size_t R, Real beside) const {
    if (beside <= Real(0) || uw == Real(0)) return;
    const Real share = std::min(beside / pure[uw > Real(0) ? L : R], Real(1));
    const Real entering = share * mean(pure[L], pure[R]);
    const Real inside = mean(mixed[L], mixed[R]);
    const Real together = (inside * um + entering * uw) / (inside + entering);
    uw = std::lerp(uw, together, share);
    um = together;
}

/// 2.4b, f, e, c, bed friction and d on one inner face.
template <class Real>
void Solver<Real>::water_face(const Faces<Real>& pure_old, const Faces<Real>& mixed_old, const Axis& ax, int a, int b) {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const std::size_t f = ax.face(a, b);
    const Real eta_L = water_surface(L);
    const Real eta_R = water_surface(R);
    const Real rise = eta_R - eta_L;
    const Real coarse = lifts(L, R);
    const bool level = std::abs(rise) <= P.rest_surface * coarse;
    Real& uw = pure_velocity.along(ax)[f];
    Real& um = mixed_velocity.along(ax)[f];
    const Real before = pure_old.along(ax)[f];
    const Real fastest = std::max(std::abs(uw), std::abs(um));
    const Real pull = P.k * water_gravity(fastest, std::max(coupled_depth(L), coupled_depth(R)));
    const Real push = pull * rise;

    const Real pure_rise = pure_surface(R) - pure_surface(L);
    uw -= pull * pure_rise;
    const Real beside_L = depth_beside(L, R);
    const Real beside_R = depth_beside(R, L);
    enter_sand(uw, um, L, R, uw > Real(0) ? beside_L : beside_R);
    const Real fine = has(EFFECT_INFILTRATION) ? Real(1) : coarse;
    if (std::abs(pure_rise) <= P.rest_surface * fine && std::abs(uw) <= P.rest_velocity * fine) uw = Real(0);
    uw = leaving_wet(uw, pure[L], pure[R], P.eps);
    const Real across = across_face(pure_old, ax, a, b);
    uw = rubbed(uw, across, std::hypot(before, across), P.dt * friction_rate(L, R));
    uw = shortened(uw, across, P.clamp);

    if (!has(EFFECT_MIXTURE)) return;
    Real& share = mixed_push.along(ax)[f];
    share = push / Real(P.substeps);
    const bool rests = level && std::abs(um) <= P.rest_velocity * coarse;
    if (rests || blocked(mixed[L] + beside_L, mixed[R] + beside_R, eta_L, eta_R, P.eps)) {
        um = Real(0);
        share = Real(0);
    }
    um = shortened(um, across_face(mixed_old, ax, a, b), P.clamp);
}

/// 2.3: viscosity along each axis in cells that are compressed along it more than their neighbours explain.
template <class Real> void Solver<Real>::damp_shocks(const Faces<Real>& before) {
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const Field<Real>& u = before.along(ax);
        const auto viscous = [&](int cell) {
            const auto compression = [&](int at) {
                const int inside = std::clamp(at, 0, ax.along() - 1) == at ? at : cell;
                return u[ax.face(inside, b)] - u[ax.face(inside + 1, b)];
            };
            const Real explained = Real(3) * std::min(compression(cell - 1), compression(cell + 1));
            const Axis other = axis(!ax.is_y); // what turns there is no shock
            const Field<Real>& v = before.along(other);
            const Real turns = std::max(v[other.face(b + 1, cell)] - v[other.face(b, cell)], Real(0));
            const Real rest = std::max(compression(cell) - turns - std::max(explained, Real(0)), Real(0));
            const Real depth = pure_predicted[ax.cell(cell, b)];
            const Real waves = P.shock_viscosity * std::sqrt(P.gravity * depth);
            const Real number = std::min(P.k * std::min(waves, Real(12) * rest), Real(0.12));
            const std::size_t W = ax.face(cell, b);
            const std::size_t E = ax.face(cell + 1, b);
            const Field<Real>& moved = pure_flux.along(ax);
            const bool from_west = std::abs(u[W]) >= std::abs(u[E]);
            const std::size_t fast = from_west ? W : E;
            const std::size_t slow = from_west ? E : W;
            Real carried = std::abs(moved[fast]);
            if (u[fast] != Real(0)) { // from three quarters of its speed on the other face counts, too
                const Real nearly = std::max(Real(1) - Real(4) * (Real(1) - std::abs(u[slow] / u[fast])), Real(0));
                carried = std::lerp(carried, std::max(carried, std::abs(moved[slow])), nearly);
            }
            return -std::min(number * depth, Real(4) * carried) * rest;
        };
        const Real depth = mean(pure_predicted[ax.cell(a - 1, b)], pure_predicted[ax.cell(a, b)]);
        if (depth > P.eps) pure_velocity.along(ax)[ax.face(a, b)] += (viscous(a) - viscous(a - 1)) / depth;
    });
}

template <class Real> void Solver<Real>::integrate_water_velocity() {
    const Faces<Real> before = pure_velocity;
    const Faces<Real> mixed_old = mixed_velocity;
    advect(EFFECT_SECOND_ORDER_WATER, pure_predicted, pure_flux, centered_velocity, P.k, pure_velocity);
    for_inner_faces([&](const Axis& ax, int a, int b) { // 2.9: rain brings no velocity
        const Real depth = mean(pure_predicted[ax.cell(a - 1, b)], pure_predicted[ax.cell(a, b)]);
        if (depth > Real(0) && !has(EFFECT_RAIN_MAP))
            pure_velocity.along(ax)[ax.face(a, b)] *= Real(1) - std::min(rained / depth, Real(1));
    });
    damp_shocks(before);
    if (has(EFFECT_MIXTURE)) {
        advect(EFFECT_SECOND_ORDER_WATER, mixed_predicted, mixed_flux, mixed_old, P.k, mixed_velocity);
        exchange_split(mixed_predicted, pure_predicted, mixed);
    }
    for_inner_faces([&](const Axis& ax, int a, int b) { water_face(before, mixed_old, ax, a, b); });
}

/// 2.16: half of the step's push and bed friction, and the fluxes of those velocities.
template <class Real> void Solver<Real>::center_water_velocity() {
    centered_velocity = pure_velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const std::size_t f = ax.face(a, b);
        const Real eta_L = pure_surface(L);
        const Real eta_R = pure_surface(R);
        if (blocked(pure[L], pure[R], eta_L, eta_R, P.eps)) return;
        const Real u = pure_velocity.along(ax)[f];
        const Real across = across_face(pure_velocity, ax, a, b);
        const Real push = P.k * water_gravity(std::abs(u), std::max(coupled_depth(L), coupled_depth(R))) * (eta_R - eta_L);
        const auto eta = [&](int cell) { return pure_surface(ax.cell(cell, b)); };
        const Real rise = eta_R - eta_L;
        const Real rise_low = a > 1 ? eta_L - eta(a - 2) : rise;
        const Real rise_high = a + 1 < ax.along() ? eta(a + 1) - eta_R : rise;
        if (rise == Real(0)) return;
        const Real share = minmod(minmod(rise_low, rise), rise_high) / rise;
        const Field<Real>& v = pure_velocity.along(ax);
        const auto slope = [&](Real before, Real after) { return minmod(u - before, after - u); };
        const Real across_slope = b > 0 && b + 1 < ax.across() ? slope(v[ax.face(a, b - 1)], v[ax.face(a, b + 1)]) : Real(0);
        const Real carried = P.k * (u * slope(v[ax.face(a - 1, b)], v[ax.face(a + 1, b)]) + across * across_slope);
        const Real pushed = rubbed(u - push / Real(2), across, std::hypot(u, across), P.dt / Real(2) * friction_rate(L, R));
        Real& centered = centered_velocity.along(ax)[f];
        centered += share * (pushed - u);
        pure_flux.along(ax)[f] += P.k * mean(pure[L], pure[R]) * share * (pushed - u - carried / Real(2));
    });
}

/// 2.16: heights at t = 0, velocities half a step later; nothing else of the step that is tried stays.
template <class Real> void Solver<Real>::start_water_velocity() {
    const Field<Real> water_start = water;
    const Faces<Real> pure_start = pure_velocity, mixed_start = mixed_velocity;
    const double added = water_added;
    diffuse_mixed_water();
    limit_water_outflow();
    compute_water_flux();
    integrate_water_height();
    center_water_velocity();
    integrate_water_velocity();
    for_inner_faces([&](const Axis& ax, int a, int b) {
        Real& u = pure_velocity.along(ax)[ax.face(a, b)];
        u = mean(pure_start.along(ax)[ax.face(a, b)], u);
    });
    mixed_velocity = mixed_start;
    water = water_start;
    water_added = added;
    split_water();
}

/// 2.11: sand that pure water drags along its bed.
template <class Real> Real Solver<Real>::capacity(Real speed) const {
    const Real excess = std::max(P.bed_shear * speed * speed - P.bed_threshold, Real(0));
    return P.bed_rate * std::pow(excess, Real(1.5));
}

template <class Real> void Solver<Real>::compute_bed_load() {
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        Real& q = bed_load.along(ax)[ax.face(a, b)];
        q = Real(0);
        if (pure[L] <= P.eps || pure[R] <= P.eps) return;
        const Real u = pure_velocity.along(ax)[ax.face(a, b)];
        const Real v = across_face(pure_velocity, ax, a, b);
        const Real speed = std::sqrt(u * u + v * v);
        const Real moved = capacity(speed);
        const Real rise = (terrain[R] + sand[R]) - (terrain[L] + sand[L]);
        if (speed > Real(0)) q = moved * u / speed;
        q -= std::min(Real(2) / P.dx * moved, Real(0.2) / P.k) * rise;
    });
}

/// 2.7: low-passed saturation. Offsets are summed in classes that mirroring and transposing leave unchanged.
template <class Real> void Solver<Real>::compute_saturation() {
    const Axis x = axis(false);
    const int radius = P.smoothing;
    for (int j = 0; j < x.ny; ++j) {
        for (int i = 0; i < x.nx; ++i) {
            Real numerator(0);
            Real denominator(0);
            // The value that cell (i + di, j + dj) adds: to the numerator d, to the denominator d + hs.
            const auto term = [&](int di, int dj, bool top) {
                const int ii = i + di;
                const int jj = j + dj;
                if (ii < 0 || jj < 0 || ii >= x.nx || jj >= x.ny) return Real(0);
                const std::size_t c = x.cell(ii, jj);
                if (sand[c] <= P.eps) return Real(0);
                return top ? standing(c) : standing(c) + sand[c];
            };
            const auto add = [&](bool top, Real& sum) {
                for (int p = 0; p <= radius; ++p) {
                    for (int q = 0; q <= p; ++q) {
                        const Real weight = static_cast<Real>((radius + 1 - p) * (radius + 1 - q));
                        const auto pair = [&](int di, int dj) { return term(di, dj, top) + term(-di, -dj, top); };
                        Real value(0);
                        if (p == 0)
                            value = term(0, 0, top);
                        else if (q == 0)
                            value = pair(p, 0) + pair(0, p);
                        else if (q == p)
                            value = pair(p, p) + pair(-p, p);
                        else
                            value = (pair(p, q) + pair(-p, q)) + (pair(q, p) + pair(-q, p));
                        sum += weight * value;
                    }
                }
            };
            add(true, numerator);
            add(false, denominator);
            saturation[x.cell(i, j)] = denominator > Real(0) ? numerator / denominator : Real(0);
        }
    }
}

} // namespace wadi::reference
