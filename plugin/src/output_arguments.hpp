// Which output and which set a host names.
#pragma once
#include "plugin/src/abi.hpp"

namespace wadi::plugin {

inline Status check_output(const char* function, wadi_output output) {
    const int n = static_cast<int>(output);
    if (n >= 0 && n < WADI_OUTPUT_COUNT) return ok_status();
    return error(Code::bad_argument, std::string(function) + ": output: " + std::to_string(n) + " is outside 0 ... " +
                                         std::to_string(WADI_OUTPUT_COUNT - 1));
}

/// The view of an output, or an error that names the function.
inline Result<OutputView> view_of(const char* function, HostedWorld& hosted, wadi_output output, wadi_output_set set) {
    if (auto status = check_output(function, output); !status) return status;
    const int which = static_cast<int>(set);
    if (which < 0 || which > WADI_OUTPUT_INTERPOLATED)
        return error(Code::bad_argument, std::string(function) + ": set: " + std::to_string(which) + " is outside 0 ... 2");
    auto found = hosted.world->outputs().view(static_cast<Output>(output), static_cast<OutputSet>(which));
    if (found) return found;
    return named(function, found.status());
}

} // namespace wadi::plugin
