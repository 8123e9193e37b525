// Set-ups and measures that the reference solver's tests share.
#pragma once
#include "shaders/effects.h"
#include "tests/reference/solver.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wadi::reference::test {

constexpr std::uint32_t WET_SAND = EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE | EFFECT_DIFFUSION | EFFECT_DRAG;
constexpr std::uint32_t ELASTIC = EFFECT_ELASTOPLASTIC | EFFECT_COHESION;
constexpr double PI = 3.14159265358979323846;

inline std::size_t index(int i) { return static_cast<std::size_t>(i); }

inline Settings make_settings(int nx, int ny, double dx, double dt) {
    Settings s;
    s.grid = {nx, ny, dx};
    s.dt = dt;
    return s;
}

/// Quantum, gravity caps and rest rule off, alpha 0.5: the set-up of the convergence studies.
inline Settings convergence_settings(int nx, int ny, double dx) {
    Settings s = make_settings(nx, ny, dx, 1e-3);
    s.method.quantum = 0;
    s.method.velocity_clamp = 0.5;
    s.method.gravity_cap = 0;
    s.method.sand_gravity_cap = 0;
    s.method.rest_rule = false;
    return s;
}

template <class Real> double largest(const Field<Real>& field) {
    double most = 0;
    for (const Real v : field) most = std::max(most, std::abs(static_cast<double>(v)));
    return most;
}
template <class Real> double largest(const Faces<Real>& faces) { return std::max(largest(faces.x), largest(faces.y)); }

template <class Real> double sum(const Field<Real>& field) {
    double total = 0;
    for (const Real v : field) total += static_cast<double>(v);
    return total;
}

/// |value - expected| <= tolerance |expected|.
inline bool within(double value, double expected, double tolerance) {
    return std::abs(value - expected) <= tolerance * std::abs(expected);
}

/// sum|a - b| / sum|b|.
inline double relative_error(const Field<double>& a, const Field<double>& b) {
    double error = 0;
    double size = 0;
    for (std::size_t c = 0; c < a.size(); ++c) {
        error += std::abs(a[c] - b[c]);
        size += std::abs(b[c]);
    }
    return error / size;
}

/// Sets a cell field from f(x, y) at the centres.
template <class Real, class F> void fill(const Solver<Real>& s, Field<Real>& field, F f) {
    const Axis x = s.axis(false);
    const double dx = s.settings.grid.dx;
    for (int j = 0; j < x.ny; ++j)
        for (int i = 0; i < x.nx; ++i) field[x.cell(i, j)] = static_cast<Real>(f((i + 0.5) * dx, (j + 0.5) * dx));
}

/// f(axis, a, b) for every face, walls included.
template <class Real, class F> void for_all_faces(const Solver<Real>& s, F f) {
    for (const bool is_y : {false, true}) {
        const Axis ax = s.axis(is_y);
        for (int b = 0; b < ax.across(); ++b)
            for (int a = 0; a <= ax.along(); ++a) f(ax, a, b);
    }
}

/// Rounds the heights of the state to whole quanta.
template <class Real> void round_heights(Solver<Real>& s) {
    for (Field<Real>* field : {&s.terrain, &s.sand, &s.water})
        for (Real& h : *field) h = std::nearbyint(h / s.P.quantum) * s.P.quantum;
}

/// Water steps of dt = cfl dx / max(|u| + sqrt(g h)) up to time `end`.
inline void run_to(Solver<double>& s, double end, double cfl) {
    const Axis x = s.axis(false);
    const Axis y = s.axis(true);
    double now = 0;
    while (now < end * (1 - 1e-12)) {
        double fastest = 1e-9;
        for (int j = 0; j < x.ny; ++j)
            for (int i = 0; i < x.nx; ++i) {
                const double u =
                    std::max(std::abs(s.pure_velocity.x[x.face(i, j)]), std::abs(s.pure_velocity.x[x.face(i + 1, j)]));
                const double v =
                    std::max(std::abs(s.pure_velocity.y[y.face(j, i)]), std::abs(s.pure_velocity.y[y.face(j + 1, i)]));
                fastest = std::max(fastest, std::max(u, v) + std::sqrt(s.P.gravity * s.water[x.cell(i, j)]));
            }
        const double dt = std::min(cfl * s.P.dx / fastest, end - now);
        s.set_time_step(dt);
        s.step();
        now += dt;
    }
}

/// Same bits, zeros of either sign apart.
template <class Real> bool same(const Solver<Real>& a, const Solver<Real>& b) {
    return a.sand == b.sand && a.water == b.water && a.Vxx == b.Vxx && a.Vxy == b.Vxy && a.Vyy == b.Vyy &&
           a.sand_velocity.x == b.sand_velocity.x && a.sand_velocity.y == b.sand_velocity.y &&
           a.pure_velocity.x == b.pure_velocity.x && a.pure_velocity.y == b.pure_velocity.y &&
           a.mixed_velocity.x == b.mixed_velocity.x && a.mixed_velocity.y == b.mixed_velocity.y;
}

} // namespace wadi::reference::test
