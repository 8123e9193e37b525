// Transport that every layer shares: outflow limiter, upwind flux (2.2) and momentum advection (2.3).
#pragma once
#include "shaders/effects.h"
#include "tests/reference/pores.inl"
#include "tests/reference/rules.hpp"
#include "tests/reference/solver.hpp"
#include <limits>

namespace wadi::reference {

template <class Real> template <class F> void Solver<Real>::for_inner_faces(F f) const {
    for (const bool is_y : {false, true}) {
        const Axis ax = axis(is_y);
        for (int b = 0; b < ax.across(); ++b)
            for (int a = 1; a < ax.along(); ++a) f(ax, a, b);
    }
}

template <class Real> Real Solver<Real>::across_face(const Faces<Real>& velocity, const Axis& ax, int a, int b) const {
    const Field<Real>& v = velocity.across(ax);
    return ((v[ax.cross(a - 1, b)] + v[ax.cross(a - 1, b + 1)]) + (v[ax.cross(a, b)] + v[ax.cross(a, b + 1)])) / Real(4);
}

template <class Real> const Faces<Real>& Solver<Real>::velocity_of(Layer layer) const {
    return layer == Layer::pure ? pure_velocity : layer == Layer::mixed ? mixed_velocity : sand_velocity;
}

/// 2.16: depth that the donor of face (a, b) sends through it; only the pure layer reaches beyond the rim, by one cell.
template <class Real> Real Solver<Real>::face_depth(Layer layer, const Axis& ax, int a, int b, Real u) const {
    const int down = u > Real(0) ? 1 : -1;
    const int donor = u > Real(0) ? a - 1 : a;
    struct Column {
        Real depth, surface;
    };
    const auto at = [&](int cell) {
        if (cell >= 0 && cell < ax.along()) {
            const std::size_t c = ax.cell(cell, b);
            if (layer == Layer::sand) return Column{sand[c], terrain[c] + sand[c]};
            if (layer == Layer::pure) return Column{pure[c], pure[c]};
            return Column{mixed[c], P.porosity * (terrain[c] + transport_depth(c))};
        }
        const bool next = layer == Layer::pure && (cell == -1 || cell == ax.along());
        const Real outside = next ? ghost_water.along(ax)[ax.face(cell == -1 ? 0 : cell, b)] : Real(0);
        return Column{outside, terrain[ax.cell(std::clamp(cell, 0, ax.along() - 1), b)] + outside};
    };
    const Column before = at(donor - down), own = at(donor), after = at(donor + down);
    if (std::min({before.depth, own.depth, after.depth}) <= P.eps) return own.depth;
    const auto rise = [&](const Column& from, const Column& to) {
        const Real deeper = to.depth - from.depth;
        return layer == Layer::pure ? deeper : minmod(deeper, to.surface - from.surface);
    };
    const Real k = layer == Layer::sand ? P.k_sand : P.k;
    const Real courant = std::min(Real(1), k * std::abs(u));
    const Field<Real>& velocity = velocity_of(layer).along(ax);
    const Real growth = velocity[ax.face(donor + 1, b)] - velocity[ax.face(donor, b)];
    const Real thinned = own.depth * std::clamp(k * growth, Real(-1), Real(1));
    return own.depth + ((Real(1) - courant) * minmod(rise(before, own), rise(own, after)) - thinned) / Real(2);
}

/// Raw upwind flux q [m2/s] of a layer, diffusion included. Outside an open side only the pure layer has depth.
template <class Real> Real Solver<Real>::raw_flux(Layer layer, const Axis& ax, int a, int b) const {
    const bool rim = a == 0 || a == ax.along();
    if (rim && !has(EFFECT_OPEN_SIDES)) return Real(0);
    const Field<Real>& h = layer == Layer::pure ? pure : layer == Layer::mixed ? mixed : sand;
    const std::size_t face = ax.face(a, b);
    const Real outside = layer == Layer::pure ? ghost_water.along(ax)[face] : Real(0);
    const Real h_left = a > 0 ? h[ax.cell(a - 1, b)] : outside;
    const Real h_right = a < ax.along() ? h[ax.cell(a, b)] : outside;
    const Real u = velocity_of(layer).along(ax)[face];
    Real q = std::max(u, Real(0)) * h_left + std::min(u, Real(0)) * h_right;
    if (has(layer == Layer::sand ? EFFECT_SECOND_ORDER_SAND : EFFECT_SECOND_ORDER_WATER)) q = u * face_depth(layer, ax, a, b, u);
    if (layer == Layer::mixed && has(EFFECT_DIFFUSION)) q += diffusion_flux.along(ax)[face];
    if (layer == Layer::sand && has(EFFECT_BED_SHEAR)) q += bed_load.along(ax)[face];
    return q;
}

/// 2.2: the fractional part of the step's number times the golden ratio's, in 32 and then 24 bits. Sand is rounded by it only
/// where bed load runs.
template <class Real> Real Solver<Real>::rounding_phase(Layer layer, const Axis& ax, std::size_t face) const {
    if (has(EFFECT_PUBLISHED)) return Real(0);
    if (layer == Layer::sand && (!has(EFFECT_BED_SHEAR) || bed_load.along(ax)[face] == Real(0))) return Real(0);
    const double turns = static_cast<double>(std::uint32_t(step_index)) * 2654435769.0;
    const double part = std::fmod(turns, 4294967296.0);
    return static_cast<Real>(std::floor(part / 256.0) / 16777216.0);
}

template <class Real> void Solver<Real>::limit_outflow(Layer layer, Real k, Field<Real>& scale) const {
    const Field<Real>& h = layer == Layer::pure ? pure : layer == Layer::mixed ? mixed : sand;
    const Axis x = axis(false);
    const Axis y = axis(true);
    const Real margin = Real(1) - Real(4) * std::numeric_limits<Real>::epsilon();
    for (int j = 0; j < x.ny; ++j) {
        for (int i = 0; i < x.nx; ++i) {
            const Real west = std::max(-raw_flux(layer, x, i, j), Real(0));
            const Real east = std::max(raw_flux(layer, x, i + 1, j), Real(0));
            const Real south = std::max(-raw_flux(layer, y, j, i), Real(0));
            const Real north = std::max(raw_flux(layer, y, j + 1, i), Real(0));
            const Real outflow = k * ((west + east) + (south + north));
            const std::size_t c = x.cell(i, j);
            scale[c] = !P.limiter || outflow <= h[c] ? Real(1) : h[c] / outflow * margin;
            // Where the phase would take more than there is, all four are cut toward 0; the sign says so.
            const Real phase = layer == Layer::sand && !has(EFFECT_BED_SHEAR) ? Real(0) : rounding_phase(Layer::pure, x, 0);
            Real moved(0);
            for (const Real leaves : {west, east, south, north}) moved += whole_quanta(k * leaves * scale[c], P.quantum, phase);
            if (P.quantum > Real(0) && moved > h[c]) scale[c] = -scale[c];
        }
    }
}

template <class Real> void Solver<Real>::limited_flux(Layer layer, Real k, const Field<Real>& scale, Faces<Real>& flux) const {
    for (const bool is_y : {false, true}) {
        const Axis ax = axis(is_y);
        for (int b = 0; b < ax.across(); ++b) {
            for (int a = 0; a <= ax.along(); ++a) {
                const Real q = raw_flux(layer, ax, a, b);
                Real donor(-1); // outside: as much as is meant
                if (q > Real(0) && a > 0) donor = scale[ax.cell(a - 1, b)];
                if (q < Real(0) && a < ax.along()) donor = scale[ax.cell(a, b)];
                const std::size_t face = ax.face(a, b);
                const Real phase = donor > Real(0) ? rounding_phase(layer, ax, face) : Real(0);
                flux.along(ax)[face] = whole_quanta(k * (q * std::abs(donor)), P.quantum, phase);
            }
        }
    }
}

template <class Real> Real Solver<Real>::gain(const Faces<Real>& flux, int i, int j) const {
    const Axis x = axis(false);
    const Axis y = axis(true);
    return (flux.x[x.face(i, j)] - flux.x[x.face(i + 1, j)]) + (flux.y[y.face(j, i)] - flux.y[y.face(j + 1, i)]);
}

template <class Real> Real Solver<Real>::thinnest(const Field<Real>& height) const {
    return &height == &sand ? P.film / Real(2) : P.eps;
}

/// 2.3: corners of upright banks beside a face. A corner within one of its cells is one where the cell's far face along and one
/// of its two faces across stand at 0; one beside the face, where the next face to that side and just one of the two between do.
template <class Real>
typename Solver<Real>::Corners Solver<Real>::corners(const Faces<Real>& velocity, const Axis& ax, int a, int b) const {
    const Field<Real>& u = velocity.along(ax);
    const Field<Real>& v = velocity.across(ax);
    const auto stands = [&](int cell, int row) { return v[ax.cross(cell, row)] == Real(0); };
    const auto within = [&](int cell, int far_face) {
        return u[ax.face(far_face, b)] == Real(0) && (stands(cell, b) || stands(cell, b + 1));
    };
    const auto beside = [&](int row, int between) {
        const bool outside = row < 0 || row >= ax.across();
        return (outside || u[ax.face(a, row)] == Real(0)) && stands(a - 1, between) != stands(a, between);
    };
    Corners found;
    found.within = within(a - 1, a - 1) || within(a, a + 1);
    found.south = beside(b - 1, b);
    found.north = beside(b + 1, b + 1);
    return found;
}

/// 2.3 with the layer's predicted height and its limited fluxes.
template <class Real>
void Solver<Real>::advect_velocity(const Field<Real>& height, const Faces<Real>& flux, Faces<Real>& velocity) const {
    const Faces<Real> old = velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const Real hb = mean(height[ax.cell(a - 1, b)], height[ax.cell(a, b)]);
        if (hb <= thinnest(height)) return;
        const Field<Real>& along = flux.along(ax);
        const Field<Real>& across = flux.across(ax);
        const Real Q_W = mean(along[ax.face(a - 1, b)], along[ax.face(a, b)]);
        const Real Q_E = mean(along[ax.face(a, b)], along[ax.face(a + 1, b)]);
        const Real Q_S = mean(across[ax.cross(a - 1, b)], across[ax.cross(a, b)]);
        const Real Q_N = mean(across[ax.cross(a - 1, b + 1)], across[ax.cross(a, b + 1)]);
        const Field<Real>& u_old = old.along(ax);
        const Real u = u_old[ax.face(a, b)];
        const Real u_W = u_old[ax.face(a - 1, b)];
        const Real u_E = u_old[ax.face(a + 1, b)];
        // What enters from beyond the grid has no velocity along the side.
        Real u_S = b > 0 ? u_old[ax.face(a, b - 1)] : Q_S > Real(0) ? Real(0) : u;
        Real u_N = b + 1 < ax.across() ? u_old[ax.face(a, b + 1)] : Q_N < Real(0) ? Real(0) : u;
        const Corners bank = &height == &sand ? Corners() : corners(old, ax, a, b);
        Real turned(0); // what has turned into the axis in a cell brings its speed, up to u
        const auto turn = [&](int cell, Real entering, Real near) {
            const Real gained = std::max(across[ax.cross(cell, b)] - across[ax.cross(cell, b + 1)], Real(0)) / Real(2);
            const Field<Real>& v = old.across(ax);
            const Real w = std::max(std::abs(v[ax.cross(cell, b)]), std::abs(v[ax.cross(cell, b + 1)]));
            const Real speed = std::max(w, std::abs(near)) + std::min(w, std::abs(near)) / Real(4);
            const Real most = u > Real(0) ? std::min(u, speed) : std::max(u, -speed);
            const bool slower = u > Real(0) ? near < most : u < Real(0) && near > most;
            if (slower) turned += std::min(gained, std::max(entering, Real(0))) * (most - near);
        };
        if (bank.any() && !has(EFFECT_SECOND_ORDER_WATER)) {
            turn(a - 1, Q_W, u_W);
            turn(a, -Q_E, u_E);
        }
        // Of second order blocked faces alone count as u.
        const auto counts_as_own = [&](bool beside, int row) {
            if (row < 0 || row >= ax.across()) return false;
            return has(EFFECT_SECOND_ORDER_WATER) ? bank.any() && u_old[ax.face(a, row)] == Real(0) : bank.within || beside;
        };
        if (counts_as_own(bank.south, b - 1)) u_S = u;
        if (counts_as_own(bank.north, b + 1)) u_N = u;
        const Real from_along = std::max(-Q_E, Real(0)) * (u_E - u) + std::max(Q_W, Real(0)) * (u_W - u);
        const Real from_across = std::max(-Q_N, Real(0)) * (u_N - u) + std::max(Q_S, Real(0)) * (u_S - u);
        Real& moved = velocity.along(ax)[ax.face(a, b)];
        moved = u + (from_along + from_across + turned) / hb;
        if (has(EFFECT_SECOND_ORDER_WATER) && &height != &sand) // of whose fluxes it need not be a mean
            moved = std::clamp(moved, std::min({u, u_W, u_E, u_S, u_N}), std::max({u, u_W, u_E, u_S, u_N}));
    });
}

/// 2.16 in place of 2.3.
template <class Real>
void Solver<Real>::advect_velocity_second_order(const Field<Real>& height, const Faces<Real>& flux, const Faces<Real>& carried,
                                                Real k, Faces<Real>& velocity) const {
    const Faces<Real> old = velocity;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const Real hb = mean(height[ax.cell(a - 1, b)], height[ax.cell(a, b)]);
        if (hb <= thinnest(height)) return;
        // Offsets along and across; beyond the last face or row its value again, or 0 where something comes in there.
        const auto enters = [&](int row) {
            return mean(flux.across(ax)[ax.cross(a - 1, row)], flux.across(ax)[ax.cross(a, row)]);
        };
        const auto in = [&](const Faces<Real>& from, int da, int db) {
            if (b == 0 && db < 0 && enters(b) > Real(0)) return Real(0);
            if (b + 1 == ax.across() && db > 0 && enters(b + 1) < Real(0)) return Real(0);
            return from.along(ax)[ax.face(std::clamp(a + da, 0, ax.along()), std::clamp(b + db, 0, ax.across() - 1))];
        };
        const auto at = [&](int da, int db) { return in(carried, da, db); };
        // Volume that enters (positive) through the side at offset (da, db), from the fluxes of the two cells there.
        const auto inflow = [&](int da, int db) {
            if (da != 0) return Real(-da) * mean(flux.along(ax)[ax.face(a, b)], flux.along(ax)[ax.face(a + da, b)]);
            const int row = db > 0 ? b + 1 : b;
            return Real(-db) * mean(flux.across(ax)[ax.cross(a - 1, row)], flux.across(ax)[ax.cross(a, row)]);
        };
        const Real u = at(0, 0);
        const auto gain = [&](int da, int db) {
            const Real entering = inflow(da, db);
            const auto left = [](Real courant) { return std::max(Real(0), Real(1) - courant) / Real(2); };
            const Real share = left(std::abs(entering) / hb);
            const Real neighbour = at(da, db);
            const Real theirs = da != 0 ? left(k * std::abs(neighbour)) : share;
            if (entering > Real(0))
                return entering * ((neighbour - u) + theirs * centred_slope(at(2 * da, 2 * db), neighbour, u));
            return entering * share * centred_slope(at(-da, -db), u, neighbour);
        };
        const Real moved = in(old, 0, 0) + ((gain(-1, 0) + gain(1, 0)) + (gain(0, -1) + gain(0, 1))) / hb;
        const auto around = {in(old, 0, 0), in(old, -1, 0), in(old, 1, 0), in(old, 0, -1), in(old, 0, 1)};
        velocity.along(ax)[ax.face(a, b)] = std::clamp(moved, std::min(around), std::max(around));
    });
}

/// A layer's momentum by the order that its effect chooses, of first order beside corners of banks; `carried` is what advection
/// of second order carries.
template <class Real>
void Solver<Real>::advect(std::uint32_t second_order, const Field<Real>& height, const Faces<Real>& flux,
                          const Faces<Real>& carried, Real k, Faces<Real>& velocity) const {
    if (!has(second_order)) return advect_velocity(height, flux, velocity);
    const Faces<Real> old = velocity;
    Faces<Real> at_corners = velocity;
    advect_velocity(height, flux, at_corners);
    advect_velocity_second_order(height, flux, carried, k, velocity);
    if (&height == &sand) return;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t face = ax.face(a, b);
        if (corners(old, ax, a, b).any()) velocity.along(ax)[face] = at_corners.along(ax)[face];
    });
}

} // namespace wadi::reference
