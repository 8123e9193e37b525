// The paper's Algorithm 1 read line by line, in double: a third solver beside the stages and solver.hpp, written from the printed
// equations alone and sharing no code with either. Closed walls, two layers of water, elastoplastic sand. Where the print is
// wrong or silent it reads as engine/NUMERICS.md 0.1 says. Judges method `published` in whole steps.
#pragma once
#include "engine/settings/data/settings.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace wadi::reference {

class Printed {
  public:
    struct Velocity {
        std::vector<double> u, v; // on west faces, (nx + 1) x (ny + 1); on south faces, the same
    };
    struct Strain {
        double theta = 0, xx = 1, xy = 0, yy = 1; // F = R(theta) P
    };

    Printed(const Settings& settings, const InitialFields& fields) : s_(settings), nx_(s_.grid.nx), ny_(s_.grid.ny) {
        const std::size_t cells = static_cast<std::size_t>((nx_ + 1) * (ny_ + 1)); // one row and column more: faces fit, too
        for (auto* f : {&H, &hs, &hw, &hm}) f->assign(cells, 0);
        for (auto* w : {&pure, &mixed, &sand}) {
            w->u.assign(cells, 0);
            w->v.assign(cells, 0);
        }
        F.assign(cells, {});
        for (int j = 0; j < ny_; ++j)
            for (int i = 0; i < nx_; ++i) {
                const auto from = static_cast<std::size_t>(j * nx_ + i);
                H[at(i, j)] = static_cast<double>(fields.terrain[from]);
                hs[at(i, j)] = static_cast<double>(fields.sand[from]);
                const double all = static_cast<double>(fields.water[from]);
                hm[at(i, j)] = std::min(all, hs[at(i, j)]);
                hw[at(i, j)] = all - hm[at(i, j)];
            }
        const auto& m = s_.material;
        lambda_ = m.young_modulus * m.poisson_ratio / ((1 + m.poisson_ratio) * (1 - 2 * m.poisson_ratio));
        mu_ = m.young_modulus / (2 * (1 + m.poisson_ratio));
    }

    /// Algorithm 1.
    void step() {
        const double dts = s_.dt / s_.method.substeps;
        diffuse_mixed_water();
        const Types pure_types = types(hw, eta()), mixed_types = types(hm, eta());
        integrate_water_height();
        integrate_water_velocity(pure_types, mixed_types);
        for (int substep = 0; substep < s_.method.substeps; ++substep) {
            const Types before = types(hs, load());
            const std::vector<double> old_hs = hs;
            const Velocity carrier = sand;
            hs = transported(hs, carrier, dts);
            split(hw, hm, old_hs, false);
            integrate_sand_velocity(before, dts);
            project();
            evolve(old_hs, carrier, dts);
            exchange_layers(old_hs);
            apply_friction(dts);
        }
    }

    std::size_t at(int i, int j) const { return static_cast<std::size_t>(j * (nx_ + 1) + i); }

    std::vector<double> H, hs, hw, hm; // [m]
    Velocity pure, mixed, sand;        // [m/s]
    std::vector<Strain> F;

  private:
    using Field = std::vector<double>;
    enum class Type : std::uint8_t { untracked, tracked, fixed };
    struct Types {
        std::vector<Type> u, v;
    };
    /// f(component, other component's axis, i, j, west or south cell, east or north cell) for every face between two cells.
    template <class Do> void for_faces(Do f) const {
        for (const bool along_y : {false, true})
            for (int j = along_y ? 1 : 0; j < ny_; ++j)
                for (int i = along_y ? 0 : 1; i < nx_; ++i) f(along_y, i, j, along_y ? at(i, j - 1) : at(i - 1, j), at(i, j));
    }
    static Field& part(Velocity& w, bool along_y) { return along_y ? w.v : w.u; }
    static const Field& part(const Velocity& w, bool along_y) { return along_y ? w.v : w.u; }
    static double middle(const Field& f, std::size_t a, std::size_t b) { return (f[a] + f[b]) / 2; }
    double eps() const { return s_.method.dry_threshold; }
    double ratio() const { return s_.material.water_density / s_.material.sand_density; }
    double clamped(double u, double dt) const {
        const double most = s_.method.velocity_clamp * s_.grid.dx / dt;
        return std::clamp(u, -most, most);
    }
    Field eta() const { // H + h^w + h^m
        Field sum = H;
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += hw[c] + hm[c];
        return sum;
    }
    Field load() const { // H + h^s + rho^w/rho^s h^w
        Field sum = H;
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += hs[c] + ratio() * hw[c];
        return sum;
    }

    // 5, boundary conditions: a face stands where what is wet does not stand above dry ground beside it.
    bool stands(const Field& h, const Field& surface, std::size_t a, std::size_t b) const {
        const bool wet_a = h[a] > eps(), wet_b = h[b] > eps();
        if (wet_a == wet_b) return !wet_a;
        return wet_a ? surface[b] >= surface[a] : surface[a] >= surface[b];
    }
    Types types(const Field& h, const Field& surface) const {
        Types t{std::vector<Type>(h.size(), Type::fixed), std::vector<Type>(h.size(), Type::fixed)};
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            Type& type = (along_y ? t.v : t.u)[at(i, j)];
            if (h[a] <= eps() && h[b] <= eps())
                type = Type::untracked;
            else if (!stands(h, surface, a, b))
                type = Type::tracked;
        });
        return t;
    }

    // 4.3: the mean of the tracked among 3 x 3.
    Velocity extrapolated(const Velocity& w, const Types& t) const {
        Velocity out = w;
        for_faces([&](bool along_y, int i, int j, std::size_t, std::size_t) {
            const auto& type = along_y ? t.v : t.u;
            if (type[at(i, j)] != Type::untracked) return;
            double sum = 0;
            int count = 0;
            for (int dj = -1; dj <= 1; ++dj)
                for (int di = -1; di <= 1; ++di) {
                    const int ii = i + di, jj = j + dj;
                    if (ii < 0 || jj < 0 || ii > nx_ || jj > ny_ || type[at(ii, jj)] != Type::tracked) continue;
                    sum += part(w, along_y)[at(ii, jj)];
                    ++count;
                }
            part(out, along_y)[at(i, j)] = count > 0 ? sum / count : 0;
        });
        return out;
    }

    // The other component at a face: the mean of four.
    double beside(const Velocity& w, bool along_y, int i, int j) const {
        const Field& f = part(w, !along_y);
        return along_y ? (f[at(i, j - 1)] + f[at(i + 1, j - 1)] + f[at(i, j)] + f[at(i + 1, j)]) / 4
                       : (f[at(i - 1, j)] + f[at(i - 1, j + 1)] + f[at(i, j)] + f[at(i, j + 1)]) / 4;
    }

    // 4.1.3, 4.2.3: semi-Lagrangian.
    void trace(Velocity& w, const Types& t, double dt) const {
        const Velocity from = extrapolated(w, t);
        for_faces([&](bool along_y, int i, int j, std::size_t, std::size_t) {
            if ((along_y ? t.v : t.u)[at(i, j)] == Type::fixed) return;
            const Field& f = part(from, along_y);
            const double own = dt / s_.grid.dx * f[at(i, j)], other = dt / s_.grid.dx * beside(from, along_y, i, j);
            const double x = i - (along_y ? other : own), y = j - (along_y ? own : other);
            const int i0 = static_cast<int>(std::floor(x)), j0 = static_cast<int>(std::floor(y));
            const auto value = [&](int ii, int jj) { // rows beyond the walls repeat the last
                return f[at(std::clamp(ii, 0, along_y ? nx_ - 1 : nx_), std::clamp(jj, 0, along_y ? ny_ : ny_ - 1))];
            };
            const double p = x - i0, q = y - j0;
            part(w, along_y)[at(i, j)] = (1 - q) * ((1 - p) * value(i0, j0) + p * value(i0 + 1, j0)) +
                                         q * ((1 - p) * value(i0, j0 + 1) + p * value(i0 + 1, j0 + 1));
        });
    }

    // Eq. 7 with its sign corrected: h, and what of a quantity each unit of it carries.
    Field transported(const Field& h, const Velocity& w, double dt, const Field* carried = nullptr) const {
        Field out = h;
        if (carried != nullptr)
            for (std::size_t c = 0; c < out.size(); ++c) out[c] *= (*carried)[c];
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            const double u = part(w, along_y)[at(i, j)];
            const std::size_t donor = u > 0 ? a : b;
            const double moved = dt / s_.grid.dx * u * h[donor] * (carried != nullptr ? (*carried)[donor] : 1);
            out[a] -= moved;
            out[b] += moved;
        });
        return out;
    }

    // 4.1.1, the velocity by the heights that it finds, divided by the height that the print lacks.
    void diffuse_mixed_water() {
        const double number = s_.material.diffusion_rate * s_.dt / (s_.grid.dx * s_.grid.dx);
        const Velocity old = mixed;
        const auto inside = [&](int i, int j) { return at(std::clamp(i, 0, nx_ - 1), std::clamp(j, 0, ny_ - 1)); };
        for_faces([&](bool along_y, int i, int j, std::size_t, std::size_t) {
            const auto face_height = [&](int ii, int jj) {
                return middle(hm, along_y ? inside(ii, jj - 1) : inside(ii - 1, jj), inside(ii, jj));
            };
            const Field& u = part(old, along_y);
            const double h = face_height(i, j), own = u[at(i, j)];
            if (h <= eps()) return;
            double sum = 0;
            for (const auto& [di, dj] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                const bool off = along_y ? i + di < 0 || i + di >= nx_ : j + dj < 0 || j + dj >= ny_; // the row beyond a wall
                const double other = off ? own : u[at(i + di, j + dj)];
                sum += (own + other) / 2 * (face_height(i + di, j + dj) - h);
            }
            part(mixed, along_y)[at(i, j)] = clamped(own + number * sum / h, s_.dt);
        });
        const Field h = hm;
        for_faces([&](bool, int, int, std::size_t a, std::size_t b) {
            hm[a] += number * (h[b] - h[a]);
            hm[b] += number * (h[a] - h[b]);
        });
    }

    // 4.1.2: predictors, M of the corrector and the corrector. gain: what the mixed layer wins [m].
    void split(Field& w, Field& m, const Field& before, bool predicted) {
        gain_.assign(w.size(), 0);
        for (std::size_t c = 0; c < w.size(); ++c) {
            const double all = w[c] + m[c], now = std::min(all, hs[c]);
            gain_[c] = now - (predicted ? m[c] : std::min(all, before[c]));
            m[c] = now;
            w[c] = all - now;
        }
    }
    void measure_exchange() {
        given_ = Velocity{Field(hs.size(), 0), Field(hs.size(), 0)};
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            const double in = (std::max(gain_[a], 0.0) + std::max(gain_[b], 0.0)) / 2,
                         out = (std::min(gain_[a], 0.0) + std::min(gain_[b], 0.0)) / 2;
            part(given_, along_y)[at(i, j)] = in * part(pure, along_y)[at(i, j)] + out * part(mixed, along_y)[at(i, j)];
        });
    }
    void give_exchange() {
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            const double moved = part(given_, along_y)[at(i, j)];
            if (moved == 0) return;
            double& um = part(mixed, along_y)[at(i, j)];
            double& uw = part(pure, along_y)[at(i, j)];
            if (middle(hm, a, b) > eps()) um = clamped(um + moved / middle(hm, a, b), s_.dt);
            if (middle(hw, a, b) > eps()) uw = clamped(uw - moved / middle(hw, a, b), s_.dt);
        });
    }
    void integrate_water_height() {
        const Field w = transported(hw, pure, s_.dt), m = transported(hm, mixed, s_.dt);
        hw = w;
        hm = m;
        split(hw, hm, hs, true);
        measure_exchange();
    }

    // 4.1.3
    void integrate_water_velocity(const Types& pure_types, const Types& mixed_types) {
        trace(pure, pure_types, s_.dt);
        trace(mixed, mixed_types, s_.dt);
        give_exchange();
        const Field surface = eta();
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            const double push = s_.dt * s_.gravity * (surface[b] - surface[a]) / s_.grid.dx;
            double& uw = part(pure, along_y)[at(i, j)];
            double& um = part(mixed, along_y)[at(i, j)];
            uw = clamped(uw - push, s_.dt);
            um = stands(hm, surface, a, b) ? 0 : clamped(um - push, s_.dt);
            if (hw[uw > 0 ? a : b] <= eps()) uw = 0;
        });
    }

    // 4.2.3
    void integrate_sand_velocity(const Types& before, double dts) {
        trace(sand, before, dts);
        const auto& m = s_.material;
        const Field pressed = load();
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            double& us = part(sand, along_y)[at(i, j)];
            double& um = part(mixed, along_y)[at(i, j)];
            const double h_s = middle(hs, a, b), h_m = middle(hm, a, b);
            double drag = 0;
            if (h_m > eps() && h_s > eps() / 2) {
                drag = -m.exchange_rate / (m.sand_density * h_s) * h_m * (us - um);
                um -= dts * m.sand_density * h_s / (m.water_density * h_m) * drag;
            }
            us += dts * drag - dts * s_.gravity * (pressed[b] - pressed[a]) / s_.grid.dx;
            if (h_s < eps() / 2 || stands(hs, pressed, a, b)) us = 0;
        });
    }

    double cohesion(double phi) const { // 3.3.3
        const auto& m = s_.material;
        const auto& [p1, p2, p3] = m.saturation;
        if (phi > p3) return 0;
        if (phi >= p2) return m.cohesion_capillary * (p3 - phi) / (p3 - p2);
        if (phi >= p1) return m.cohesion_wet + (phi - p1) * (m.cohesion_capillary - m.cohesion_wet) / (p2 - p1);
        return m.cohesion_dry + phi * (m.cohesion_wet - m.cohesion_dry) / p1;
    }
    // Principal stretches of P and their direction; false where there is no logarithm.
    struct Principal {
        double one, two, angle;
    };
    static Principal principal(const Strain& p) {
        const double mean = (p.xx + p.yy) / 2, half = (p.xx - p.yy) / 2, r = std::hypot(half, p.xy);
        return {mean + r, mean - r, std::atan2(p.xy, half) / 2};
    }
    // 3.3.2: Hencky strain (Klar et al. 2016) back to the surface of Kirchhoff's stress.
    void project() {
        for (int j = 0; j < ny_; ++j)
            for (int i = 0; i < nx_; ++i) {
                const std::size_t c = at(i, j);
                if (hs[c] <= eps()) continue;
                const double c_c = cohesion((hw[c] + hm[c]) / (hw[c] + hm[c] + hs[c]));
                Strain& p = F[c];
                const Principal e = principal(p);
                if (!(e.two > 0)) {
                    p = {p.theta, 1, 0, 1};
                    continue;
                }
                double a = std::log(e.one), b = std::log(e.two);
                const double trace_of_stress = 2 * (lambda_ + mu_) * (a + b), shear = 2 * mu_ * (a - b) / std::sqrt(2.0);
                const double room = c_c - s_.material.yield_friction * trace_of_stress;
                if (shear <= room) continue;
                const double volume = room > 0 ? a + b : c_c / (s_.material.yield_friction * 2 * (lambda_ + mu_));
                const double apart = room > 0 ? (a - b) * room / shear : 0;
                a = std::exp((volume + apart) / 2);
                b = std::exp((volume - apart) / 2);
                const double c2 = std::cos(2 * e.angle), s2 = std::sin(2 * e.angle);
                p = {p.theta, (a + b) / 2 + (a - b) / 2 * c2, (a - b) / 2 * s2, (a + b) / 2 - (a - b) / 2 * c2};
            }
    }

    // 4.2.2: h theta and h P move, then the force, then F.
    void evolve(const Field& old_hs, const Velocity& carrier, double dts) {
        for (double Strain::*component : {&Strain::theta, &Strain::xx, &Strain::xy, &Strain::yy}) {
            Field carried(hs.size());
            for (std::size_t c = 0; c < hs.size(); ++c) carried[c] = F[c].*component;
            const Field moved = transported(old_hs, carrier, dts, &carried);
            const double none = component == &Strain::xx || component == &Strain::yy ? 1 : 0;
            for (std::size_t c = 0; c < hs.size(); ++c) F[c].*component = hs[c] > 0 ? moved[c] / hs[c] : none;
        }
        Field xx(hs.size(), 0), xy(hs.size(), 0), yy(hs.size(), 0); // h^s sigma
        for (std::size_t c = 0; c < hs.size(); ++c) {
            if (hs[c] <= eps()) continue;
            const Principal e = principal(F[c]);
            if (!(e.two > 0)) continue;
            const double a = std::log(e.one), b = std::log(e.two), J = e.one * e.two, angle = 2 * (e.angle + F[c].theta);
            const double mean = hs[c] * (lambda_ + mu_) * (a + b) / J, apart = hs[c] * mu_ * (a - b) / J;
            xx[c] = mean + apart * std::cos(angle);
            yy[c] = mean - apart * std::cos(angle);
            xy[c] = apart * std::sin(angle);
        }
        const Field pressed = load();
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            double& us = part(sand, along_y)[at(i, j)];
            const double h = middle(hs, a, b);
            const auto corner = [&](int ii, int jj) { // south-west of cell (ii, jj); nothing on the walls
                if (ii == 0 || jj == 0 || ii == nx_ || jj == ny_) return 0.0;
                return (xy[at(ii - 1, jj - 1)] + xy[at(ii, jj - 1)] + xy[at(ii - 1, jj)] + xy[at(ii, jj)]) / 4;
            };
            const Field& normal = along_y ? yy : xx;
            const double force = normal[b] - normal[a] + (along_y ? corner(i + 1, j) : corner(i, j + 1)) - corner(i, j);
            if (h > 0) us += dts / s_.grid.dx * force / (s_.material.sand_density * h);
            if (h < eps() / 2 || stands(hs, pressed, a, b)) us = 0;
        });
        const Velocity w = extrapolated(sand, types(hs, pressed)); // 4.3
        const std::vector<Strain> moved = F;
        for (int j = 0; j < ny_; ++j)
            for (int i = 0; i < nx_; ++i) {
                const std::size_t c = at(i, j);
                if (hs[c] <= eps()) continue;
                const auto u_of = [&](int row) { return middle(w.u, at(i, row), at(i + 1, row)); };
                const auto v_of = [&](int column) { return middle(w.v, at(column, j), at(column, j + 1)); };
                const double k = dts / s_.grid.dx;
                const double gxx = k * (w.u[at(i + 1, j)] - w.u[c]), gyy = k * (w.v[at(i, j + 1)] - w.v[c]);
                const int s = std::max(j - 1, 0), n = std::min(j + 1, ny_ - 1), west = std::max(i - 1, 0),
                          e = std::min(i + 1, nx_ - 1);
                const double gxy = n > s ? k * (u_of(n) - u_of(s)) / (n - s) : 0;
                const double gyx = e > west ? k * (v_of(e) - v_of(west)) / (e - west) : 0;
                const Strain& p = moved[c];
                const double cs = std::cos(p.theta), sn = std::sin(p.theta);
                const double fxx = cs * p.xx - sn * p.xy, fxy = cs * p.xy - sn * p.yy, fyx = sn * p.xx + cs * p.xy,
                             fyy = sn * p.xy + cs * p.yy;
                const double nxx = fxx + gxx * fxx + gxy * fyx, nxy = fxy + gxx * fxy + gxy * fyy,
                             nyx = fyx + gyx * fxx + gyy * fyx, nyy = fyy + gyx * fxy + gyy * fyy;
                const double theta = std::atan2(nyx - nxy, nxx + nyy), c1 = std::cos(theta), s1 = std::sin(theta);
                F[c] = {theta, c1 * nxx + s1 * nyx, (c1 * nxy + s1 * nyy + c1 * nyx - s1 * nxx) / 2, c1 * nyy - s1 * nxy};
            }
        extrapolate_strain();
    }
    void extrapolate_strain() { // 4.3
        const std::vector<Strain> from = F;
        for (int j = 0; j < ny_; ++j)
            for (int i = 0; i < nx_; ++i) {
                if (hs[at(i, j)] > eps()) continue;
                Strain sum{0, 0, 0, 0};
                int count = 0;
                for (int jj = std::max(j - 1, 0); jj <= std::min(j + 1, ny_ - 1); ++jj)
                    for (int ii = std::max(i - 1, 0); ii <= std::min(i + 1, nx_ - 1); ++ii) {
                        const Strain& p = from[at(ii, jj)];
                        if (hs[at(ii, jj)] <= eps()) continue;
                        sum = {sum.theta + p.theta, sum.xx + p.xx, sum.xy + p.xy, sum.yy + p.yy};
                        ++count;
                    }
                F[at(i, j)] = count > 0 ? Strain{sum.theta / count, sum.xx / count, sum.xy / count, sum.yy / count} : Strain{};
            }
    }

    // 4.1.2 again, for the sand that has moved.
    void exchange_layers(const Field& old_hs) {
        split(hw, hm, old_hs, false);
        measure_exchange();
        give_exchange();
    }

    // 4.2.4, h^w read as the mixed height.
    void apply_friction(double dts) {
        const Velocity old = sand;
        for_faces([&](bool along_y, int i, int j, std::size_t a, std::size_t b) {
            double& us = part(sand, along_y)[at(i, j)];
            const double h_s = middle(hs, a, b), h_m = middle(hm, a, b), speed = std::hypot(us, beside(old, along_y, i, j));
            if (h_m <= 0) part(mixed, along_y)[at(i, j)] = 0;
            if (h_s <= eps() / 2 || speed <= 0) {
                us = 0;
                return;
            }
            const double a_E = s_.material.friction * s_.gravity * std::max(0.0, 1 - ratio() * h_m / h_s);
            us = clamped(us * std::max((speed - dts * a_E) / speed, 0.0), dts);
        });
    }

    Settings s_;
    int nx_, ny_;
    double lambda_ = 0, mu_ = 0;
    Field gain_;
    Velocity given_;
};

} // namespace wadi::reference
