#include "engine/settings/data/settings.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

double height_quantum(const Method& method) {
    if (method.quantum >= 0) return method.quantum;
    return std::exp2(std::ceil(std::log2(method.largest_height)) - 24);
}

double TimeSeries::at(double time) const {
    if (samples.empty()) return 0;
    const auto next = std::upper_bound(samples.begin(), samples.end(), time,
                                       [](double t, const std::pair<double, double>& sample) { return t < sample.first; });
    if (next == samples.begin()) return samples.front().second;
    if (next == samples.end()) return samples.back().second;
    const auto [t0, v0] = *(next - 1);
    const auto [t1, v1] = *next;
    return v0 + (v1 - v0) * ((time - t0) / (t1 - t0));
}

} // namespace wadi
