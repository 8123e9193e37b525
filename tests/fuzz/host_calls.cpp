// What a host does to a running world, and the log of it.
#include "engine/settings/rules/material_keys.hpp"
#include "tests/fuzz/run.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace wadi::fuzz {

namespace {

// A host that calls at random. What it calls may be refused, but with bad_argument alone, and then nothing changes.
class Host {
  public:
    Host(const Case& c, Run& run) : run_(run), random_(c.seed ^ 0x2545f4914f6cdd1dull), grid_(c.scene.settings.grid) {
        size_ = c.scene.settings.method.largest_height / 256;
    }

    void call() {
        switch (random_.whole(0, 5)) {
        case 0:
            return stamp();
        case 1:
            return expect("trim", run_.world->commands().trim(), true);
        case 2:
            return change_material();
        case 3:
            return wrong_region();
        default:
            return write_region();
        }
    }

  private:
    void expect(const char* what, const Status& status, bool good) {
        if (run_.good() && !status && (good || status.code != Code::bad_argument)) run_.note(what, status);
    }

    std::vector<float> image(std::size_t count, double least, double most) {
        std::vector<float> values(count);
        for (float& value : values) value = static_cast<float>(random_.chance(0.2) ? 0 : random_.real(least, most));
        return values;
    }

    EditLayer layer() { return random_.pick({EditLayer::terrain, EditLayer::sand, EditLayer::water}); }

    Region region() {
        Region r;
        r.i0 = random_.whole(0, grid_.nx - 1);
        r.j0 = random_.whole(0, grid_.ny - 1);
        r.nx = random_.whole(1, grid_.nx - r.i0);
        r.ny = random_.whole(1, grid_.ny - r.j0);
        return r;
    }

    void stamp() {
        const int nx = random_.whole(1, 9), ny = random_.whole(1, 9);
        auto number = run_.world->edits().create_stamp(nx, ny, image(static_cast<std::size_t>(nx * ny), -1, 1));
        run_.note("create_stamp", number.status());
        if (!number) return;
        Edit edit;
        edit.kind = EditKind::stamp;
        edit.layer = layer();
        edit.stamp = *number;
        edit.x0 = random_.real(-2, grid_.nx) * grid_.dx;
        edit.y0 = random_.real(-2, grid_.ny) * grid_.dx;
        edit.x1 = edit.x0 + random_.log(0.1, 40) * grid_.dx;
        edit.y1 = edit.y0 + random_.log(0.1, 40) * grid_.dx;
        edit.amount = random_.real(-size_, size_);
        expect("stamp", run_.world->commands().edit(std::span(&edit, 1)), false);
    }

    void write_region() {
        const EditLayer to = layer();
        const Region r = region();
        expect("write_region", run_.world->commands().write_region(to, r, image(r.cells(), 0, size_)), false);
    }

    // With one value that is none, or a corner outside: refused, and not a bit has changed.
    void wrong_region() {
        Region r = region();
        auto values = image(r.cells(), 0, size_);
        if (random_.chance(0.5))
            values[random_.next() % values.size()] = random_.pick({std::numeric_limits<float>::quiet_NaN(), 3e38F, -3e38F});
        else
            r.i0 += grid_.nx;
        const std::uint64_t before = hash(run_);
        const auto status = run_.world->commands().write_region(layer(), r, values);
        if (status || status.code != Code::bad_argument) run_.failure = "a wrong region was not refused as bad_argument";
        if (hash(run_) != before && run_.good()) run_.failure = "a refused region changed the state";
    }

    void change_material() {
        const int key = random_.whole(0, static_cast<int>(material_keys().size()) - 1);
        const auto& known = material_keys()[static_cast<std::size_t>(key)];
        const double now = material_value(run_.world->settings().material, key);
        const double value = random_.chance(0.1) ? known.most : std::max(now, 1e-3) * random_.log(0.1, 10);
        expect("set_material", run_.world->commands().set_material(key, std::clamp(value, known.least, known.most)), false);
    }

    Run& run_;
    Random random_;
    Grid grid_;
    double size_;
};

} // namespace

std::string check_log(const Case& c, Session& session, const Base& base) {
    Run run = open(c, session), replay = open(c, session);
    if (run.good()) run.world->commands().remember(true);
    for (int done = 0; done < c.steps && run.good(); ++done) {
        for (Edit edit : c.commands) {
            if (edit.step != static_cast<std::uint64_t>(done)) continue;
            edit.step = 0; // the next one
            run.note("edit", run.world->commands().edit(std::span(&edit, 1)));
        }
        step(run, 1);
    }
    if (const std::string wrong = same(run, hash(run), base.hash); !wrong.empty()) return "edits in time: " + wrong;
    const auto bytes = run.world->commands().bytes();
    if (replay.good()) replay.note("play", replay.world->commands().play(bytes));
    step(replay, c.steps);
    const std::string wrong = same(replay, hash(replay), base.hash);
    return wrong.empty() ? wrong : "log played: " + wrong;
}

std::string check_calls(const Case& c, const Case& twin, Session& session) {
    Run run = open(c, session), replay = open(twin, session);
    if (!run.good()) return run.failure;
    run.world->commands().remember(true);
    queue(run, c);
    Host host(c, run);
    Random random(c.seed);
    for (int done = 1; done <= c.steps && run.good(); ++done) {
        while (run.good() && random.chance(0.35)) host.call();
        step(run, 1);
        if (!run.good()) break;
        auto stats = run.world->reader().stats();
        run.note("stats", stats.status());
        if (!stats) break;
        if (blown_up(c.scene.settings, *stats)) return {};
        run.failure = check_books(run, *stats);
        if (!run.failure.empty()) run.failure = "after step " + std::to_string(done) + " " + run.failure;
    }
    const std::uint64_t expected = hash(run);
    if (!run.good()) return run.failure;
    if (replay.good()) replay.note("play", replay.world->commands().play(run.world->commands().bytes()));
    step(replay, c.steps);
    const std::string wrong = same(replay, hash(replay), expected);
    return wrong.empty() ? wrong : "log of calls played: " + wrong;
}

} // namespace wadi::fuzz
