// Ground water of the sand beside a level side.
#include "tests/stability/quality.hpp"
#include <functional>

using namespace wadi;
using namespace wadi::test;

namespace {

/// Ground water between two levels over a base of even slope, at rest in time: q = -K h d(h + b)/dx (Dupuit 1863), by Runge and
/// Kutta's fourth-order steps from `high` on, with the flow that meets `low`.
class Seepage {
  public:
    /// base: of the ground at x [m]; length: from one level to the other [m]; levels above the same datum [m].
    Seepage(std::function<double(double)> base, double length, double conductivity, double high, double low)
        : base_(std::move(base)), step_(length / steps), conductivity_(conductivity), high_(high) {
        double least = 0, most = conductivity * (high - base_(0)) * 2 * (high - low) / length;
        for (int n = 0; n < 60; ++n) {
            flow_ = (least + most) / 2;
            draw();
            (surface_.size() > steps && surface_.back() > low ? least : most) = flow_;
        }
    }
    double flow() const { return flow_; } // [m2/s]
    double surface(double x) const {
        const double s = x / step_;
        const auto n = std::min(static_cast<std::size_t>(s), surface_.size() - 2);
        return surface_[n] + (s - static_cast<double>(n)) * (surface_[n + 1] - surface_[n]);
    }

  private:
    static constexpr int steps = 2000;
    double fall(double x, double eta) const { return -flow_ / (conductivity_ * (eta - base_(x))); }
    void draw() { // as far as there is water
        surface_ = {high_};
        for (int n = 0; n < steps; ++n) {
            const double x = n * step_, eta = surface_.back(), half = step_ / 2;
            const double a = fall(x, eta), b = fall(x + half, eta + half * a), c = fall(x + half, eta + half * b);
            const double next = eta + step_ / 6 * (a + 2 * b + 2 * c + fall(x + step_, eta + step_ * c));
            if (!(next > base_(x + step_))) return;
            surface_.push_back(next);
        }
    }

    std::function<double(double)> base_;
    double step_, conductivity_, high_, flow_ = 0;
    std::vector<double> surface_;
};

/// How far sand from one side to the other, 50 cells of 0.2 m on ground of that slope between levels of 1.2 and 0.6 m above its
/// higher end, is off Dupuit: shares of the flow and of the difference of the levels. exchange: kg/(m3 s).
std::pair<double, double> off_dupuit(double exchange, double slope) {
    const int cells = 50;
    const double dx = 0.2, length = cells * dx;
    auto scene = flat_scene(cells, 1, dx, 0.01);
    auto& material = scene.settings.material;
    material.exchange_rate = exchange;
    material.retention = 0;
    material.diffusion_rate = 0; // would add to the flow
    material.young_modulus = 0;
    material.friction = 2;
    scene.settings.method.rest_rule = false;
    const auto base = [&](double x) { return 1 - slope * std::clamp(x, dx / 2, length - dx / 2); };
    const double end = std::max(base(0), base(length)), high = end + 1.2, low = end + 0.6;
    scene.fill(scene.fields.terrain, [&](double x, double) { return base(x); });
    scene.fill(scene.fields.sand, [&](double x, double) { return end + 2 - base(x); });
    scene.fill(scene.fields.water, [&](double x, double) { return (high + low) / 2 - base(x); });
    scene.settings.sides[SIDE_WEST] = {SideKind::level, 0, 1e30, {{{0, high}}}};
    scene.settings.sides[SIDE_EAST] = {SideKind::level, 0, 1e30, {{{0, low}}}};
    auto world = make_world(scene);
    const int steps = exchange > 5e4 ? 100000 : 20000;
    step(*world, steps);
    const auto before = stats_of(*world);
    step(*world, steps / 10);
    const auto after = stats_of(*world);
    const double out = double(after.ledger.water_out - before.ledger.water_out) * after.quantum * dx / (steps / 10 * 0.01);
    const auto ground = [&](double x) { return base(x - dx / 2); }; // from the middle of one ghost to that of the other
    const Seepage truth(ground, length + dx, 1000 * 9.81 / exchange, high, low);
    const auto h = cells_of(*world, "water_height");
    double off = 0;
    for (int i = 0; i < cells; ++i) {
        const double x = (i + 0.5) * dx;
        off = std::max(off, std::abs(base(x) + h.at(i, 0) - truth.surface(x + dx / 2)));
    }
    MESSAGE("exchange " << exchange << ", slope " << slope << ": off the surface by " << off << " m, flow " << out
                        << " m2/s, Dupuit's " << truth.flow());
    return {std::abs(out / truth.flow() - 1), off / (high - low)};
}

} // namespace

TEST_CASE("level sides hold the ground water of the sand beside them: Dupuit's surface and flow, over level and sloping ground" *
          doctest::test_suite("long")) {
    const Seepage level([](double) { return 0.0; }, 10.2, 0.981, 1.2, 0.6); // whose surface is a parabola
    CHECK(std::abs(level.flow() / (0.981 * (1.2 * 1.2 - 0.6 * 0.6) / (2 * 10.2)) - 1) < 1e-5);
    CHECK(std::abs(level.surface(5.1) / std::sqrt((1.2 * 1.2 + 0.6 * 0.6) / 2) - 1) < 1e-5);
    for (const auto& [exchange, slope] : {std::pair{1e4, 0.0}, {1e5, 0.0}, {1e4, 0.06}, {1e4, -0.06}}) {
        const auto [flow, surface] = off_dupuit(exchange, slope);
        CHECK(flow < 0.03);
        CHECK(surface < 0.03);
    }
}
