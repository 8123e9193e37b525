// wadi-test-attack: hosts in odd surroundings, many at once, for long, and files that do harm, through the C interface. What it
// asserts of memory and time is of this process. One file per room; a room returns how much was wrong.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <wadi/wadi.h>

namespace attack {

extern std::atomic<int> wrong;
extern std::string backend;

/// Counts what is wrong and says it.
bool expect(bool good, const std::string& what);

/// A world of n x n cells with water, sand, a source, rain and an outflow.
wadi_result make(int n, wadi_world_id& world);
wadi_edit brush(wadi_layer layer);
bool ledger_holds(wadi_world_id world);
/// A world made, run, saved, loaded and destroyed; its hash, 0 where a call failed.
std::uint64_t session();

/// What a child that calls `body` used.
struct Child {
    int code = 0; // its exit code, or minus the signal that ended it
    double seconds = 0;
    double mebibytes = 0;
};
Child run_child(const std::function<int()>& body);

/// Pages of this process: column 0 of its address space, 1 resident.
std::uint64_t pages(int column);

int environment();
int memory();
int hosts(double seconds);
int files();
int cost();
int numbers();
int edited(int count);
int jobs();
int failing_vulkan(int count);
int soak(long steps);
int cycles(long count);

} // namespace attack
