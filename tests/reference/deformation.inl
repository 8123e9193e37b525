// The sand's left stretch V and its stress: advection (2.5), Cayley update (2.6), projection (2.7).
#pragma once
#include "tests/reference/transport.inl"
#include <array>
#include <limits>

namespace wadi::reference {

/// 2.5: V moves with the sand's mass fluxes; a cell without sand holds the identity.
template <class Real> void Solver<Real>::advect_stretch() {
    const Axis x = axis(false);
    const Axis y = axis(true);
    const Real whole_turn = static_cast<Real>(2 * 3.14159265358979323846);
    for (Field<Real>* component : {&Vxx, &Vxy, &Vyy, &rotation}) {
        const Field<Real> old = *component;
        const Real identity = component == &Vxx || component == &Vyy ? Real(1) : Real(0);
        const bool angle = component == &rotation && !has(EFFECT_DIRECT_STRAIN); // differences the shorter way round
        for (int j = 0; j < x.ny; ++j) {
            for (int i = 0; i < x.nx; ++i) {
                const std::size_t c = x.cell(i, j);
                if (!(sand[c] > Real(1e-30))) {
                    (*component)[c] = identity;
                    continue;
                }
                // What face (a, b) lets into this cell from its neighbour, sign +1 where the axis points into the cell.
                const auto inflow = [&](const Axis& ax, int a, int b, Real sign, int neighbour) {
                    const Real in = std::max(sign * sand_flux.along(ax)[ax.face(a, b)], Real(0));
                    if (neighbour < 0 || neighbour >= ax.along()) return Real(0);
                    const Real difference = old[ax.cell(neighbour, b)] - old[c];
                    return in * (angle ? std::remainder(difference, whole_turn) : difference);
                };
                const Real along_x = inflow(x, i, j, Real(1), i - 1) + inflow(x, i + 1, j, Real(-1), i + 1);
                const Real along_y = inflow(y, j, i, Real(1), j - 1) + inflow(y, j + 1, i, Real(-1), j + 1);
                const Real moved = old[c] + (along_x + along_y) / sand[c];
                (*component)[c] = angle ? std::remainder(moved, whole_turn) : moved;
            }
        }
    }
}

/// Substep times the velocity gradient of a cell (xx, xy, yx, yy) by the rules of 2.6, wet cells being those of `depth`.
template <class Real> std::array<Real, 4> Solver<Real>::velocity_gradient(const Field<Real>& depth, int i, int j) const {
    const Axis x = axis(false);
    const bool beyond = has(EFFECT_PUBLISHED); // 2.22: velocities go on beyond the rim
    const Faces<Real>& velocity = beyond ? extrapolated : sand_velocity;
    // d(velocity along ax)/d(across ax), times the substep; `known` is false where no neighbour across is wet.
    const auto shear_rate = [&](const Axis& ax, int a, int b, bool& known) {
        const Field<Real>& u = velocity.along(ax);
        const auto average = [&](int row) { return mean(u[ax.face(a, row)], u[ax.face(a + 1, row)]); };
        const bool below = b > 0 && (beyond || depth[ax.cell(a, b - 1)] > P.eps);
        const bool above = b + 1 < ax.across() && (beyond || depth[ax.cell(a, b + 1)] > P.eps);
        known = below || above;
        if (below && above) return (average(b + 1) - average(b - 1)) * P.k_sand / Real(2);
        if (above) return (average(b + 1) - average(b)) * P.k_sand;
        if (below) return (average(b) - average(b - 1)) * P.k_sand;
        return Real(0);
    };
    const auto stretch_rate = [&](const Axis& ax, int a, int b) {
        const Field<Real>& u = velocity.along(ax);
        return (u[ax.face(a + 1, b)] - u[ax.face(a, b)]) * P.k_sand;
    };
    bool xy_known = false;
    bool yx_known = false;
    Real Gxy = shear_rate(x, i, j, xy_known);
    Real Gyx = shear_rate(axis(true), j, i, yx_known);
    if (!xy_known && yx_known) Gxy = -Gyx;
    if (!yx_known && xy_known) Gyx = -Gxy;
    const auto limited = [&](Real G) { return P.gradient_clamp > Real(0) ? clamped(G, P.gradient_clamp) : G; };
    return {limited(stretch_rate(x, i, j)), limited(Gxy), limited(Gyx), limited(stretch_rate(axis(true), j, i))};
}

/// 2.6 on one cell: Cayley step with the gradient of the velocities before this substep, then the left stretch.
template <class Real> void Solver<Real>::stretch_by_velocity_gradient(int i, int j) {
    const std::size_t c = axis(false).cell(i, j);
    if (sand_before[c] <= P.eps) return;
    const auto [Gxx, Gxy, Gyx, Gyy] = velocity_gradient(sand_before, i, j);
    const Real a = Gxx / Real(2);
    const Real b = Gxy / Real(2);
    const Real d = Gyx / Real(2);
    const Real e = Gyy / Real(2);

    // A = (I - G/2)^-1 (I + G/2) with G/2 = (a b; d e).
    const Real det = (Real(1) - a) * (Real(1) - e) - b * d;
    const Real A00 = ((Real(1) + a) * (Real(1) - e) + b * d) / det;
    const Real A11 = ((Real(1) - a) * (Real(1) + e) + b * d) / det;
    const Real A01 = Real(2) * b / det;
    const Real A10 = Real(2) * d / det;
    const Real N00 = A00 * Vxx[c] + A01 * Vxy[c];
    const Real N01 = A00 * Vxy[c] + A01 * Vyy[c];
    const Real N10 = A10 * Vxx[c] + A11 * Vxy[c];
    const Real N11 = A10 * Vxy[c] + A11 * Vyy[c];
    const Real px = N00 + N11;
    const Real py = N10 - N01;
    const Real n = std::hypot(px, py);
    const Real cs = n > Real(0) ? px / n : Real(1);
    const Real sn = n > Real(0) ? py / n : Real(0);
    Vxx[c] = N00 * cs - N01 * sn;
    Vyy[c] = N10 * sn + N11 * cs;
    Vxy[c] = mean(N00 * sn + N01 * cs, N10 * cs - N11 * sn);
}

template <class Real> void Solver<Real>::evolve_deformation_gradient() {
    advect_stretch();
    const Axis x = axis(false);
    for (int j = 0; j < x.ny; ++j)
        for (int i = 0; i < x.nx; ++i) stretch_by_velocity_gradient(i, j);
}

template <class Real> void Solver<Real>::advect_deformation_gradient() { advect_stretch(); }

/// 2.13: F + G F on every wet cell; for `polar` in the frame of R, so that F = R P becomes R (I + R^T G R) P.
template <class Real> void Solver<Real>::stretch_deformation_gradient() {
    const Axis x = axis(false);
    for (int j = 0; j < x.ny; ++j) {
        for (int i = 0; i < x.nx; ++i) {
            const std::size_t c = x.cell(i, j);
            if (sand[c] <= P.eps) continue;
            auto [Gxx, Gxy, Gyx, Gyy] = velocity_gradient(sand, i, j);
            const bool direct = has(EFFECT_DIRECT_STRAIN);
            const Real Fxy = Vxy[c] - (direct ? rotation[c] : Real(0));
            const Real Fyx = Vxy[c] + (direct ? rotation[c] : Real(0));
            if (!direct) {
                const Real cs = std::cos(rotation[c]);
                const Real sn = std::sin(rotation[c]);
                const Real A = cs * Gxx + sn * Gyx; // R^T G
                const Real B = cs * Gxy + sn * Gyy;
                const Real C = cs * Gyx - sn * Gxx;
                const Real D = cs * Gyy - sn * Gxy;
                Gxx = A * cs + B * sn;
                Gxy = B * cs - A * sn;
                Gyx = C * cs + D * sn;
                Gyy = D * cs - C * sn;
            }
            const Real N00 = Vxx[c] + (Gxx * Vxx[c] + Gxy * Fyx);
            const Real N01 = Fxy + (Gxx * Fxy + Gxy * Vyy[c]);
            const Real N10 = Fyx + (Gyx * Vxx[c] + Gyy * Fyx);
            const Real N11 = Vyy[c] + (Gyx * Fxy + Gyy * Vyy[c]);
            if (direct) {
                Vxx[c] = N00;
                Vyy[c] = N11;
                Vxy[c] = mean(N01, N10);
                rotation[c] = (N10 - N01) / Real(2);
                continue;
            }
            const Real turn = std::atan2(N10 - N01, N00 + N11);
            const Real cs = std::cos(turn);
            const Real sn = std::sin(turn);
            Vxx[c] = cs * N00 + sn * N10;
            Vyy[c] = cs * N11 - sn * N01;
            Vxy[c] = mean(cs * N01 + sn * N11, cs * N10 - sn * N00);
            rotation[c] = std::remainder(rotation[c] + turn, static_cast<Real>(2 * 3.14159265358979323846));
        }
    }
}

/// 2.7: how far a cell is pressed together at most [Pa], with 2.18 the share k of it.
template <class Real> Real Solver<Real>::least_stress(Real depth, Real coh, Real k) const {
    const Real weight =
        P.passive_pressure > Real(0) ? P.passive_pressure * P.rho_s * P.gravity * depth : std::numeric_limits<Real>::infinity();
    if (!has(EFFECT_SLOPE_NORMAL)) return weight + coh / P.yield_friction;
    return k > Real(0) ? k * (weight + coh / P.yield_friction) : Real(0);
}

template <class Real> void Solver<Real>::project_deformation_gradient() {
    const Real lm = P.lambda + P.shear;
    const Axis x = axis(false);
    const Axis y_axis = axis(true);
    for (std::size_t c = 0; c < cells(); ++c) {
        sxx[c] = sxy[c] = syy[c] = cohesive_share[c] = Real(0);
        const Real phi = has(EFFECT_COHESION) ? saturation[c] : Real(0);
        const Real coh = cohesion(phi, sand[c]);
        const Real whole = cohesion(phi, std::numeric_limits<Real>::infinity());
        const Real cliff = P.yield_friction * P.rho_s * P.gravity * sand[c];
        if (sand[c] <= P.eps) continue;
        if (cliff > Real(0)) cohesive_share[c] = std::min(Real(1e6), Real(4) * whole / cliff);
        const Real compression = least_stress(sand[c], coh, stressed(cohesive_share[c]));
        // Logarithmic strain of V from b = V V^T, without angles.
        const Real bxx = Vxx[c] * Vxx[c] + Vxy[c] * Vxy[c];
        const Real byy = Vxy[c] * Vxy[c] + Vyy[c] * Vyy[c];
        const Real bxy = Vxy[c] * (Vxx[c] + Vyy[c]);
        const Real det = Vxx[c] * Vyy[c] - Vxy[c] * Vxy[c];
        const Real d = mean(bxx, -byy);
        const Real radius = std::hypot(d, bxy);
        const Real l1 = mean(bxx, byy) + radius;
        const Real l2 = det * det / l1;
        Real tr(0), dd(0), dxy(0);
        const Real sum = Vxx[c] + Vyy[c];
        if (det > Real(1e-6) && sum > Real(0) && sum < Real(1000)) { // otherwise V starts again from the identity
            const Real e1 = clamped(std::log(l1) / Real(2), Real(0.5));
            const Real e2 = clamped(std::log(l2) / Real(2), Real(0.5));
            tr = e1 + e2;
            if (radius > Real(0)) {
                dd = (e1 - e2) / Real(2) * d / radius;
                dxy = (e1 - e2) / Real(2) * bxy / radius;
            }
        }
        // Compression cap, tip and cone of the yield surface.
        tr = std::max(tr, -compression / lm);
        const Real A = P.yield_friction * Real(2) * lm;
        const Real y = A * tr - coh;
        if (y >= Real(0)) {
            tr = coh / A;
            dd = dxy = Real(0);
        } else {
            const Real limit = -y / (Real(2) * P.shear);
            const Real size = std::sqrt(Real(2) * (dd * dd + dxy * dxy));
            if (size > limit) {
                dd *= limit / size;
                dxy *= limit / size;
            }
        }
        const Real hd = std::hypot(dd, dxy);
        const Real E = std::exp(tr / Real(2));
        const Real shape = hd > Real(0) ? std::sinh(hd) / hd : Real(1);
        Vxx[c] = E * (std::cosh(hd) + shape * dd);
        Vyy[c] = E * (std::cosh(hd) - shape * dd);
        Vxy[c] = E * shape * dxy;
        // Cauchy stress.
        const Real per_J = std::exp(-tr);
        sxx[c] = (lm * tr + Real(2) * P.shear * dd) * per_J;
        syy[c] = (lm * tr - Real(2) * P.shear * dd) * per_J;
        sxy[c] = Real(2) * P.shear * dxy * per_J;
        // Bulk viscosity, which takes the mean stress no further than yield does.
        const int i = static_cast<int>(c) % x.nx;
        const int j = static_cast<int>(c) / x.nx;
        const Real divergence = (sand_velocity.x[x.face(i + 1, j)] - sand_velocity.x[x.face(i, j)] +
                                 sand_velocity.y[y_axis.face(j + 1, i)] - sand_velocity.y[y_axis.face(j, i)]) /
                                P.dx;
        const Real before = mean(sxx[c], syy[c]);
        Real after = std::min(before + P.viscosity * divergence, std::max(before, coh / (Real(2) * P.yield_friction)));
        after = std::max(after, std::min(before, -compression));
        sxx[c] += after - before;
        syy[c] += after - before;
    }
}

} // namespace wadi::reference
