// One run of a case, and what the checks share.
#pragma once
#include "engine/world.hpp"
#include "tests/conformance/target.hpp"
#include "tests/fuzz/fuzz_case.hpp"
#include "tests/fuzz/random.hpp"
#include <memory>

namespace wadi::fuzz {

using conformance::Session;

/// One run and what went wrong in it; a refusal to make the world is kept apart.
struct Run {
    std::unique_ptr<World> world;
    std::string refused, failure;
    bool good() const { return refused.empty() && failure.empty(); }
    void note(const char* what, const Status& status);
};

Run open(const Case& c, Session& session);
/// Queues the edits of steps from `from` on.
void queue(Run& run, const Case& c, std::uint64_t from = 0);
void step(Run& run, int count);
std::uint64_t hash(Run& run);

/// Whether a run of the paper's method, which does not keep it from that, is lost: NaN, or depths whose products leave the range
/// in which GPUs divide exactly (a million times the declared largest height). From there on bits say nothing.
bool blown_up(const Settings& settings, const WorldStats& stats);

/// Which promise the state of a run breaks (Checking); empty where none, and for method "published", which may blow up. For every
/// step: what piles up may be gone in the next.
std::string check_books(Run& run, const WorldStats& stats);

/// The run that all others are compared with.
struct Base {
    Run run;
    std::uint64_t hash = 0, hash_before = 0; // after the last step, and one ahead of it
    bool blown_up = false;
};

/// Why a run did not come to `expected`; empty where it did.
std::string same(Run& run, std::uint64_t got, std::uint64_t expected);

std::string text(double value);

/// Each edit called ahead of its step with the log on, and the log played elsewhere.
std::string check_log(const Case& c, Session& session, const Base& base);
/// Stamps, written regions, dropped effects, other materials and refused calls between steps: the ledger holds, and the log of it
/// gives the same bits in a world of `twin`.
std::string check_calls(const Case& c, const Case& twin, Session& session);
/// The case on a dry plateau and `twin` a few cells away from there: the same bits, but for the place. Not compared where
/// something came near to the rim.
std::string check_shift(const Case& c, const Case& twin, Session& session, Random& random, bool& compared);
/// Regions written between steps, checked on the host in one world and on the device in the world of `twin`: the same bits.
std::string check_values(const Case& c, const Case& twin, Session& session, Session& other, Random& random);

} // namespace wadi::fuzz
