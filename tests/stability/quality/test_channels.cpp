// Streams between upright banks that run across the grid: what stairs of cells take of their way (NUMERICS 2.3).
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

struct ChannelCase {
    int order = 1;
    bool diagonal = true;
    bool mirrored = false;
    int teeth = 0; // a blocked cell on one bank in so many, 0: none
};

// Share of its speed that water 1 m deep keeps in 8 s in the middle of a level channel without friction, five cells in a row
// wide, that it fills evenly: no wave from the ends has come so far.
double speed_kept(const ChannelCase& channel) {
    const int n = 60;
    auto scene = flat_scene(n, n, 1, 0.05);
    scene.settings.method.water_transport_order = channel.order;
    const auto off_middle = [&](double x, double y) {
        if (!channel.diagonal) return y - n / 2.0 - 0.5;
        return channel.mirrored ? x + y - n : x - y;
    };
    const auto wet = [&](double x, double y) {
        const double off = off_middle(x, y);
        const bool tooth = channel.teeth > 0 && std::abs(off + 2) < 0.5 && static_cast<int>(x) % channel.teeth == 0;
        return std::abs(off) < 2.5 && !tooth;
    };
    scene.fill(scene.fields.terrain, [&](double x, double y) { return wet(x, y) ? 0 : 10; });
    scene.fill(scene.fields.water, [&](double x, double y) { return wet(x, y) ? 1 : 0; });
    scene.fill(scene.fields.velocity_x, [&](double x, double y) { return wet(x, y) ? 0.4 : 0; });
    scene.fill(scene.fields.velocity_y,
               [&](double x, double y) { return wet(x, y) && channel.diagonal ? (channel.mirrored ? -0.4 : 0.4) : 0; });
    auto world = make_world(scene);
    const auto speed = [&] {
        const auto u = cells_of(*world, "water_velocity_x");
        double sum = 0;
        for (int i = n / 2 - 4; i < n / 2 + 4; ++i)
            for (int j = 0; j < n; ++j) sum += u.at(i, j);
        return sum;
    };
    const double before = speed();
    step(*world, 160);
    CHECK(ledger_holds(*world, stats_of(*world)));
    return speed() / before;
}

} // namespace

TEST_CASE("stability: a channel across the grid leaves water its speed as one along the grid does") {
    for (const int order : {1, 2}) {
        CAPTURE(order);
        CHECK(speed_kept({.order = order, .diagonal = false}) > 0.99);
        CHECK(speed_kept({.order = order}) > 0.95); // 0.6 where blocked faces bring their 0
        CHECK(speed_kept({.order = order, .mirrored = true}) > 0.95);
        CHECK(speed_kept({.order = order, .diagonal = false, .teeth = 3}) <
              0.9); // control: what stands in the stream takes of it
    }
}
