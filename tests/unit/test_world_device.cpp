#include "backends/registry.hpp"
#include "engine/step/run/named_buffers.hpp"
#include "engine/step/run/world_device.hpp"
#include <array>
#include <doctest/doctest.h>

using namespace wadi;

TEST_CASE("a world's device counts its buffers and tells of its loss once, whichever call shows it first") {
    auto opened = backends::open_device("cpu", -1, {});
    REQUIRE(opened);
    int told = 0;
    WorldDevice device(std::move(*opened), [&](const Status& lost) { told += lost.code == Code::device_lost ? 1 : 0; });
    NamedBuffers buffers(device);
    REQUIRE(buffers.keep_also({{64, "a"}, {64, "b"}}));
    REQUIRE(buffers.keep_also({{64, "b"}, {128, "c"}}));
    CHECK(device.bytes() == 256);
    const auto a = buffers["a"], b = buffers["b"];
    buffers.exchange("a", "b");
    buffers.keep_only({{64, "a"}});
    CHECK(device.bytes() == 64);
    CHECK(device.memory().size() == 1);
    CHECK(buffers["a"] == b);
    CHECK_FALSE(buffers["b"] == a);
    CHECK(device.lost());
    CHECK_FALSE(device.write({}, 0, {})); // refused, and no loss
    CHECK(device.lost());
    CHECK(told == 0);
    (*device).inject_device_lost();
    std::array<std::byte, 4> bytes{};
    CHECK_FALSE(device.read(buffers["a"], 0, bytes));
    CHECK(device.lost().code == Code::device_lost);
    CHECK_FALSE(device.create_buffer({64, "d"}));
    CHECK(told == 1);
    CHECK(device.bytes() == 64);
}
