// Semi-Lagrangian transport of velocities (2.12): boundary types, extrapolation, backtrace.
#pragma once
#include "tests/reference/transport.inl"

namespace wadi::reference {

template <class Real>
template <class Height, class Surface>
void Solver<Real>::update_types(Height height, Surface surface, Faces<Real>& type) const {
    for (const bool is_y : {false, true}) {
        Field<Real>& types = type.along(axis(is_y));
        std::fill(types.begin(), types.end(), Real(2)); // the rim stays fixed
    }
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        Real kind(0);
        if (height(L) > P.eps || height(R) > P.eps)
            kind = blocked(height(L), height(R), surface(L), surface(R), P.eps) ? Real(2) : Real(1);
        type.along(ax)[ax.face(a, b)] = kind;
    });
}

template <class Real> void Solver<Real>::update_water_boundary_types() {
    for (std::size_t c = 0; has(EFFECT_DIFFUSION) && c < cells(); ++c) { // 2.21: h_m may pass hs until the split is taken anew
        mixed[c] = mixed_diffused[c];
        pure[c] = water[c] - mixed_diffused[c];
    }
    const auto eta = [&](std::size_t c) { return terrain[c] + water[c]; };
    update_types([&](std::size_t c) { return pure[c]; }, eta, pure_type);
    if (has(EFFECT_MIXTURE)) update_types([&](std::size_t c) { return mixed[c]; }, eta, mixed_type);
}

template <class Real> void Solver<Real>::update_sand_boundary_types() {
    const auto load = [&](std::size_t c) {
        return terrain[c] + sand[c] + P.rho_w / P.rho_s * (water[c] - std::min(water[c], sand[c]));
    };
    update_types([&](std::size_t c) { return sand[c]; }, load, sand_type);
}

/// Untracked faces take the mean of the tracked ones among the 3x3 faces around; opposite ones are summed first.
template <class Real> void Solver<Real>::extrapolate(const Faces<Real>& velocity, const Faces<Real>& type) {
    extrapolated = velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t f = ax.face(a, b);
        if (type.along(ax)[f] != Real(0)) return;
        Real count(0);
        const auto lent = [&](int da, int db) {
            if (b + db < 0 || b + db >= ax.across()) return Real(0);
            const std::size_t other = ax.face(a + da, b + db);
            if (type.along(ax)[other] != Real(1)) return Real(0);
            count += Real(1);
            return velocity.along(ax)[other];
        };
        const auto pair = [&](int da, int db) { return lent(da, db) + lent(-da, -db); };
        const Real sum = (pair(-1, 0) + pair(0, -1)) + (pair(-1, -1) + pair(1, -1));
        extrapolated.along(ax)[f] = count > Real(0) ? sum / count : Real(0);
    });
}

/// Bilinear value where the flow through each face comes from, at most one cell away; rows beyond the sides repeat the last one.
template <class Real> void Solver<Real>::backtrace(const Faces<Real>& type, Real k, Faces<Real>& velocity) const {
    velocity = extrapolated;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        if (type.along(ax)[ax.face(a, b)] == Real(2)) return;
        const Field<Real>& u = extrapolated.along(ax);
        const Field<Real>& v = extrapolated.across(ax);
        const Real cross =
            ((v[ax.cross(a - 1, b)] + v[ax.cross(a - 1, b + 1)]) + (v[ax.cross(a, b)] + v[ax.cross(a, b + 1)])) / Real(4);
        const Real own = u[ax.face(a, b)];
        const Real da = clamped(k * own, Real(1));
        const Real db = clamped(k * cross, Real(1));
        const auto row = [&](int r) {
            const int inside = std::clamp(r, 0, ax.across() - 1);
            const Real side = u[ax.face(da > Real(0) ? a - 1 : a + 1, inside)];
            const Real middle = u[ax.face(a, inside)];
            return middle + std::abs(da) * (side - middle);
        };
        const Real here = row(b);
        velocity.along(ax)[ax.face(a, b)] = here + std::abs(db) * (row(db > Real(0) ? b - 1 : b + 1) - here);
    });
}

template <class Real> void Solver<Real>::extrapolate_pure_velocity() { extrapolate(pure_velocity, pure_type); }
template <class Real> void Solver<Real>::backtrace_pure_velocity() { backtrace(pure_type, P.k, pure_velocity); }

template <class Real> void Solver<Real>::transport_mixed_velocity() {
    extrapolate(mixed_velocity, mixed_type);
    backtrace(mixed_type, P.k, mixed_velocity);
}

template <class Real> void Solver<Real>::extrapolate_sand_velocity() { extrapolate(sand_velocity, sand_type); }
template <class Real> void Solver<Real>::backtrace_sand_velocity() { backtrace(sand_type, P.k_sand, sand_velocity); }

} // namespace wadi::reference
