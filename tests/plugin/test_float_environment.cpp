// A host's rounding mode, flushed denormals and traps change neither the library's bits nor are they changed by it.
#include "tests/plugin/abi_worlds.hpp"
#include <cfenv>
#include <doctest/doctest.h>
#include <thread>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

using namespace wadi::test;

namespace {

/// The default environment again when the case is over, however it ends.
struct EnvironmentKept {
    EnvironmentKept() { std::fegetenv(&before); }
    ~EnvironmentKept() { std::fesetenv(&before); }
    std::fenv_t before;
};

// Numbers whose last bit depends on the rounding, wherever the host's side of the library computes: reading, brushes, sources,
// sides.
const char* const uneven_level = R"({"format_version": 1, "name": "uneven", "dt": 0.013, "grid": {"nx": 41, "ny": 37, "dx": 0.31},
    "terrain": [{"shape": "plane", "height": 0.1, "slope_x": 0.053}], "sand": [{"shape": "cone", "center": [7.1, 5.3], "radius": 2.3, "height": 0.7}],
    "water": [{"shape": "box", "from": [0, 0], "to": [3.1, 11], "height": 1.1}], "material": {"cohesion_dry": 333.3},
    "sources": [{"shape": "disc", "center": [3.3, 3.7], "radius": 1.1, "rate": [[0, 0.013], [0.1, 0.17], [3, 0.7]]}],
    "sides": {"east": {"kind": "discharge", "value": [[0, 0.1], [1, 0.37]]}, "west": {"kind": "level", "value": 0.77}}, "rain": 1e-5})";

std::uint64_t hash_of_session(const std::string& backend) {
    auto options = cpu_device();
    options.backend = backend.c_str();
    options.threads = 2;
    wadi_world_id id{};
    REQUIRE_MESSAGE(wadi_create_world_from_level_text(uneven_level, nullptr, nullptr, nullptr, &options, &id) == WADI_OK,
                    std::string(wadi_get_last_error()));
    const AbiWorld world(id);
    auto edit = wadi_default_edit();
    edit.layer = WADI_LAYER_SAND;
    edit.x0 = 5.37;
    edit.y0 = 6.11;
    edit.radius = 1.3;
    edit.amount = 0.137;
    for (int n = 0; n < 12; ++n) {
        REQUIRE(wadi_world_edit(id, &edit, 1) == WADI_OK);
        REQUIRE(wadi_world_step(id, 1) == WADI_OK);
    }
    return hash_of(world);
}

} // namespace

TEST_CASE("a host's rounding mode changes no bit and is there again after every call") {
    const EnvironmentKept kept;
    for (const auto& backend : abi_backends()) {
        const auto expected = hash_of_session(backend);
        for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
            CAPTURE(backend);
            CAPTURE(mode);
            std::fesetround(mode);
            const auto hash = hash_of_session(backend);
            CHECK(std::fegetround() == mode);
            std::fesetround(FE_TONEAREST);
            CHECK(hash == expected);
            // The mode of the thread that makes the world is not that of those that use it.
            std::uint64_t of_thread = 0;
            std::thread([&] { of_thread = hash_of_session(backend); }).join();
            CHECK(of_thread == expected);
        }
    }
}

#if defined(__GLIBC__)
TEST_CASE("a host that traps floating-point exceptions meets none of the library's, and its own flags stay") {
    const EnvironmentKept kept;
    const auto expected = hash_of_session("cpu");
    const int all = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
    REQUIRE(feenableexcept(all) != -1);
    const auto hash = hash_of_session("cpu");
    CHECK(fegetexcept() == all);
    fedisableexcept(FE_ALL_EXCEPT);
    CHECK(hash == expected);
    const auto world = mixed_world("cpu", 24);
    std::feclearexcept(FE_ALL_EXCEPT);
    const auto stepped = wadi_world_step(world.id, 1);
    CHECK(std::fetestexcept(FE_ALL_EXCEPT) == 0);
    std::feraiseexcept(FE_DIVBYZERO);
    const auto again = wadi_world_step(world.id, 1);
    CHECK(std::fetestexcept(FE_ALL_EXCEPT) == FE_DIVBYZERO);
    CHECK((stepped == WADI_OK && again == WADI_OK));
}
#endif

namespace {

std::uint32_t rude_calls = 0;
bool denormals_kept = true;

void rude_log(void*, wadi_log_level, const char*) {
    ++rude_calls;
#if defined(__SSE__)
    denormals_kept = denormals_kept && (_mm_getcsr() & 0x8040) == 0;
#endif
    std::fesetround(FE_UPWARD);
}

} // namespace

TEST_CASE("a callback that leaves another rounding mode changes no bit, nor do denormals that a host flushes") {
    const EnvironmentKept kept;
    const auto with_log = [](wadi_log_callback log) {
        auto options = cpu_device();
        options.log = log;
        wadi_world_id id{};
        REQUIRE(wadi_create_world_from_level_text(uneven_level, nullptr, nullptr, nullptr, &options, &id) == WADI_OK);
        const AbiWorld world(id);
        auto edit = wadi_default_edit();
        edit.layer = WADI_LAYER_SAND;
        edit.x0 = edit.y0 = 1.37;
        edit.amount = 0.137;
        REQUIRE(wadi_world_edit(id, &edit, 1) == WADI_OK);
        step(world, 5);
        return hash_of(world);
    };
    const auto expected = with_log(nullptr);
#if defined(__SSE__)
    _mm_setcsr(_mm_getcsr() | 0x8040); // FTZ and DAZ
#endif
    const auto hash = with_log(rude_log);
    CHECK(std::fegetround() == FE_TONEAREST);
    CHECK(rude_calls > 0);
    CHECK(denormals_kept);
#if defined(__SSE__)
    CHECK((_mm_getcsr() & 0x8040) == 0x8040);
#endif
    CHECK(hash == expected);
}
