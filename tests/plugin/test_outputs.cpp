// Published outputs: what they hold, sets in turn, copies in host memory, interpolation, and that nothing asked for costs
// nothing and changes nothing.
#include "tests/plugin/plugin_world.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <map>
#include <utility>

using namespace plugin_test;

namespace {

constexpr uint32_t every_output = WADI_OUTPUT_BIT(WADI_OUTPUT_COUNT) - 1u;

int components(wadi_output output) {
    const bool four = output == WADI_OUTPUT_NORMAL || output == WADI_OUTPUT_PACKED;
    return four ? 4 : output == WADI_OUTPUT_FLOW || output == WADI_OUTPUT_SAND_VELOCITY ? 2 : 1;
}

// An IEEE binary16 number that is finite.
double half_value(unsigned bits) {
    const int exponent = static_cast<int>(bits >> 10 & 31u), mantissa = static_cast<int>(bits & 1023u);
    const double size = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
    return (bits & 0x8000u) != 0 ? -size : size;
}

// Whether the bits are those of the 16-bit float nearest to a value, the even one of two.
bool nearest_half(unsigned bits, double value) {
    const double miss = std::abs(half_value(bits) - value);
    for (const unsigned beside : {bits + 1, bits - 1}) {
        if ((bits & 0x7fffu) == 0 && beside == bits - 1) continue;
        const double other = std::abs(half_value(beside) - value);
        if (other < miss || (other == miss && (bits & 1u) != 0)) return false;
    }
    return bits != 0x8000u;
}

// One component of a published field as nx * ny floats.
std::vector<float> dense(const World& world, const void* first, uint64_t row_pitch, int floats, int component) {
    std::vector<float> values;
    for (int j = 0; j < world.ny; ++j) {
        const auto* row = static_cast<const float*>(first) + static_cast<uint64_t>(j) * row_pitch / 4;
        for (int i = 0; i < world.nx; ++i) values.push_back(row[i * floats + component]);
    }
    return values;
}

std::vector<float> host(const World& world, wadi_output output, int component = 0) {
    const float* data = nullptr;
    uint64_t pitch = 0;
    REQUIRE_MESSAGE(wadi_world_get_host_output(world.id, output, &data, &pitch, nullptr) == WADI_OK,
                    std::string(wadi_get_last_error()));
    CHECK(pitch % (4u * static_cast<unsigned>(components(output))) == 0);
    return dense(world, data, pitch, components(output), component);
}

wadi_output_view view(const World& world, wadi_output output, wadi_output_set set) {
    auto view = wadi_default_output_view();
    REQUIRE_MESSAGE(wadi_world_get_view(world.id, output, set, &view) == WADI_OK, std::string(wadi_get_last_error()));
    CHECK(view.format == components(output));
    CHECK(view.nx == world.nx);
    CHECK(view.ny == world.ny);
    CHECK(view.offset + static_cast<uint64_t>(world.ny - 1) * view.row_pitch + static_cast<uint64_t>(world.nx) * 4 <=
          view.buffer_bytes);
    return view;
}

// CPU backend: the field behind a view, once the device is done.
std::vector<float> on_cpu(const World& world, wadi_output output, wadi_output_set set) {
    world.wait();
    const auto v = view(world, output, set);
    CHECK(v.finished == 1);
    REQUIRE(v.handle_kind == WADI_HANDLE_HOST_POINTER);
    return dense(world, reinterpret_cast<const char*>(static_cast<uintptr_t>(v.handle)) + v.offset, v.row_pitch,
                 components(output), 0);
}

float at(const World& world, const std::vector<float>& field, int i, int j) {
    return field[static_cast<std::size_t>(j) * static_cast<std::size_t>(world.nx) + static_cast<std::size_t>(i)];
}

} // namespace

TEST_CASE("published fields are those that reading gives, on every backend") {
    const std::map<wadi_output, wadi_field> same = {{WADI_OUTPUT_TERRAIN, WADI_FIELD_TERRAIN},
                                                    {WADI_OUTPUT_FREE_SURFACE, WADI_FIELD_FREE_SURFACE},
                                                    {WADI_OUTPUT_SAND_DEPTH, WADI_FIELD_SAND_DEPTH},
                                                    {WADI_OUTPUT_WATER_DEPTH, WADI_FIELD_WATER_DEPTH},
                                                    {WADI_OUTPUT_SATURATION, WADI_FIELD_SATURATION},
                                                    {WADI_OUTPUT_FLOW, WADI_FIELD_WATER_VELOCITY_X},
                                                    {WADI_OUTPUT_SAND_VELOCITY, WADI_FIELD_SAND_VELOCITY_X}};
    for (const auto& backend : backends()) {
        CAPTURE(backend);
        const World world(backend, 40, 36, 0.01, 0, 3); // a dam that breaks over the sand
        REQUIRE(wadi_world_set_host_outputs(world.id, every_output) == WADI_OK);
        const float* none = nullptr;
        CHECK(wadi_world_get_host_output(world.id, WADI_OUTPUT_FLOW, &none, nullptr, nullptr) == WADI_NOT_READY);
        world.keep_all_steps();
        for (int n = 0; n < 30; ++n) world.update(step_time);
        world.wait();
        world.update(0); // copies that found no memory free while the device was behind
        world.wait();
        uint64_t step = 0;
        REQUIRE(wadi_world_get_host_output(world.id, WADI_OUTPUT_FLOW, &none, nullptr, &step) == WADI_OK);
        CHECK(step == 30);
        for (const auto& [output, field] : same) {
            CAPTURE(output);
            CHECK(host(world, output) == world.read(field));
        }
        CHECK(host(world, WADI_OUTPUT_FLOW, 1) == world.read(WADI_FIELD_WATER_VELOCITY_Y));
        CHECK(host(world, WADI_OUTPUT_SAND_VELOCITY, 1) == world.read(WADI_FIELD_SAND_VELOCITY_Y));
        const auto kind = backend == "cpu"      ? WADI_HANDLE_HOST_POINTER
                          : backend == "vulkan" ? WADI_HANDLE_VULKAN_BUFFER
                                                : WADI_HANDLE_CUDA_POINTER;
        CHECK(view(world, WADI_OUTPUT_NORMAL, WADI_OUTPUT_CURRENT).handle_kind == kind);
        CHECK(view(world, WADI_OUTPUT_NORMAL, WADI_OUTPUT_CURRENT).handle != 0);
        CHECK(view(world, WADI_OUTPUT_NORMAL, WADI_OUTPUT_CURRENT).handle !=
              view(world, WADI_OUTPUT_NORMAL, WADI_OUTPUT_PREVIOUS).handle);
        const auto terrain = world.read(WADI_FIELD_TERRAIN), sand = world.read(WADI_FIELD_SAND_DEPTH);
        const auto surface = world.read(WADI_FIELD_FREE_SURFACE), solid = host(world, WADI_OUTPUT_SAND_SURFACE);
        const auto up = host(world, WADI_OUTPUT_NORMAL, 2), east = host(world, WADI_OUTPUT_NORMAL, 0);
        const auto north = host(world, WADI_OUTPUT_NORMAL, 1);
        const auto foam = host(world, WADI_OUTPUT_FOAM), smooth = host(world, WADI_OUTPUT_SMOOTH_SURFACE);
        float most_foam = 0;
        for (std::size_t n = 0; n < solid.size(); ++n) {
            CHECK(solid[n] == terrain[n] + sand[n]);
            CHECK(up[n] * up[n] + east[n] * east[n] + north[n] * north[n] == doctest::Approx(1).epsilon(1e-5));
            CHECK(foam[n] >= 0.0F);
            CHECK(foam[n] <= 1.0F);
            most_foam = std::max(most_foam, foam[n]);
        }
        CHECK(most_foam > 0.0F);
        const int i = 9, j = 20;
        CHECK(at(world, east, i, j) / at(world, up, i, j) ==
              doctest::Approx(at(world, surface, i - 1, j) - at(world, surface, i + 1, j)).epsilon(1e-4));
        float sum = 0;
        for (int b = -1; b <= 1; ++b) {
            for (int a = -1; a <= 1; ++a)
                sum += static_cast<float>((2 - std::abs(a)) * (2 - std::abs(b))) * at(world, surface, i + a, j + b);
        }
        CHECK(at(world, smooth, i, j) == doctest::Approx(sum / 16));
    }
}

TEST_CASE("packed outputs hold what its four outputs hold, those of 16 bits the nearest to it, on every backend") {
    CHECK(nearest_half(0x3c00, 1)); // controls
    CHECK(nearest_half(0xbc00, -1.0004));
    CHECK(nearest_half(0x0001, 5e-8));
    CHECK_FALSE(nearest_half(0x3c01, 1));
    CHECK_FALSE(nearest_half(0x3c01, 1 + std::ldexp(1, -11)));
    for (const auto& backend : backends()) {
        CAPTURE(backend);
        const World world(backend, 40, 36, 0.01, 0, 3);
        const std::vector<float> pit(40 * 36, -1.3F); // elevations of both signs
        const wadi_region low{0, 0, 40, 18};
        REQUIRE(wadi_world_write_region(world.id, WADI_FIELD_TERRAIN, &low, pit.data(), 40 * 18) == WADI_OK);
        REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_PACKED_HALF)) == WADI_OK);
        REQUIRE(wadi_world_set_host_outputs(world.id, every_output) == WADI_OK);
        world.keep_all_steps();
        for (int n = 0; n < 30; ++n) world.update(step_time);
        world.wait();
        world.update(0);
        world.wait();
        const float* data = nullptr;
        uint64_t pitch = 0;
        REQUIRE(wadi_world_get_host_output(world.id, WADI_OUTPUT_PACKED_HALF, &data, &pitch, nullptr) == WADI_OK);
        const wadi_output_view seen = [&] {
            auto found = wadi_default_output_view();
            CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_PACKED_HALF, WADI_OUTPUT_CURRENT, &found) == WADI_OK);
            return found;
        }();
        CHECK(seen.format == WADI_FORMAT_R16G16B16A16_FLOAT);
        CHECK(seen.row_pitch == pitch);
        CHECK(seen.offset % 8 == 0);
        CHECK(view(world, WADI_OUTPUT_PACKED, WADI_OUTPUT_CURRENT).row_pitch == 2 * pitch);
        const wadi_output channels[4] = {WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_WATER_DEPTH, WADI_OUTPUT_FOAM,
                                         WADI_OUTPUT_SATURATION};
        for (int channel = 0; channel < 4; ++channel) {
            CAPTURE(channel);
            const auto alone = host(world, channels[channel]);
            CHECK(host(world, WADI_OUTPUT_PACKED, channel) == alone);
            CHECK(*std::max_element(alone.begin(), alone.end()) > 0.0F);
            int wrong = 0;
            for (int j = 0; j < world.ny; ++j) {
                const auto* row = reinterpret_cast<const uint16_t*>(data) + static_cast<uint64_t>(j) * pitch / 2;
                for (int i = 0; i < world.nx; ++i)
                    wrong += nearest_half(row[i * 4 + channel], static_cast<double>(at(world, alone, i, j))) ? 0 : 1;
            }
            CHECK(wrong == 0);
        }
        const auto surface = host(world, WADI_OUTPUT_FREE_SURFACE);
        CHECK(*std::min_element(surface.begin(), surface.end()) < 0.0F);
    }
}

TEST_CASE("foam that drifts, wetness and silt are what a level with these effects publishes, on every backend") {
    const std::string traces =
        R"(, "effects": {"foam": "on", "wetness": "on", "silt": "on"}, "surface": {"wetness_half_life": 5})";
    for (const auto& backend : backends()) {
        CAPTURE(backend);
        const World world(backend, 40, 36, 0.01, 0, 1.5F, traces), plain(backend);
        for (const World* each : {&world, &plain}) {
            REQUIRE(wadi_world_set_host_outputs(each->id, every_output) == WADI_OK);
            REQUIRE(wadi_world_step(each->id, 150) == WADI_OK);
            each->update(0);
            REQUIRE(wadi_world_wait_for_outputs(each->id) == WADI_OK);
        }
        auto foam = world.read(WADI_FIELD_FOAM);
        const auto wetness = world.read(WADI_FIELD_WETNESS);
        CHECK(*std::max_element(foam.begin(), foam.end()) > 0.1F);
        CHECK(*std::max_element(wetness.begin(), wetness.end()) == 1.0F);
        CHECK(*std::min_element(wetness.begin(), wetness.end()) == 0.0F);
        for (float& f : foam) f = std::min(f, 1.0F);
        CHECK(host(world, WADI_OUTPUT_FOAM) == foam);
        CHECK(host(world, WADI_OUTPUT_PACKED, 2) == foam);
        CHECK(host(world, WADI_OUTPUT_WETNESS) == wetness);
        CHECK(host(world, WADI_OUTPUT_FREE_SURFACE) == host(plain, WADI_OUTPUT_FREE_SURFACE)); // it moves nothing
        const auto moment = host(plain, WADI_OUTPUT_FOAM), none = std::vector<float>(moment.size());
        CHECK(moment != foam);
        CHECK(moment != none);
        CHECK(plain.read(WADI_FIELD_FOAM) == none);
        CHECK(plain.read(WADI_FIELD_WETNESS) == none);
        CHECK(host(plain, WADI_OUTPUT_WETNESS) == none);
        CHECK(host(world, WADI_OUTPUT_SILT) == world.read(WADI_FIELD_SILT));
        CHECK(host(world, WADI_OUTPUT_SILT) != none);
        CHECK(plain.read(WADI_FIELD_SILT) == none);
        CHECK(host(plain, WADI_OUTPUT_SILT) == none);
    }
}

TEST_CASE("a world of water alone publishes sand as zero") {
    const std::string text = R"({"format_version": 1, "name": "pond", "grid": {"nx": 8, "ny": 6, "dx": 0.5}, "dt": 0.01})";
    const std::vector<float> water(48, 1.0F);
    auto arrays = wadi_default_world_arrays();
    arrays.settings_json = text.c_str();
    arrays.nx = 8;
    arrays.ny = 6;
    arrays.water = water.data();
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    wadi_world_id id{};
    REQUIRE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK);
    REQUIRE(wadi_world_set_host_outputs(id, every_output) == WADI_OK);
    auto frame = wadi_default_frame();
    REQUIRE(wadi_world_update(id, 3 * step_time, &frame) == WADI_OK);
    std::vector<float> read(48);
    REQUIRE(wadi_world_read_field(id, WADI_FIELD_TERRAIN, read.data(), read.size()) == WADI_OK);
    const float* data = nullptr;
    for (const auto output : {WADI_OUTPUT_SAND_DEPTH, WADI_OUTPUT_SAND_VELOCITY, WADI_OUTPUT_SATURATION, WADI_OUTPUT_FOAM}) {
        REQUIRE(wadi_world_get_host_output(id, output, &data, nullptr, nullptr) == WADI_OK);
        CHECK(data[0] == 0.0F);
        CHECK(data[7] == 0.0F);
    }
    REQUIRE(wadi_world_get_host_output(id, WADI_OUTPUT_WATER_DEPTH, &data, nullptr, nullptr) == WADI_OK);
    CHECK(data[3] == 1.0F);
    CHECK(wadi_destroy_world(id) == WADI_OK);
}

TEST_CASE("sets in turn: handles stay, current becomes previous, one publish per update") {
    const World world("cpu");
    REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE)) == WADI_OK);
    auto v = wadi_default_output_view();
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT, &v) == WADI_NOT_READY);
    CHECK(world.update(0).published_step == 0); // the state at the start
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_PREVIOUS, &v) == WADI_NOT_READY);
    const auto first = on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT);
    CHECK(first == world.read(WADI_FIELD_FREE_SURFACE));
    std::vector<uint64_t> handles;
    auto before = first;
    for (uint64_t n = 0; n < 7; ++n) {
        handles.push_back(view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT).handle);
        CHECK(world.update(2 * step_time).published_step == 2 * (n + 1));
        CHECK(on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_PREVIOUS) == before);
        before = on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT);
        CHECK(before == world.read(WADI_FIELD_FREE_SURFACE));
        CHECK(view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_PREVIOUS).step == 2 * n);
        CHECK(view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT).step == 2 * (n + 1));
    }
    CHECK(handles[0] != handles[1]);
    CHECK(handles[1] != handles[2]);
    for (std::size_t n = 3; n < handles.size(); ++n) CHECK(handles[n] == handles[n - 3]);
    // An update without a step publishes nothing; steps beside the clock are published by the next update.
    CHECK(world.update(1).published_step == 14);
    REQUIRE(wadi_world_step(world.id, 3) == WADI_OK);
    CHECK(world.update(1).published_step == 17);
    CHECK(on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT) == world.read(WADI_FIELD_FREE_SURFACE));
    // Another mask starts anew.
    REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE) | WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM)) ==
            WADI_OK);
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT, &v) == WADI_NOT_READY);
    CHECK(world.update(0).published_step == 17);
    CHECK(on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT) == world.read(WADI_FIELD_FREE_SURFACE));
}

TEST_CASE("a state that was loaded or gone back to is published, also at a step that was published before") {
    const World world("cpu");
    REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE)) == WADI_OK);
    REQUIRE(wadi_world_set_rollback(world.id, 2, 1) == WADI_OK);
    uint64_t size = 0;
    REQUIRE(wadi_world_save(world.id, nullptr, &size) == WADI_OK);
    std::vector<unsigned char> start(size);
    REQUIRE(wadi_world_save(world.id, start.data(), &size) == WADI_OK);
    CHECK(world.update(2 * step_time).published_step == 2);
    const auto first = on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT);
    auto edit = wadi_default_edit();
    edit.layer = WADI_LAYER_WATER;
    edit.x0 = edit.y0 = 8;
    edit.amount = 0.5;
    for (const bool load : {true, false}) {
        CAPTURE(load);
        if (load) REQUIRE(wadi_world_load(world.id, start.data(), size) == WADI_OK);
        if (!load) REQUIRE(wadi_world_roll_back(world.id, 1, nullptr) == WADI_OK);
        const auto before = on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT);
        REQUIRE(wadi_world_edit(world.id, &edit, 1) == WADI_OK);
        REQUIRE(wadi_world_step(world.id, load ? 2 : 1) == WADI_OK);
        CHECK(world.update(0).published_step == 2);
        const auto now = on_cpu(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT);
        CHECK(now == world.read(WADI_FIELD_FREE_SURFACE));
        CHECK(now != before);
        CHECK(now != first);
        const auto handle = view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT).handle;
        CHECK(world.update(0).published_step == 2); // once
        CHECK(view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT).handle == handle);
    }
}

TEST_CASE("the interpolated set lies between the publishes, at the host's time") {
    for (const bool spread : {false, true}) {
        const World world("cpu");
        auto settings = wadi_default_update_settings();
        settings.interpolate_outputs = 1;
        settings.spread = spread ? 1 : 0;
        REQUIRE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK);
        REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE) | WADI_OUTPUT_BIT(WADI_OUTPUT_FLOW)) ==
                WADI_OK);
        auto v = wadi_default_output_view();
        CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_INTERPOLATED, &v) == WADI_NOT_READY);
        world.update(0);
        const auto check = [&](double factor) {
            // Not through a read, which would finish a step begun in parts.
            while (view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_INTERPOLATED).finished == 0) {
            }
            const auto values = [&](wadi_output_set set) {
                const auto found = view(world, WADI_OUTPUT_FREE_SURFACE, set);
                return dense(world, reinterpret_cast<const char*>(static_cast<uintptr_t>(found.handle)) + found.offset,
                             found.row_pitch, 1, 0);
            };
            const auto from = values(WADI_OUTPUT_PREVIOUS), to = values(WADI_OUTPUT_CURRENT);
            const auto between = values(WADI_OUTPUT_INTERPOLATED);
            for (std::size_t n = 0; n < from.size(); ++n)
                CHECK(between[n] == doctest::Approx(from[n] + static_cast<float>(factor) * (to[n] - from[n])).epsilon(1e-6));
        };
        world.update(step_time);
        check(0);
        world.update(step_time / 4);
        check(0.25);
        world.update(step_time / 2);
        check(0.75);
        // Three steps at once: a quarter before the last of three is 2.75 steps, less the one that is shown late.
        world.update(3 * step_time);
        check(1 - 0.25 / 3);
        CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FLOW, WADI_OUTPUT_INTERPOLATED, &v) == WADI_ERROR_BAD_ARGUMENT);
    }
}

TEST_CASE("host copies arrive without waiting, and stay for two updates") {
    const World world("cpu", 256, 256);
    REQUIRE(wadi_world_set_host_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_WATER_DEPTH)) == WADI_OK);
    world.update(0);
    world.wait();
    uint64_t newest = 0;
    for (int n = 0; n < 12; ++n) {
        const float* data = nullptr;
        const float* again = nullptr;
        uint64_t pitch = 0, step = 0;
        REQUIRE(wadi_world_get_host_output(world.id, WADI_OUTPUT_WATER_DEPTH, &data, &pitch, &step) == WADI_OK);
        CHECK(step >= newest);
        newest = step;
        const auto then = dense(world, data, pitch, 1, 0);
        if (n % 3 == 0) world.wait(); // a newer one arrives: the same is given until the next update
        REQUIRE(wadi_world_get_host_output(world.id, WADI_OUTPUT_WATER_DEPTH, &again, nullptr, nullptr) == WADI_OK);
        CHECK(again == data);
        world.update(step_time);
        if (n % 2 == 0) world.wait();
        CHECK(dense(world, data, pitch, 1, 0) == then);
    }
    world.update(0);
    const float* data = nullptr;
    uint64_t step = 0;
    world.wait();
    world.update(0);
    REQUIRE(wadi_world_get_host_output(world.id, WADI_OUTPUT_WATER_DEPTH, &data, nullptr, &step) == WADI_OK);
    CHECK(step > 1);
}

TEST_CASE("a host that waits for outputs gets those of its newest update, and keeps what it was given before") {
    for (const auto& backend : backends()) {
        for (const bool spread : {false, true}) {
            CAPTURE(backend);
            CAPTURE(spread);
            const World world(backend, 96, 64);
            CHECK(wadi_world_wait_for_outputs(world.id) == WADI_ERROR_BAD_ARGUMENT);
            CHECK(error_mentions("no output was asked for"));
            REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM) | WADI_OUTPUT_TILES_BIT) == WADI_OK);
            REQUIRE(wadi_world_set_host_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_WATER_DEPTH)) == WADI_OK);
            CHECK(wadi_world_wait_for_outputs(world.id) == WADI_NOT_READY);
            auto settings = wadi_default_update_settings();
            settings.max_steps_in_flight = 0;
            settings.spread = spread ? 1 : 0;
            REQUIRE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK);
            struct Given {
                const float* data;
                uint64_t pitch;
                std::vector<float> then;
            };
            std::vector<Given> older, newer;
            int late = 0;
            for (int n = 0; n < 12; ++n) {
                const auto frame = world.update(n == 7 ? 0 : 3 * step_time + 123);
                older = std::exchange(newer, {});
                for (const auto& given : older) CHECK(dense(world, given.data, given.pitch, 1, 0) == given.then);
                const auto get = [&] {
                    Given given{};
                    uint64_t step = 0;
                    const auto result =
                        wadi_world_get_host_output(world.id, WADI_OUTPUT_WATER_DEPTH, &given.data, &given.pitch, &step);
                    if (result == WADI_NOT_READY) return UINT64_MAX;
                    REQUIRE(result == WADI_OK);
                    given.then = dense(world, given.data, given.pitch, 1, 0);
                    newer.push_back(given);
                    return step;
                };
                if (n % 3 != 1) late += get() != frame.total_steps ? 1 : 0;
                if (n % 4 == 3) continue; // and sometimes it does not wait
                REQUIRE_MESSAGE(wadi_world_wait_for_outputs(world.id) == WADI_OK, std::string(wadi_get_last_error()));
                CHECK(get() == frame.total_steps);
                CHECK(view(world, WADI_OUTPUT_FOAM, WADI_OUTPUT_CURRENT).finished == 1);
                uint64_t tiles_step = 0;
                uint32_t count = 0;
                REQUIRE(wadi_world_get_tiles(world.id, nullptr, &count, &tiles_step) == WADI_OK);
                CHECK(tiles_step == frame.total_steps);
                if (!spread) CHECK(newer.back().then == world.read(WADI_FIELD_WATER_DEPTH));
                for (const auto& given : older) CHECK(dense(world, given.data, given.pitch, 1, 0) == given.then);
            }
            CHECK(late > 0);                                  // control: without waiting it is an older one
            REQUIRE(wadi_world_step(world.id, 2) == WADI_OK); // beside the clock: published by an update
            const auto frame = world.update(0);
            REQUIRE(wadi_world_wait_for_outputs(world.id) == WADI_OK);
            uint64_t step = 0;
            const float* data = nullptr;
            REQUIRE(wadi_world_get_host_output(world.id, WADI_OUTPUT_WATER_DEPTH, &data, nullptr, &step) == WADI_OK);
            CHECK(step == frame.total_steps);
        }
    }
}

TEST_CASE("what is not asked for costs nothing, and nothing published changes the state") {
    for (const auto& backend : backends()) {
        CAPTURE(backend);
        const World plain(backend), world(backend);
        const auto bytes = device_bytes(world.id);
        auto settings = wadi_default_update_settings();
        settings.max_steps_in_flight = 0;
        settings.interpolate_outputs = 1;
        REQUIRE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK);
        plain.keep_all_steps();
        CHECK(device_bytes(world.id) == bytes);
        REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM)) == WADI_OK);
        const auto foam = device_bytes(world.id) - bytes;
        CHECK(foam > 4 * 40 * 36 * 4);
        CHECK(foam < 4 * 80 * 50 * 4);
        REQUIRE(wadi_world_set_outputs(world.id, every_output | WADI_OUTPUT_TILES_BIT) == WADI_OK);
        REQUIRE(wadi_world_set_host_outputs(world.id, every_output) == WADI_OK);
        for (int n = 0; n < 20; ++n) {
            world.update(step_time + 7);
            plain.update(step_time + 7);
        }
        CHECK(world.stats().hash == plain.stats().hash);
        REQUIRE(wadi_world_set_outputs(world.id, 0) == WADI_OK);
        REQUIRE(wadi_world_set_host_outputs(world.id, 0) == WADI_OK);
        for (const World* each : {&world, &plain}) each->read(WADI_FIELD_FREE_SURFACE); // makes a buffer of the reader's
        CHECK(device_bytes(world.id) == device_bytes(plain.id));
    }
}

TEST_CASE("outputs refuse what they must") {
    const World world("cpu");
    auto v = wadi_default_output_view();
    const float* data = nullptr;
    CHECK(wadi_world_set_outputs(world.id, 1u << WADI_OUTPUT_COUNT) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("mask"));
    CHECK(wadi_world_set_host_outputs(world.id, WADI_OUTPUT_TILES_BIT) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_set_outputs({0, 0}, 1) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FOAM, WADI_OUTPUT_CURRENT, &v) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("not asked for"));
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_COUNT, WADI_OUTPUT_CURRENT, &v) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("0 ... " + std::to_string(WADI_OUTPUT_COUNT - 1)));
    REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM)) == WADI_OK);
    world.update(0);
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FOAM, static_cast<wadi_output_set>(3), &v) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FOAM, WADI_OUTPUT_INTERPOLATED, &v) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FOAM, WADI_OUTPUT_CURRENT, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    v.struct_size = 3;
    CHECK(wadi_world_get_view(world.id, WADI_OUTPUT_FOAM, WADI_OUTPUT_CURRENT, &v) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("struct_size"));
    CHECK(wadi_world_get_host_output(world.id, WADI_OUTPUT_FOAM, &data, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_host_output(world.id, WADI_OUTPUT_FOAM, nullptr, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_host_output(world.id, WADI_OUTPUT_COUNT, &data, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    auto settings = wadi_default_update_settings();
    settings.interpolate_outputs = 7;
    CHECK(wadi_world_set_update_settings(world.id, &settings) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("interpolate_outputs"));
}
