#include "tests/conformance/half_turn.hpp"
#include "engine/step/plan/world_params.hpp"
#include "tests/conformance/bench.hpp"
#include "tests/conformance/target.hpp"
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace wadi::conformance {

namespace {

constexpr int states = 13; // one row each: 0, 15 ... 180 degrees
constexpr double along = 1.2, across = 0.9;
constexpr double step_degrees = 15;

enum class Strain { polar, direct, left_stretch };

/// What a cell stores of its strain: xx, xy, yy and the rotation field, as NUMERICS 1 and 2.13 define them.
using Stored = std::array<double, 4>;

// The body stretched by `along` and `across`, then turned.
Stored turned(Strain strain, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    if (strain == Strain::polar) return {along - 1, 0, across - 1, angle};
    if (strain == Strain::left_stretch) // R P R^T
        return {along * c * c + across * s * s - 1, (along - across) * c * s, along * s * s + across * c * c - 1, 0};
    const double xy = -s * across, yx = s * along; // F = R P: its symmetric and antisymmetric part
    return {c * along - 1, 0.5 * (xy + yx), c * across - 1, 0.5 * (yx - xy)};
}

double area(Strain strain, const Stored& f) {
    const double turn = strain == Strain::direct ? f[3] : 0;
    return (1 + f[0]) * (1 + f[2]) - (f[1] - turn) * (f[1] + turn);
}

// Half way between angles 0 and `angle`.
double expected_area(Strain strain, double angle) {
    if (strain == Strain::polar) return along * across;
    const Stored a = turned(strain, 0), b = turned(strain, angle);
    Stored mean{};
    for (std::size_t n = 0; n < mean.size(); ++n) mean[n] = 0.5 * (a[n] + b[n]);
    return strain == Strain::direct ? along * across * std::pow(std::cos(angle / 2), 2) : area(strain, mean);
}

class HalfTurn {
  public:
    explicit HalfTurn(Strain strain)
        : strain_(strain), stage_(compute::find_stage(strain == Strain::left_stretch ? "evolve_deformation_gradient"
                                                                                     : "advect_deformation_gradient")) {
        effects_ = EFFECT_SAND | EFFECT_ELASTOPLASTIC;
        if (strain != Strain::left_stretch) effects_ |= EFFECT_PUBLISHED;
        if (strain == Strain::direct) effects_ |= EFFECT_DIRECT_STRAIN;
        Settings settings;
        settings.grid = {2, states, 1};
        settings.dt = 0.01;
        params_ = derive_params(settings, effects_);
        for (const auto& binding : info().bindings) buffers_.push_back(fill(binding));
    }

    Verdict run(Session& session) {
        auto device = session.device();
        if (!device) return verdict_of(device.status());
        if (auto status = run_bench(**device, stage_, effects_, params_, StepInput{}, {}, buffers_); !status)
            return verdict_of(status);
        Verdict verdict;
        verdict.allowed = 2e-6;
        for (int j = 0; j < states; ++j) {
            const double degrees = j * step_degrees, angle = degrees * std::numbers::pi / 180, got = area(strain_, result(j));
            verdict.error = std::max(verdict.error, std::abs(got - expected_area(strain_, angle)));
            char text[48];
            std::snprintf(text, sizeof text, "%s%g:%.4f", j == 0 ? "area by degrees " : " ", degrees, got / (along * across));
            verdict.detail += text;
        }
        if (!(verdict.error <= verdict.allowed)) verdict.outcome = Outcome::fail;
        return verdict;
    }

  private:
    const compute::StageInfo& info() const { return compute::stage_table()[static_cast<std::size_t>(stage_)]; }

    // Sand 1 m deep everywhere; half a metre of it comes through the face between the two columns; nothing moves the strain.
    BenchBuffer fill(const compute::StageBinding& binding) const {
        const std::string_view name = binding.name;
        BenchBuffer buffer;
        buffer.exists = (binding.condition & effects_) == binding.condition;
        buffer.before.assign(layout_.size(), 0);
        const auto set = [&](int i, int j, double value) {
            buffer.before[layout_.index(i, j)] = std::bit_cast<std::uint32_t>(static_cast<float>(value));
        };
        for (int j = 0; j < states; ++j) {
            for (int i = 0; i < 2; ++i) {
                const Stored state = turned(strain_, i == 0 ? j * step_degrees * std::numbers::pi / 180 : 0);
                if (name.starts_with("sand_height")) set(i, j, 1);
                if (name == "sand_flux_x" && i == 1) set(i, j, 0.5);
                if (name == "stretch_xx") set(i, j, state[0]);
                if (name == "stretch_xy") set(i, j, state[1]);
                if (name == "stretch_yy") set(i, j, state[2]);
                if (name == "rotation") set(i, j, state[3]);
            }
        }
        return buffer;
    }

    Stored result(int j) const {
        Stored state{};
        for (std::size_t b = 0; b < buffers_.size(); ++b) {
            if (!buffers_[b].exists) continue;
            const std::string_view name = info().bindings[b].name;
            const auto value = static_cast<double>(buffers_[b].floats()[layout_.index(1, j)]);
            if (name == "stretch_xx_next") state[0] = value;
            if (name == "stretch_xy_next") state[1] = value;
            if (name == "stretch_yy_next") state[2] = value;
            if (name == "rotation_next") state[3] = value;
        }
        return state;
    }

    Strain strain_;
    int stage_;
    std::uint32_t effects_ = 0;
    WorldParams params_{};
    FieldLayout layout_{2, states};
    std::vector<BenchBuffer> buffers_;
};

} // namespace

Verdict run_half_turn(const CaseSpec& spec, Session& session) {
    const std::string name = spec.get("strain", "polar");
    if (name != "polar" && name != "direct" && name != "left_stretch")
        return failed("strain=" + name + "; known are polar, direct and left_stretch");
    return HalfTurn(name == "polar" ? Strain::polar : name == "direct" ? Strain::direct : Strain::left_stretch).run(session);
}

} // namespace wadi::conformance
