// Small rules shared by water and sand: pure functions of their arguments.
#pragma once
#include <algorithm>
#include <cmath>

namespace wadi::reference {

/// 2.2: a depth after its fluxes; what is too small to count is 0, so that a drained cell is dry.
template <class Real> Real filled(Real h, Real gained) {
    const Real now = std::max(h + gained, Real(0));
    return now < Real(1e-20) ? Real(0) : now;
}

/// 2.4c: a velocity of pure water that would draw from a dry cell is 0.
template <class Real> Real leaving_wet(Real u, Real h_left, Real h_right, Real eps) {
    const Real donor = u > Real(0) ? h_left : h_right;
    return donor > eps ? u : Real(0);
}

/// 2.4c: whether a face of sand or of mixed water with depths h and surfaces S on both sides must stand still.
template <class Real> bool blocked(Real h_left, Real h_right, Real S_left, Real S_right, Real eps) {
    const bool wet_left = h_left > eps;
    const bool wet_right = h_right > eps;
    if (!wet_left && !wet_right) return true;
    if (wet_left && !wet_right) return S_right >= S_left;
    if (wet_right && !wet_left) return S_left >= S_right;
    return false;
}

template <class Real> Real clamped(Real u, Real limit) { return std::clamp(u, -limit, limit); }

/// 2.4d: component u of a velocity whose other component is v, shortened where it is longer than `limit`.
template <class Real> Real shortened(Real u, Real v, Real limit) {
    const Real size = std::sqrt(u * u + v * v);
    return size > limit ? clamped(u * (limit / size), limit) : u;
}

/// 2.4: component u of V* behind friction V' (1 + rate |V'|) = V*, where the other component v of V' is known to be what it was,
/// at a speed `before` of the flow.
template <class Real> Real rubbed(Real u, Real v, Real before, Real rate) {
    const Real driven = std::hypot(u, v * (Real(1) + rate * before)); // |V*| = |V'| + rate |V'|^2
    const Real speed = Real(2) * driven / (Real(1) + std::sqrt(Real(1) + Real(4) * rate * driven));
    return u / (Real(1) + rate * speed);
}

/// 2.1: 0 where the slopes disagree in sign, else the one of smaller magnitude.
template <class Real> Real minmod(Real a, Real e) {
    if (a * e <= Real(0)) return Real(0);
    return std::abs(a) < std::abs(e) ? a : e;
}

/// 2.16: slope at b towards c, the mean of both sides' and at most twice either; 0 at an extremum.
template <class Real> Real centred_slope(Real a, Real b, Real c) {
    if ((b - a) * (c - b) <= Real(0)) return Real(0);
    const Real size = std::min(Real(2) * std::min(std::abs(b - a), std::abs(c - b)), std::abs(c - a) / Real(2));
    return std::copysign(size, c - a);
}

template <class Real> Real mean(Real left, Real right) { return (left + right) / Real(2); }

/// Volume that is moved: whole quanta, towards zero once a phase in [0, 1) of one is added.
template <class Real> Real whole_quanta(Real depth, Real quantum, Real phase) {
    const Real count = std::floor(std::abs(depth) / quantum + phase);
    return quantum > Real(0) ? std::copysign(count * quantum, depth) : depth;
}

} // namespace wadi::reference
