// Stages carry_foam, wet_ground and carry_silt alone, on the CPU: sums to the last quantum, what goes where, how fast it fades or
// sinks, what is picked up (NUMERICS 2.25 to 2.27).
#include "backends/cpu/stages.hpp"
#include "engine/step/plan/world_params.hpp"
#include "shaders/effects.h"
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace wadi;

namespace {

constexpr float quantum = 0x1p-20F;
constexpr std::uint32_t mask = EFFECT_WATER | EFFECT_FOAM | EFFECT_WETNESS, muddy = EFFECT_WATER | EFFECT_SAND | EFFECT_SILT;

/// Fields of a grid, in the order of the stages' buffers.
struct SurfaceTrial {
    FieldLayout layout;
    WorldParams params;
    std::vector<float> water, velocity_x, velocity_y, foam, next, wetness, sand, sand_x, sand_y, silt;

    SurfaceTrial(int nx, int ny) : layout{nx, ny} {
        Settings settings;
        settings.grid = {nx, ny, 0.25};
        settings.dt = 0x1p-6;
        params = derive_params(settings, mask);
        for (auto* field : {&water, &velocity_x, &velocity_y, &foam, &next, &wetness, &sand, &sand_x, &sand_y, &silt})
            field->assign(layout.size(), 0.0F);
    }
    float& at(std::vector<float>& field, int i, int j) const { return field[layout.index(i, j)]; }
    void fill(std::vector<float>& field, float value, int columns, int rows) const {
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) at(field, i, j) = value;
    }
    double total(const std::vector<float>& field) const {
        double sum = 0;
        for (int j = 0; j < layout.ny; ++j)
            for (int i = 0; i < layout.nx; ++i) sum += static_cast<double>(field[layout.index(i, j)]);
        return sum;
    }
    void run(const char* stage, std::vector<std::vector<float>*> fields, std::uint32_t effects = mask) {
        fields.resize(compute::stage_table()[static_cast<std::size_t>(compute::find_stage(stage))].bindings.size());
        std::vector<void*> buffers;
        std::vector<unsigned long long> sizes;
        for (auto* field : fields) {
            buffers.push_back(field != nullptr ? field->data() : nullptr);
            sizes.push_back(field != nullptr ? field->size() * 4 : 0);
        }
        const StepInput input{};
        const compute::Range2 cells{0, 0, layout.nx, layout.ny};
        const cpu::StageCall call{cpu::instruction_sets().front().select[compute::find_stage(stage)](effects),
                                  buffers.data(),
                                  sizes.data(),
                                  params,
                                  input,
                                  cells};
        call(0, layout.nx, 0, layout.ny);
    }
    void carry() {
        run("carry_foam", {&water, &velocity_x, &velocity_y, &foam, &next});
        std::swap(foam, next);
    }
    void wet() { run("wet_ground", {&water, &wetness}); }
    void carry_silt() {
        run("carry_silt", {&water, &velocity_x, &velocity_y, &sand, &sand_x, &sand_y, &silt, &next}, muddy);
        std::swap(silt, next);
    }

    /// Any water, foam of up to half a cover and velocities beyond the clamp, so that limiters act; walls around.
    void stir(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> depth(-0.02F, 0.05F), speed(-20, 20);
        for (int j = 0; j < layout.ny; ++j) {
            for (int i = 0; i < layout.nx; ++i) {
                at(water, i, j) = std::max(depth(random), 0.0F);
                at(foam, i, j) = static_cast<float>(random() % 524288) * quantum;
                if (i > 0) at(velocity_x, i, j) = speed(random);
                if (j > 0) at(velocity_y, i, j) = speed(random);
            }
        }
    }
};

/// What fading leaves, by the equation, in whole numbers of quanta.
double left_of(float foam, float share) {
    if (!(share > 0)) return static_cast<double>(foam);
    if (foam < 16 * quantum) return 0;
    return static_cast<double>(foam) - (std::floor(static_cast<double>(foam * share) * 0x1p20) + 1) * 0x1p-20;
}

} // namespace

TEST_CASE("foam that drifts keeps its sum to the last quantum, however fast the water is, and fades by what the equation says") {
    for (const float share : {0.0F, 0.003F, 0.4F}) {
        SurfaceTrial trial(37, 23);
        trial.stir(7);
        trial.params.foam_birth = 0;
        trial.params.foam_fade = share;
        const auto start = trial.foam;
        for (int n = 0; n < 5; ++n) {
            double due = 0;
            for (int j = 0; j < 23; ++j)
                for (int i = 0; i < 37; ++i) due += left_of(trial.at(trial.foam, i, j), share);
            trial.carry();
            CHECK(trial.total(trial.foam) == due); // sums of quanta are exact in double
            for (const float f : trial.foam) CHECK(f >= 0);
        }
        CHECK(trial.foam != start);
        CHECK((share > 0 ? trial.total(trial.foam) < trial.total(start) : trial.total(trial.foam) == trial.total(start)));
    }
}

TEST_CASE("foam leaves through open sides, comes in through none, and lies where there is no water") {
    SurfaceTrial trial(12, 5);
    trial.params.foam_birth = 0;
    trial.params.foam_fade = 0;
    trial.fill(trial.water, 1, 12, 5);
    trial.fill(trial.foam, 0.5F, 12, 5);
    trial.fill(trial.velocity_x, -1.7F, 13, 5);     // outer faces, too
    const float pace = 1.1764706F * trial.params.k; // 1/0.85
    const float moved = std::floor(pace * (1.7F * 0.5F) / quantum) * quantum;
    trial.carry();
    CHECK(trial.at(trial.foam, 0, 2) == 0.5F);
    CHECK(trial.at(trial.foam, 11, 2) == 0.5F - moved); // nothing follows
    CHECK(trial.total(trial.foam) == 0.5 * 60 - 5 * static_cast<double>(moved));

    for (const float depth : {0.0F, 0.01F, 0.02F}) { // on the ground, half afloat, afloat
        trial.fill(trial.foam, 0, 12, 5);
        trial.at(trial.foam, 6, 2) = 0.5F;
        trial.at(trial.water, 6, 2) = depth;
        trial.carry();
        const float goes = std::floor(pace * (1.7F * (0.5F * std::min(depth * 50, 1.0F))) / quantum) * quantum;
        CHECK(trial.at(trial.foam, 6, 2) == 0.5F - goes);
        CHECK(trial.at(trial.foam, 5, 2) == goes);
    }
}

TEST_CASE("foam is born where fast water meets slow, in proportion to what is lost, up to a full cover and no further") {
    SurfaceTrial trial(12, 5);
    trial.params.foam_fade = 0;
    trial.fill(trial.water, 0.5F, 12, 5);
    trial.fill(trial.velocity_x, 2, 6, 5); // to face 5: cell 5 takes in what does not leave
    trial.at(trial.velocity_x, 0, 2) = 2;
    const auto born = [&](float rate) {
        trial.params.foam_birth = rate;
        trial.fill(trial.foam, 0, 12, 5);
        trial.carry();
        return trial.at(trial.foam, 5, 2);
    };
    // h fall / dx = 4 m/s is beyond the 0.65 c = 1.44 m/s at which all of it breaks.
    const float loses = 0.5F * (std::sqrt(trial.params.gravity * 0.5F) * 4.0F); // h c fall^2
    for (const float rate : {0.01F, 0.02F}) CHECK(born(rate) == std::floor(rate * loses / quantum) * quantum);
    CHECK(born(1) == 1);
    trial.carry();
    CHECK(trial.at(trial.foam, 5, 2) == 1);
    CHECK(trial.at(trial.foam, 4, 2) == 0);
    CHECK(trial.at(trial.foam, 6, 2) == 0);    // foam that stands in still water stays
    trial.fill(trial.velocity_x, 0.15F, 6, 5); // 0.3 m/s is below 0.15 c = 0.33 m/s: a wave
    CHECK(born(1) == 0);
    trial.fill(trial.water, trial.params.dry_threshold, 12, 5);
    trial.fill(trial.velocity_x, 2, 6, 5);
    CHECK(born(1e9F) == 0);

    trial.fill(trial.water, 0.5F, 12, 5); // what currents pile up ends at 4
    trial.params.foam_birth = 0;
    trial.fill(trial.foam, 4, 12, 5);
    trial.carry();
    CHECK(trial.at(trial.foam, 5, 2) == 4);
}

TEST_CASE("half of foam and wetness is gone after their half-lives, and all of it in the end") {
    SurfaceTrial trial(3, 3);
    Settings settings;
    settings.grid = {3, 3, 0.25};
    settings.dt = 0x1p-6;
    settings.surface.foam_half_life = 4;
    settings.surface.wetness_half_life = 8;
    trial.params = derive_params(settings, mask);
    trial.at(trial.foam, 1, 1) = 1;
    trial.at(trial.water, 1, 1) = 2 * trial.params.dry_threshold;
    trial.wet();
    CHECK(trial.at(trial.wetness, 1, 1) == 1);
    CHECK(trial.at(trial.wetness, 0, 1) == 0);
    trial.at(trial.water, 1, 1) = trial.params.dry_threshold; // dry
    const auto run = [&](int steps) {
        for (int n = 0; n < steps; ++n) {
            trial.carry();
            trial.wet();
        }
    };
    run(256);
    CHECK(std::abs(trial.at(trial.foam, 1, 1) - 0.5F) <= 256 * quantum); // rounding takes a quantum a step at most
    CHECK(trial.at(trial.foam, 1, 1) <= 0.5F);
    run(256);
    CHECK(std::abs(trial.at(trial.foam, 1, 1) - 0.25F) <= 512 * quantum);
    CHECK(std::abs(trial.at(trial.wetness, 1, 1) - 0.5F) <= 512 * quantum);
    CHECK(trial.at(trial.wetness, 1, 1) <= 0.5F);
    run(4096); // 18 half-lives of the foam, 9 of the wetness
    CHECK(trial.at(trial.foam, 1, 1) == 0);
    CHECK(trial.at(trial.wetness, 1, 1) == 0);
    settings.surface = {0, 20, 0}; // never
    trial.params = derive_params(settings, mask);
    trial.at(trial.foam, 1, 1) = trial.at(trial.wetness, 1, 1) = 0.5F;
    run(100);
    CHECK(trial.at(trial.foam, 1, 1) == 0.5F);
    CHECK(trial.at(trial.wetness, 1, 1) == 0.5F);
}

TEST_CASE("silt that water carries keeps its sum to the last quantum and lies where there is none") {
    SurfaceTrial trial(37, 23);
    trial.stir(11);
    trial.params.silt_fall = 0;
    trial.params.silt_rate = 0;
    std::swap(trial.silt, trial.foam);
    const auto start = trial.silt;
    double due = 0, wet = 0;
    for (int n = 0; n < 5; ++n) {
        due = 0;
        for (int j = 0; j < 23; ++j)
            for (int i = 0; i < 37; ++i)
                if (trial.at(trial.water, i, j) > trial.params.dry_threshold)
                    due += static_cast<double>(trial.at(trial.silt, i, j));
        if (n == 0) wet = due;
        trial.carry_silt();
        CHECK(trial.total(trial.silt) == due);
        for (const float amount : trial.silt) CHECK(amount >= 0);
    }
    CHECK(wet < trial.total(start)); // the control: some lay where there was no water
    CHECK(trial.silt != start);
}

TEST_CASE("silt leaves through open sides, sinks by its depth, is picked up by water that passes sand, and has an end") {
    SurfaceTrial trial(12, 5);
    trial.params.silt_fall = 0;
    trial.params.silt_rate = 0;
    trial.fill(trial.water, 1, 12, 5);
    trial.fill(trial.silt, 0.5F, 12, 5);
    trial.fill(trial.velocity_x, -1.7F, 13, 5); // outer faces, too
    const float moved = std::floor(trial.params.k * (1.7F * 0.5F) / quantum) * quantum;
    trial.carry_silt();
    CHECK(trial.at(trial.silt, 0, 2) == 0.5F);
    CHECK(trial.at(trial.silt, 11, 2) == 0.5F - moved);
    CHECK(trial.total(trial.silt) == 0.5 * 60 - 5 * static_cast<double>(moved));

    trial.fill(trial.velocity_x, 0, 13, 5);
    trial.params.silt_fall = 0x1p-7F;
    for (const float depth : {1.0F, 0.25F, 0x1p-7F, 0x1p-8F}) { // the last two: all of it reaches the ground
        trial.fill(trial.water, depth, 12, 5);
        trial.fill(trial.silt, 0.5F, 12, 5);
        trial.carry_silt();
        const float share = std::min(0x1p-7F / depth, 1.0F);
        CHECK(trial.at(trial.silt, 6, 2) == std::max(0.5F - (std::floor(0.5F * share / quantum) + 1) * quantum, 0.0F));
    }
    trial.fill(trial.water, 1, 12, 5);
    trial.fill(trial.silt, 0x1p-15F, 12, 5);
    trial.carry_silt();
    CHECK(trial.total(trial.silt) == 0); // less than anybody sees

    trial.params.silt_fall = 0;
    trial.params.silt_rate = 0.01F;
    trial.params.inv_silt_speed2 = 4; // from 0.5 m/s on
    const auto rises = [&](float water_speed, float sand_speed, float sand, float depth = 1) {
        trial.fill(trial.silt, 0, 12, 5);
        trial.fill(trial.velocity_x, water_speed, 13, 5);
        trial.fill(trial.sand_x, sand_speed, 13, 5);
        trial.fill(trial.sand, sand, 12, 5);
        trial.fill(trial.water, depth + sand, 12, 5);
        trial.carry_silt();
        return trial.at(trial.silt, 6, 2);
    };
    const float due = std::floor(0.03F / quantum) * quantum; // 0.01 (1/0.25 - 1)
    CHECK(std::abs(rises(1, 0, 0.5F) - due) <= quantum);
    CHECK(std::abs(rises(-1, 0, 0.5F) - due) <= quantum);
    CHECK(std::abs(rises(0, 1, 0.5F) - due) <= quantum); // a slide stirs up still water
    CHECK(rises(1, 1, 0.5F) == 0);                       // sand that goes along
    CHECK(rises(0.5F, 0, 0.5F) == 0);
    CHECK(rises(1, 0, 0) == 0);                               // rock
    CHECK(std::abs(rises(1, 0, 0.5F, 8) - 0.01F) <= quantum); // 0.01 (4/8^(1/3) - 1)
    CHECK(std::abs(rises(1, 0, 0.5F, 0.125F) - 0.07F) <= 2 * quantum);
    trial.params.silt_rate = 1e6F;
    CHECK(rises(1, 0, 0.5F) == 8);
    trial.fill(trial.sand, 0.5F, 12, 5);
    trial.fill(trial.water, 0.5F, 12, 5); // all of it in the pores: none runs over the sand
    trial.fill(trial.silt, 1, 12, 5);
    trial.carry_silt();
    CHECK(trial.total(trial.silt) == 0);
}
