// Sand that flows round bends of the ground (2.3) and up to where its head takes it (2.4c), wedges that slide as a whole (2.18).
#pragma once
#include "tests/reference/transport.inl"
#include <algorithm>

namespace wadi::reference {

/// Velocity and ground at a face, outer ones included: beyond the grid the ground goes on level and nothing moves.
template <class Real> auto Solver<Real>::course_at(const Faces<Real>& velocity, const Axis& ax, int a, int b) const -> Course {
    const auto ground = [&](int along, int across) {
        return terrain[ax.cell(std::clamp(along, 0, ax.along() - 1), std::clamp(across, 0, ax.across() - 1))];
    };
    const auto beside = [&](int along, int row) {
        return along < 0 || along >= ax.along() ? Real(0) : velocity.across(ax)[ax.cross(along, row)];
    };
    Course c;
    c.u = velocity.along(ax)[ax.face(a, b)];
    c.w = ((beside(a - 1, b) + beside(a - 1, b + 1)) + (beside(a, b) + beside(a, b + 1))) / Real(4);
    c.a = (ground(a, b) - ground(a - 1, b)) / P.dx;
    Real rises(0);
    int count = 0;
    for (const int row : {b, b + 1}) // rises from row - 1 to row
        if (row > 0 && row < ax.across()) {
            rises += (ground(a - 1, row) - ground(a - 1, row - 1)) + (ground(a, row) - ground(a, row - 1));
            count += 2;
        }
    c.e = count > 0 ? rises / (Real(count) * P.dx) : Real(0);
    return c;
}

/// 2.3: what flows in keeps its speed along the bed.
template <class Real> void Solver<Real>::bend_sand_velocity() {
    const Faces<Real>& old = sand_velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t f = ax.face(a, b);
        bend_gain.along(ax)[f] = bed_lift.along(ax)[f] = Real(0);
        const Real hb = mean(sand[ax.cell(a - 1, b)], sand[ax.cell(a, b)]);
        if (hb <= P.film / Real(2)) return;
        const Course own = course_at(old, ax, a, b);
        const Real n = Real(1) + own.a * own.a + own.e * own.e;
        struct Sums {
            Real U, W, Z, S; // of Q with u, w, a u + e w, |u| + |w|
        };
        const auto side = [&](Real Q, const Course& from) {
            if (Q <= Real(0)) return Sums{Real(0), Real(0), Real(0), Real(0)};
            return Sums{Q * from.u, Q * from.w, Q * (from.a * from.u + from.e * from.w),
                        Q * (std::abs(from.u) + std::abs(from.w))};
        };
        const auto sum = [](const Sums& one, const Sums& other) {
            return Sums{one.U + other.U, one.W + other.W, one.Z + other.Z, one.S + other.S};
        };
        const Field<Real>& along = sand_flux.along(ax);
        const Field<Real>& across = sand_flux.across(ax);
        const Sums low = side(mean(along[ax.face(a - 1, b)], along[f]), course_at(old, ax, a - 1, b));
        const Sums high = side(-mean(along[f], along[ax.face(a + 1, b)]), course_at(old, ax, a + 1, b));
        const Real Q_S = b > 0 ? mean(across[ax.cross(a - 1, b)], across[ax.cross(a, b)]) : Real(0);
        const Real Q_N = b + 1 < ax.across() ? mean(across[ax.cross(a - 1, b + 1)], across[ax.cross(a, b + 1)]) : Real(0);
        const Sums left = side(Q_S, course_at(old, ax, a, b > 0 ? b - 1 : b));
        const Sums right = side(-Q_N, course_at(old, ax, a, b + 1 < ax.across() ? b + 1 : b));
        const auto [U, W, Z, S] = sum(sum(low, high), sum(left, right)); // in pairs: mirrored scenes have mirrored bits
        const Real D = Z - (own.a * U + own.e * W);
        const Real V2 = U * U + W * W + Z * Z;
        if (D * D <= Real(1e-9) * n * V2 || V2 <= Real(1e-24) * hb * hb) return;
        const Real x = D * D / (n * V2);
        const Real turned = (U + own.a * D / n) / std::sqrt(std::max(x, Real(1) - x)) - U;
        const Real acceleration = -D / (hb * P.substep);
        const Real follows = acceleration < -P.gravity ? P.gravity / -acceleration : Real(1);
        bend_gain.along(ax)[f] = follows * turned / hb;
        bed_lift.along(ax)[f] = -std::clamp(D, -S, S) / (hb * P.substep);
    });
}

/// 2.8: friction mu of thickness and speed in place of that of deep sand at rest, as gravity that presses by their ratio.
template <class Real> void Solver<Real>::raise_friction() {
    const Faces<Real>& old = sand_velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b);
        const std::size_t R = ax.cell(a, b);
        const Real hb = mean(sand[L], sand[R]);
        if (hb <= P.film / Real(2) || P.friction <= Real(0)) return;
        const Course at = course_at(old, ax, a, b);
        const Real climb = at.a * at.u + at.e * at.w;
        const Real speed = std::sqrt(at.u * at.u + at.w * at.w + climb * climb);
        const Real cosine = Real(1) / std::sqrt(Real(1) + at.a * at.a + at.e * at.e);
        const Real wave = std::sqrt(P.gravity * hb) * cosine;
        // mu = mu_1 + (mu_2 - mu_1)/(1 + beta h/(L (Fr + gamma))), times the wave's speed above and below
        const Real runs = P.flow_length * (speed + P.flow_gamma * wave);
        const Real sum = runs + P.flow_beta * hb * cosine * wave;
        const Real mu = P.friction + (sum > Real(0) ? (P.fast_friction - P.friction) * runs / sum : Real(0));
        Real& lift = bed_lift.along(ax)[ax.face(a, b)];
        lift += std::max(sand_gravity(std::max(sand[L], sand[R])) + lift, Real(0)) * (mu / P.friction - Real(1));
    });
}

/// 2.4c for sand with a head: whether a face with the velocity u so far must stand.
template <class Real> bool Solver<Real>::beyond_head(const Faces<Real>& old, const Axis& ax, int a, int b, Real u) const {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const std::size_t donor = u > Real(0) ? L : R;
    const std::size_t other = u > Real(0) ? R : L;
    const Real rise = (terrain[other] + sand[other]) - (terrain[donor] + sand[donor]);
    if (sand[donor] <= P.film) return sand[other] <= P.film || rise <= Real(0);
    if (sand[other] > P.film) return false;
    const Course at = course_at(old, ax, a, b);
    const Real climb = at.a * u + at.e * at.w;
    const Real head = u * u + at.w * at.w + climb * climb; // times 2 g
    return head <= Real(2) * P.gravity * rise;
}

/// 2.18: omega, the share of a face's sand above the failing plane.
template <class Real> Real Solver<Real>::wedge_share(std::size_t L, std::size_t R) const {
    const Real hb = mean(sand[L], sand[R]);
    return hb > Real(0) ? std::min(Real(1), mean(wedge_depth[L], wedge_depth[R]) / hb) : Real(0);
}

/// 2.18: what the push of a face lacks so that the wedge above the failing plane slides, as a fall [m], of sand that weighs 1.
template <class Real> Real Solver<Real>::wedge_push(const Axis& ax, int a, int b, const Slope& slope, Real own) const {
    const std::size_t L = ax.cell(a - 1, b);
    const std::size_t R = ax.cell(a, b);
    const Real omega = wedge_share(L, R);
    if (omega <= Real(0) || slope.q >= P.plane * P.plane) return Real(0);
    const Real fall = slope.d - (wedge_depth[R] - wedge_depth[L]); // of the plane
    const Real part = std::clamp(fall / (P.plane * P.dx), Real(-1), Real(1));
    const Real plane = (P.plane - P.friction) / (Real(1) + P.chi * P.plane * P.plane);
    const Real due = (P.friction * slope.C + omega * plane) * P.dx * part;
    if (due > Real(0)) return std::max(due - own, Real(0));
    if (due < Real(0)) return std::min(due - own, Real(0));
    return Real(0);
}

/// 2.18: the failing plane, from that of the neighbours before -> wedge_depth.
template <class Real> void Solver<Real>::raise_failing_planes() {
    const Field<Real> before = wedge_depth;
    const Axis x = axis(false);
    for (int j = 0; j < x.ny; ++j)
        for (int i = 0; i < x.nx; ++i) {
            const std::size_t c = x.cell(i, j);
            const Real top = terrain[c] + sand[c];
            Real z = top;
            for (int dj = -1; dj <= 1; ++dj)
                for (int di = -1; di <= 1; ++di) {
                    if ((di == 0 && dj == 0) || i + di < 0 || i + di >= x.nx || j + dj < 0 || j + dj >= x.ny) continue;
                    const std::size_t n = x.cell(i + di, j + dj);
                    const Real distance = di != 0 && dj != 0 ? std::sqrt(Real(2)) * P.dx : P.dx;
                    z = std::min(z, terrain[n] + sand[n] - before[n] + P.plane * distance);
                }
            z = std::max(z, terrain[c]);
            const Real held = has(EFFECT_ELASTOPLASTIC) ? std::min(Real(4) * cohesive_share[c], Real(1)) : Real(0);
            const bool rounding = top - z <= Real(1e-6) * std::abs(top);
            wedge_depth[c] = rounding ? Real(0) : (Real(1) - held) * (top - z);
        }
}

} // namespace wadi::reference
