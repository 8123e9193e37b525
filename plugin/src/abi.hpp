// What every file of the C ABI uses: handles and sizes checked, Status turned into codes, exceptions caught.
#pragma once
#include "engine/compute/float_environment.hpp"
#include "engine/threads/bands.hpp"
#include "plugin/include/wadi/wadi.h"
#include "plugin/src/struct_sizes.hpp"
#include "plugin/src/world_table.hpp"
#include <algorithm>
#include <cstring>
#include <cxxabi.h>
#include <new>
#include <span>
#include <string>
#include <string_view>

namespace wadi::plugin {

/// Keeps the message for wadi_get_last_error() of this thread.
wadi_result report(const Status& status);
const char* last_error();

/// The most bytes, up to `most_bytes`, of whole characters of a text in UTF-8.
std::size_t whole_characters(std::string_view text, std::size_t most_bytes);
/// Blanks for line ends and other control characters: hosts show texts in which files had a word, in terminals, too.
void make_printable(std::span<char> text);

/// WADI_ERROR_OUT_OF_MEMORY, with a text where there is memory for one.
wadi_result report_out_of_memory(const char* function) noexcept;

/// Puts the function's name ahead of an engine's message.
inline Status named(const char* function, Status status) {
    if (!status) status.message = std::string(function) + ": " + status.message;
    return status;
}

/// A player that logs cannot hold.
inline std::string player_text(std::uint64_t player) {
    return "player: " + std::to_string(player) + " is outside 0 ... " + std::to_string(UINT32_MAX);
}

inline wadi_result bad_argument(const std::string& message) { return report(error(Code::bad_argument, message)); }

#if defined(__GLIBCXX__)
using ThreadCancelled = abi::__forced_unwind; // thrown on by whoever catches it
#else
struct ThreadCancelled {};
#endif

/// No exception may reach a host: whatever is thrown, by its callbacks too, becomes an error. The library's floating-point
/// environment holds within.
template <class Call> wadi_result guarded(const char* function, Call call) {
    const compute::DefaultFloats floats;
    try {
        return call();
    } catch (const std::bad_alloc&) {
        return report_out_of_memory(function);
    } catch (const std::exception& e) {
        return report(error(Code::internal, std::string(function) + ": " + e.what()));
    } catch (const ThreadCancelled&) {
        throw;
    } catch (...) {
        return report(error(Code::internal, std::string(function) + ": an exception of unknown type"));
    }
}

/// Why a world cannot be entered, as an error of `function`.
inline wadi_result refused(const char* function, Entry entry) {
    return entry == Entry::busy
               ? report(error(Code::busy, std::string(function) + ": another call is inside this world; a world is used by one "
                                                                  "thread at a time"))
               : bad_argument(std::string(function) +
                              ": the world id is null, its world was destroyed, or it is from before a fork");
}

// The world is marked as in use for as long as the call lasts; no lock is held.
template <class Call> wadi_result with_world(const char* function, wadi_world_id id, Call call) {
    return guarded(function, [&] {
        const EnteredWorld entered(worlds(), id);
        HostedWorld* hosted = entered.hosted();
        if (hosted == nullptr) return refused(function, entered.entry());
        if (hosted->spoiled) return report_out_of_memory(function);
        const ThreadLimit limit(hosted->threads);
        try {
            return call(*hosted);
        } catch (const std::bad_alloc&) {
            hosted->spoiled = true;
            throw;
        }
    });
}

/// For what leaves a world as it was where the host's memory ends: no later call is refused for it.
template <class Call> wadi_result or_unchanged(const char* function, Call call) {
    try {
        return call();
    } catch (const std::bad_alloc&) {
        return report_out_of_memory(function);
    }
}

template <std::size_t N> void copy_text(char (&to)[N], const std::string& text) {
    const std::size_t n = whole_characters(text, N - 1);
    std::memcpy(to, text.data(), n);
    make_printable({to, n});
    std::memset(to + n, 0, N - n);
}

/// A field's plan name in the engine; NULL for an unknown field.
const char* plan_name(wadi_field field);

} // namespace wadi::plugin
