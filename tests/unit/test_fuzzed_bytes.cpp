// Inputs that a libFuzzer target of tests/fuzz/targets once failed on. The sanitizer presets see what these runs must not do.
#include "engine/edits/command_log.hpp"
#include "engine/saves/sealed_bytes.hpp"
#include <doctest/doctest.h>

using namespace wadi;

TEST_CASE("a command log with a stamp of no pixels is refused, and nothing is copied to nowhere") {
    std::vector<std::byte> bytes(56); // header, digest and number of commands, then one stamp of 0 x 0
    begin_sealed(bytes, "WADICMDS", 2);
    std::size_t at = 12;
    put(std::span<std::byte>(bytes), at, std::uint32_t{1});
    seal(bytes);
    const auto list = read_commands(bytes);
    REQUIRE_FALSE(list);
    CHECK(list.status().message.find("a stamp has no pixels") != std::string::npos);
    bytes[50] = std::byte{1}; // negative control: a broken seal is another refusal
    CHECK(read_commands(bytes).status().message.find("checksum") != std::string::npos);
    CHECK(list.status().message.find("checksum") == std::string::npos);
}
