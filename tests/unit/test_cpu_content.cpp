// What the stages say of themselves where fields hold nothing, on the CPU: the bits of a run over everything, for every mask; and
// each field that a stage names is needed: without it some bits differ.
#include "backends/cpu/content.hpp"
#include "backends/registry.hpp"
#include "engine/step/plan/world_params.hpp"
#include "tests/support/worlds.hpp"
#include <array>
#include <cstring>
#include <doctest/doctest.h>
#include <map>
#include <random>

using namespace wadi;
using namespace wadi::cpu;

namespace {

using Words = std::vector<std::uint32_t>;

constexpr int content_nx = 1058, content_ny = 27; // more than 64 blocks; no multiples of their sides
const FieldLayout content_layout{content_nx, content_ny};

/// Buffers of a stage for a mask: random numbers, and zeros in rectangles that lie across blocks, for each lack others.
struct ContentTrial {
    const compute::StageInfo& stage;
    std::uint32_t effects;
    std::vector<Words> fields;

    ContentTrial(const compute::StageInfo& info, std::uint32_t mask, std::mt19937& random) : stage(info), effects(mask) {
        for (const auto& binding : stage.bindings) {
            const bool depth = binding.name.find("height") != binding.name.npos || binding.name == "mixed_predicted" ||
                               binding.name.find("scale") != binding.name.npos;
            const bool fast = binding.name.find("velocity") != binding.name.npos; // some beyond the clamp
            std::uniform_real_distribution<float> number(depth ? 0.01F : fast ? -30.0F : -1.0F, fast ? 30.0F : 1.0F);
            Words words(content_layout.size());
            for (auto& word : words) word = std::bit_cast<std::uint32_t>(number(random));
            fields.push_back(std::move(words));
        }
        for (const auto& lack : stage.lacks) {
            for (int n = 0; n < 20; ++n) {
                const int i0 = static_cast<int>(random() % 1100) - 40, j0 = static_cast<int>(random() % 30) - 12;
                const int i1 = i0 + 20 + static_cast<int>(random() % 90), j1 = j0 + 10 + static_cast<int>(random() % 30);
                clear(lack.slots, i0, j0, i1, j1);
            }
        }
    }
    void clear(std::uint32_t slots, int i0, int j0, int i1, int j1) {
        for (std::size_t n = 0; n < fields.size(); ++n) {
            if ((slots >> n & 1) == 0) continue;
            for (int j = std::max(j0, -GHOST); j < std::min(j1, content_ny + 1 + GHOST); ++j)
                for (int i = std::max(i0, -GHOST); i < std::min(i1, content_nx + 1 + GHOST); ++i)
                    fields[n][content_layout.index(i, j)] = 0;
        }
    }
    bool exists(std::size_t n) const { return stage.bindings[n].exists(effects); }
};

struct ContentRun {
    std::vector<Words> fields;
    bool true_to_fields = true; // what is known to hold nothing does
};

/// The stage over everything, or by `lacks`.
ContentRun run_trial(const ContentTrial& trial, int stage, const InstructionSet& set, const WorldParams& params,
                     const std::vector<compute::StageLack>* lacks) {
    ContentRun run{trial.fields};
    std::vector<void*> buffers;
    std::vector<unsigned long long> sizes;
    for (std::size_t n = 0; n < run.fields.size(); ++n) {
        buffers.push_back(trial.exists(n) ? run.fields[n].data() : nullptr);
        sizes.push_back(trial.exists(n) ? run.fields[n].size() * 4 : 0);
    }
    const StepInput input{};
    const auto range = compute::extent_range(trial.stage.extent, params);
    const StageCall call{set.select[stage](trial.effects), buffers.data(), sizes.data(), params, input, range};
    if (lacks == nullptr) {
        call(range.i0, range.i1, range.j0, range.j1);
        return run;
    }
    std::vector<std::unique_ptr<BlockContent>> owners;
    std::vector<BlockContent*> contents;
    for (std::size_t n = 0; n < run.fields.size(); ++n) {
        owners.push_back(trial.exists(n) ? std::make_unique<BlockContent>(content_layout, run.fields[n].data()) : nullptr);
        contents.push_back(owners.back().get());
    }
    const auto made = content_stage(trial.stage, *lacks, trial.effects, contents, buffers,
                                    [&](std::uint32_t effects) { return set.select[stage](effects); });
    if (!made.on()) return run_trial(trial, stage, set, params, nullptr);
    const Blocks blocks{content_layout};
    run_by_content(made, call, 0, 1);
    run_by_content(made, call, 1, blocks.rows());
    for (std::size_t n = 0; n < run.fields.size(); ++n) {
        if (!trial.exists(n)) continue;
        const BlockContent anew(content_layout, run.fields[n].data());
        for (int row = 0; row < blocks.rows(); ++row)
            for (int word = 0; word < anew.words(); ++word)
                run.true_to_fields &= (anew.word(row, word) & ~contents[n]->word(row, word)) == 0;
    }
    return run;
}

WorldParams content_params(std::uint32_t effects) {
    Settings settings;
    settings.grid = {content_nx, content_ny, 0.2};
    settings.dt = 0.015;
    auto& m = settings.material;
    m.young_modulus = 5e5;
    m.bed_friction = 0.01;
    m.manning = 0.02;
    m.bed_shear = 0.05;
    m.slope_normal = 1;
    m.internal_friction = 0.4;
    m.sand_viscosity = 0.05;
    m.retention = 0.3;
    m.flow_length = 2e-3;
    m.porosity = 0.4;
    m.conductivity = 1e-3;
    m.exchange_rate = 3e4;
    m.cohesion_dry = 500;
    settings.method.shock_viscosity = 0.25;
    settings.method.bulk_viscosity = 0.5;
    return derive_params(settings, effects);
}

/// Masks that the stage has code for, some of them where there are many, all effects among them.
std::vector<std::uint32_t> content_masks(int stage, const InstructionSet& set) {
    const std::uint32_t tested = compute::stage_table()[static_cast<std::size_t>(stage)].tested_effects;
    std::vector<std::uint32_t> masks;
    std::uint32_t mask = 0;
    do {
        if (set.select[stage](mask) != nullptr) masks.push_back(mask);
        mask = (mask - tested) & tested;
    } while (mask != 0);
    constexpr std::size_t most = 24;
    std::vector<std::uint32_t> some;
    for (std::size_t n = 0; n < std::min(most, masks.size()); ++n)
        some.push_back(masks[masks.size() - 1 - n * 37 % masks.size()]); // a prime: even steps would hold the lowest bits still
    return some;
}

/// Of what the stage reads in that mask another binding than this one.
std::uint32_t other_input(const compute::StageInfo& stage, std::uint32_t mask, std::uint32_t bit) {
    for (const auto& binding : stage.bindings) {
        if (binding.access == compute::Access::in && binding.exists(mask) && bit != 1U << binding.slot) return 1U << binding.slot;
    }
    return 0;
}

} // namespace

TEST_CASE("CPU: where fields hold nothing stages have the bits of a run over everything, and need each field that they name") {
    const auto& set = instruction_sets().front();
    const auto table = compute::stage_table();
    int with_lacks = 0;
    for (std::size_t n = 0; n < table.size(); ++n) {
        const auto& stage = table[n];
        if (stage.lacks.empty()) continue;
        CAPTURE(stage.name);
        ++with_lacks;
        std::map<std::pair<std::size_t, int>, bool> missed; // by lack and slot: bits differ without
        for (const std::uint32_t mask : content_masks(static_cast<int>(n), set)) {
            CAPTURE(mask);
            const WorldParams params = content_params(mask);
            for (const unsigned seed : {1U, 2U}) {
                std::mt19937 random(seed * 977 + mask);
                const ContentTrial trial(stage, mask, random);
                const auto index = static_cast<int>(n);
                const auto expected = run_trial(trial, index, set, params, nullptr);
                std::vector<compute::StageLack> lacks(stage.lacks.begin(), stage.lacks.end());
                const auto got = run_trial(trial, index, set, params, &lacks);
                CHECK(got.true_to_fields);
                for (std::size_t b = 0; b < stage.bindings.size(); ++b)
                    CHECK_MESSAGE(got.fields[b] == expected.fields[b], stage.bindings[b].name);
                for (std::size_t lack = 0; lack < lacks.size(); ++lack) {
                    for (const auto& binding : stage.bindings) {
                        const std::uint32_t bit = 1U << binding.slot;
                        if ((lacks[lack].slots & bit) == 0 || !binding.exists(mask)) continue;
                        auto wrong = lacks;
                        wrong[lack].slots &= ~bit;
                        if (wrong[lack].slots == 0) wrong[lack].slots = other_input(stage, mask, bit);
                        if (std::any_of(lacks.begin(), lacks.end(), [&](const auto& l) { return l.slots == wrong[lack].slots; }))
                            continue; // right as well
                        bool& known = missed[{lack, binding.slot}];
                        if (known) continue;
                        // Zeros where the field that is left out has none.
                        ContentTrial other = trial;
                        other.clear(wrong[lack].slots, 900, -GHOST, content_nx - 20, content_ny + 1 + GHOST);
                        other.clear(wrong[lack].slots, -GHOST, 8, 90, content_ny + 1 + GHOST);
                        known = run_trial(other, index, set, params, &wrong).fields !=
                                run_trial(other, index, set, params, nullptr).fields;
                    }
                }
            }
        }
        for (const auto& [key, differs] : missed)
            CHECK_MESSAGE(differs, "lack ", key.first, " names ", stage.bindings[static_cast<std::size_t>(key.second)].name,
                          " for nothing");
    }
    CHECK(with_lacks >= 16);
}

TEST_CASE("CPU: whoever writes a field, what stages know of it stays true") {
    auto opened = backends::open_device("cpu", 0, {});
    REQUIRE(opened);
    auto& device = **opened;
    const int stage = compute::find_stage("integrate_sand_height");
    auto pipeline = device.create_pipeline(stage, 0, {});
    REQUIRE(pipeline);
    const WorldParams params = content_params(0);
    const std::size_t bytes = content_layout.size() * 4;
    std::array<compute::Buffer, 5> buffers; // height, fluxes, what comes out; another height
    for (auto& buffer : buffers) {
        auto made = device.create_buffer({bytes, "field"});
        REQUIRE(made);
        buffer = *made;
    }
    const auto program = [&](const std::function<void(compute::ProgramBuilder&)>& ahead) {
        compute::ProgramBuilder builder("content");
        ahead(builder);
        builder.dispatch({*pipeline, stage, 0, {buffers.begin(), buffers.begin() + 4}, {0, 0, content_nx, content_ny}, "height"});
        auto compiled = device.compile(builder, params);
        REQUIRE(compiled);
        return *compiled;
    };
    const std::size_t cell = content_layout.index(77, 21);
    const auto height_after = [&](compute::Program run) {
        auto ticket = device.submit(run, StepInput{});
        REQUIRE(ticket);
        float height = -1;
        REQUIRE(device.read(buffers[3], cell * 4, std::as_writable_bytes(std::span(&height, 1))));
        return height;
    };
    const auto write = [&](compute::Buffer buffer, float height) {
        REQUIRE(device.write(buffer, cell * 4, std::as_bytes(std::span(&height, 1))));
    };
    const auto alone = program([](auto&) {});
    CHECK(height_after(alone) == 0);
    write(buffers[0], 2);
    CHECK(height_after(alone) == 2);
    write(buffers[0], 0);
    CHECK(height_after(alone) == 0);
    CHECK(height_after(program([&](auto& b) { b.fill({buffers[0], std::bit_cast<std::uint32_t>(3.0F)}); })) == 3);
    CHECK(height_after(program([&](auto& b) { b.fill({buffers[0], 0}); })) == 0);
    write(buffers[4], 4);
    CHECK(height_after(program([&](auto& b) { b.copy({buffers[4], buffers[0], 0, 0, bytes}); })) == 4);
    write(buffers[0], 0);
    CHECK(height_after(alone) == 0);
    write(buffers[3], 5); // where it comes out
    CHECK(height_after(alone) == 0);
    auto address = device.native(buffers[0]);
    REQUIRE(address);
    const float height = 6;
    REQUIRE(device.wait({}));
    std::memcpy(reinterpret_cast<float*>(address->handle) + cell, &height, 4);
    CHECK(height_after(alone) == 6);
}

TEST_CASE("CPU: water that a side lets into a dry world is seen at once") {
    auto scene = test::flat_scene(70, 50, 0.2, 0.015);
    scene.settings.sides[SIDE_WEST] = {SideKind::level, 0, 1e30, {{{0, 0.5}}}};
    auto world = test::make_world(scene);
    scene.settings.active_tiles = 8; // runs all that it runs in full
    auto expected = test::make_world(scene);
    for (auto* each : {world.get(), expected.get()}) test::step(*each, 20);
    CHECK(test::hash_of(*world) == test::hash_of(*expected));
    CHECK(world->reader().stats()->largest_water > 0);
}
