#include "tests/fuzz/checks.hpp"
#include "backends/registry.hpp"
#include "tests/conformance/symmetry.hpp"
#include "tests/fuzz/run.hpp"
#include "tests/reference/solver.hpp"
#include <algorithm>
#include <cmath>

namespace wadi::fuzz {

namespace {

Base run_base(const Case& c, Session& session) {
    Base base;
    base.run = open(c, session);
    Run& run = base.run;
    queue(run, c);
    for (int done = 0; done < c.steps && run.good(); ++done) {
        if (done == c.steps - 1) base.hash_before = hash(run);
        step(run, 1);
        if (!run.good()) break;
        auto stats = run.world->reader().stats();
        run.note("stats", stats.status());
        if (!stats) break;
        base.blown_up = blown_up(c.scene.settings, *stats);
        run.failure = check_books(run, *stats);
        if (!run.failure.empty()) run.failure = "after step " + std::to_string(done + 1) + " " + run.failure;
        if (base.blown_up) break; // NaN may be gone in the end, what it did to bits is not
    }
    base.hash = hash(run);
    return base;
}

std::string check_backend(const Case& c, const Case& twin, Session& session, const Base& base) {
    Run run = open(twin, session);
    if (run.world != nullptr && !run.world->device().capabilities().exact_float) return {};
    queue(run, c);
    step(run, c.steps);
    const std::string wrong = same(run, hash(run), base.hash);
    return wrong.empty() ? wrong : session.target().label() + ": " + wrong;
}

// Where checks run that compare ways of running: each device in its turn, the plain one alone where no other has equal bits.
Session& any_device(Devices& devices, std::uint64_t seed) {
    std::vector<Session*> equal;
    for (auto& session : devices.others) {
        auto device = session->device();
        if (device && (*device)->capabilities().exact_float) equal.push_back(session.get());
    }
    return equal.empty() ? *devices.plain : *equal[seed % equal.size()];
}

// The case, or with Weaken::bits another by two quanta of water, which stands in where the same bits are to come out.
Case twin_of(const Case& c, Weaken weaken) {
    Case twin = c;
    if (weaken == Weaken::bits && !c.scene.fields.water.empty())
        twin.scene.fields.water[0] += static_cast<float>(2 * height_quantum(c.scene.settings.method) + 1e-5);
    return twin;
}

// Saved after a random step, loaded into another world, and on from there.
std::string check_save(const Case& c, Session& session, const Base& base, Random& random) {
    if (c.steps < 2) return {};
    const int at = random.whole(1, c.steps - 1);
    Run first = open(c, session), second = open(c, session);
    queue(first, c);
    step(first, at);
    if (!first.good()) return first.failure;
    std::vector<std::byte> bytes(first.world->snapshots().bytes());
    first.note("save", first.world->snapshots().save(bytes));
    if (second.good()) second.note("load", second.world->snapshots().load(bytes));
    queue(second, c, static_cast<std::uint64_t>(at));
    step(second, c.steps - at);
    if (!first.failure.empty()) return first.failure;
    const std::string wrong = same(second, hash(second), base.hash);
    return wrong.empty() ? wrong : "loaded after step " + std::to_string(at) + ": " + wrong;
}

// Host frames of any length, whole steps or parts of them.
std::string check_driver(const Case& c, Session& session, const Base& base, Random& random) {
    Run run = open(c, session);
    queue(run, c);
    if (!run.good()) return run.failure;
    UpdateSettings settings;
    settings.max_steps_per_update = 1024;
    settings.max_steps_in_flight = 0;
    settings.spread = random.chance(0.5);
    run.note("update settings", run.world->set_update_settings(settings));
    const double step_ns = c.scene.settings.dt * 1e9;
    const auto wanted = static_cast<std::uint64_t>(c.steps - 1);
    while (run.good() && run.world->steps() < wanted) {
        Frame frame;
        run.note("update", run.world->update(static_cast<std::uint64_t>(random.real(0.1, 0.9) * step_ns), frame));
    }
    const std::uint64_t got = hash(run); // finishes a step that was begun
    if (!run.good()) return run.failure;
    return same(run, got, run.world->steps() == wanted ? base.hash_before : base.hash);
}

// Tiles that are left out while nothing changes in them, with the same edits.
std::string check_tiles(const Case& c, Session& session, const Base& base, Random& random, Weaken weaken) {
    Case tiled = c;
    tiled.scene.settings.active_tiles = random.chance(0.7) ? 8 : random.chance(0.5) ? 16 : 32;
    auto device = session.device();
    if (!device) return {};
    const bool fused = (*device)->capabilities().fused_stages && c.steps % 2 == 0; // half of the worlds
    tiled.scene.settings.fused_stages = fused ? FusedStages::always : FusedStages::never;
    Run run = open(tiled, session);
    if (run.world != nullptr && !run.world->device().capabilities().exact_float) return {};
    if (run.good() && weaken == Weaken::rings) run.note("rings", run.world->stepper().set_tile_rings(0));
    queue(run, tiled);
    step(run, c.steps);
    const std::string wrong = same(run, hash(run), base.hash);
    const std::string tiles =
        "tiles of " + std::to_string(tiled.scene.settings.active_tiles) + " cells" + (fused ? ", fused stages: " : ": ");
    if (!wrong.empty()) return tiles + wrong;
    // Once more with a host that writes regions and changes the material between steps.
    const std::string called = random.chance(0.5) ? check_calls(c, tiled, session) : "";
    return called.empty() ? called : tiles + called;
}

// Fused stages, with the same edits.
std::string check_fused(const Case& c, Session& session, const Base& base) {
    if (!session.device()) return {};
    Case together = c;
    together.scene.settings.fused_stages = FusedStages::always;
    const auto& device = (*session.device())->capabilities();
    if (!device.fused_stages || !device.exact_float) return {};
    Run run = open(together, session);
    queue(run, together);
    step(run, c.steps);
    return same(run, hash(run), base.hash);
}

// Not where steps may turn F inside out (no gradient clamp below 1/2): the angle of an inverted F that stays on its axes is +pi,
// and its image's as well, though it should be -pi.
std::string check_image(const Case& c, Session& session, Base& base, Image image) {
    const auto& method = c.scene.settings.method;
    const bool may_invert = method.gradient_clamp <= 0 || method.gradient_clamp >= 0.5;
    if (may_invert && method.published()) return {};
    const Case turned = image_of(c, image);
    Run run = open(turned, session);
    queue(run, turned);
    step(run, c.steps);
    if (!run.good()) return run.refused + run.failure;
    const auto symmetry = image == Image::transpose  ? conformance::Symmetry::transpose
                          : image == Image::mirror_x ? conformance::Symmetry::mirror_x
                                                     : conformance::Symmetry::mirror_y;
    return conformance::compare_images(*base.run.world, *run.world, symmetry).detail;
}

// Each depth a quantum more, less or as it is, as other rounding of fluxes leaves it; without quanta two units in a float's last
// place. Velocities of water that a float beside the clamp would lose are 0 or what they are: banks stand at exactly 0
// (NUMERICS 2.3), and with the water that sand holds back almost wholly it is rounding that says so.
void nudge(reference::Solver<double>& solver, Random& random) {
    const double lost = solver.P.clamp * 0x1p-24;
    for (reference::Faces<double>* velocity : {&solver.pure_velocity, &solver.mixed_velocity})
        for (reference::Field<double>* along : {&velocity->x, &velocity->y})
            for (double& u : *along)
                if (u != 0 && std::fabs(u) < lost) u *= random.whole(0, 1);
    const double quantum = height_quantum(solver.settings.method);
    for (reference::Field<double>* depth : {&solver.sand, &solver.water})
        for (double& h : *depth)
            if (h > quantum) h += (quantum > 0 ? quantum : h * 0x1p-22) * random.whole(-1, 1);
    solver.split_water();
}

// How far nudges move a depth of the second solver.
double moved_by_nudges(const reference::Solver<double>& start, int steps,
                       reference::Field<double> reference::Solver<double>::*depth, const reference::Field<double>& without) {
    double moved = 0;
    Random random(1);
    for (int way = 0; way < 16; ++way) {
        reference::Solver<double> nudged = start;
        for (int done = 0; done < steps; ++done) {
            nudge(nudged, random);
            nudged.step();
        }
        for (std::size_t n = 0; n < without.size(); ++n) moved = std::max(moved, std::fabs((nudged.*depth)[n] - without[n]));
    }
    return moved;
}

// Whether strain has grown until a float says another one than a double, as the paper's method lets it without its clamps: F of
// 3e7.
bool other_strain(const reference::Solver<float>& narrow, const reference::Solver<double>& wide) {
    const auto parts = [](const auto& f, const auto& d) {
        for (std::size_t n = 0; n < d.size(); ++n)
            if (std::fabs(static_cast<double>(f[n]) - d[n]) > 1e-2 * std::max(1.0, std::fabs(d[n]))) return true;
        return false;
    };
    return parts(narrow.Vxx, wide.Vxx) || parts(narrow.Vxy, wide.Vxy) || parts(narrow.Vyy, wide.Vyy);
}

// Whether a cell was drained without quanta: what is left of its depth is rounding, which says whether a layer is there.
bool drained(const reference::Solver<double>& solver) {
    const auto left = [](double h) { return h > 0 && h < 1e-10; };
    return std::any_of(solver.sand.begin(), solver.sand.end(), left) ||
           std::any_of(solver.water.begin(), solver.water.end(), left);
}

// The first steps against the second solver in double. Where that one in float differs from it much, another branch was taken
// somewhere and the case says nothing. Nor does it where quanta more or less move the second solver as far: what truncation
// leaves in a drained cell may lie on either side of a dry threshold of a few quanta, and sand passes the cell or not.
std::string check_reference(const Case& c, Session& session) {
    Run run = open(c, session);
    if (!run.good()) return run.failure;
    const auto& s = c.scene.settings;
    if (c.at_ends) return {};
    // Explicit drag beyond its bound flips velocities between the clamps by the sign of a rounding.
    if (s.method.published() && s.dt * s.material.exchange_rate > s.material.water_density) return {};
    // Without gravity no depth of an inflow is critical: each solver has a floor of its own.
    for (const Side& side : s.sides)
        if (side.kind == SideKind::discharge && s.gravity <= 0) return {};
    reference::Solver<float> narrow(s, run.world->plan().effects);
    reference::Solver<double> wide(s, run.world->plan().effects);
    narrow.load(c.scene.fields);
    wide.load(c.scene.fields); // no copy: V* of stiff sand (NUMERICS 2.20) has few digits as a float beside 1
    const reference::Solver<double> start = wide;
    for (int done = 1; done <= std::min(2, c.steps); ++done) {
        step(run, 1);
        narrow.step();
        wide.step();
        if (s.method.published() && other_strain(narrow, wide)) return {};
        if (s.method.quantum == 0 && drained(wide)) return {};
        for (const auto& [name, mine, theirs, depth] :
             {std::tuple{"sand_height", &narrow.sand, &wide.sand, &reference::Solver<double>::sand},
              std::tuple{"water_height", &narrow.water, &wide.water, &reference::Solver<double>::water}}) {
            std::vector<float> got(mine->size());
            if (run.good()) run.note("read", run.world->reader().read(name, got));
            if (!run.good()) return run.failure;
            double size = 0, spread = 0, off = 0;
            for (std::size_t n = 0; n < got.size(); ++n) {
                size = std::max(size, std::fabs((*theirs)[n]));
                spread = std::max(spread, std::fabs(static_cast<double>((*mine)[n]) - (*theirs)[n]));
                off = std::max(off, std::fabs(static_cast<double>(got[n]) - (*theirs)[n]));
            }
            const double quantum = height_quantum(s.method) * 8 * done;
            if (!(spread < 1e-4 * size + quantum)) return {};
            if (off <= 50 * spread + 1e-5 * size + 4 * quantum + 2 * s.method.dry_threshold) continue;
            if (moved_by_nudges(start, done, depth, *theirs) > off / 3) return {};
            return "after step " + std::to_string(done) + " " + name + " is off the reference by " + text(off) +
                   " m, float is by " + text(spread);
        }
    }
    return {};
}

} // namespace

const std::vector<std::string>& check_names() {
    static const std::vector<std::string> names = {"books", "bits",  "image", "reference", "driver", "save",
                                                   "log",   "calls", "shift", "fused",     "tiles",  "values"};
    return names;
}

Result<Devices> open_devices(const std::vector<std::string>& backends, const std::string& plain_set) {
    Devices devices;
    compute::DeviceOptions options;
    backends::apply_environment(options);
    for (const auto& target : conformance::all_targets()) {
        const std::string& name = target.info.backend;
        if (name == "cpu") {
            auto plain = options, best = options;
            plain.threads = 1;
            plain.instruction_set = plain_set;
            best.threads = 2;
            best.flush_denormals = true;
            devices.plain = std::make_unique<Session>(target, plain);
            if (std::find(backends.begin(), backends.end(), name) != backends.end())
                devices.others.push_back(std::make_unique<Session>(target, best));
        } else if (std::find(backends.begin(), backends.end(), name) != backends.end() && target.info.index == 0) {
            devices.others.push_back(std::make_unique<Session>(target, options));
        }
    }
    if (devices.plain == nullptr || devices.others.size() < backends.size())
        return error(Code::not_found, "a backend of --backend has no device here");
    if (const auto opened = devices.plain->device(); !opened) return opened.status();
    return devices;
}

Outcome run_case(const Case& c, Devices& devices, Weaken weaken, const std::string& only) {
    Case weakened = c;
    if (weaken == Weaken::limiter) {
        auto& method = weakened.scene.settings.method;
        method.outflow_limiter = false;
        method.velocity_clamp = std::max(method.velocity_clamp, 0.9);
    }
    const Case twin = twin_of(weakened, weaken);
    Outcome outcome;
    Random random(c.seed ^ 0x5bd1e995u);
    Base base = run_base(weakened, *devices.plain);
    outcome.refused = base.run.refused;
    if (!outcome.refused.empty()) return outcome;
    outcome.effects = base.run.world->plan().effects;
    const auto made = [&](const std::string& check, double share, auto run) {
        const bool picked = random.chance(share);
        if (outcome.failed() || share <= 0 || (only.empty() ? !picked : only != check)) return;
        ++outcome.count[check];
        Random own = random; // what a check draws is the same when it runs alone
        outcome.failure = run(own);
        if (outcome.failed()) outcome.check = check;
    };
    made("books", 1, [&](Random&) { return base.run.failure; });
    if (!base.run.good()) return outcome;
    if (base.blown_up) {
        ++outcome.count["blown up"];
        return outcome;
    }
    for (auto& session : devices.others) { // told, since nothing is compared there
        auto device = session->device();
        if (device && !(*device)->capabilities().exact_float) ++outcome.count[session->target().label() + " not exact"];
    }
    made("bits", 1, [&](Random&) {
        std::string failure;
        for (auto& session : devices.others)
            if (failure.empty()) failure = check_backend(weakened, twin, *session, base);
        return failure;
    });
    Session& any = any_device(devices, c.seed);
    const auto there = [&](const std::string& failure) {
        return failure.empty() ? failure : any.target().label() + ": " + failure;
    };
    const auto image = static_cast<Image>(random.whole(0, 2));
    made("image", 0.5, [&](Random&) { return there(check_image(weakened, any, base, image)); });
    made("reference", 0.5, [&](Random&) { return there(check_reference(weakened, any)); });
    made("driver", 0.4, [&](Random& own) { return there(check_driver(weakened, any, base, own)); });
    made("save", 0.4, [&](Random& own) { return there(check_save(weakened, any, base, own)); });
    made("log", 0.4, [&](Random&) { return there(check_log(weakened, any, base)); });
    made("calls", 0.4, [&](Random&) { return there(check_calls(weakened, twin, any)); });
    made("shift", 0.3, [&](Random& own) {
        bool compared = false;
        auto failure = there(check_shift(weakened, twin, any, own, compared));
        if (!compared) ++outcome.count["rim reached"];
        return failure;
    });
    made("fused", 0.3, [&](Random&) { return check_fused(weakened, *devices.others.back(), base); });
    made("tiles", 0.5, [&](Random& own) { return check_tiles(weakened, *devices.others.back(), base, own, weaken); });
    made("values", 0.3, [&](Random& own) { return check_values(weakened, twin, *devices.plain, *devices.others.back(), own); });
    return outcome;
}

} // namespace wadi::fuzz
