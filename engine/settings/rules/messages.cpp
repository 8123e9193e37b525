#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

namespace wadi {

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.6g", value);
    return text;
}

std::string at_most(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
    return number_text(std::floor(value / unit * (1 + 1e-12)) * unit);
}

std::string at_least(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
    return number_text(std::ceil(value / unit * (1 - 1e-12)) * unit);
}

std::string longest_dt(const Settings& settings, double most) {
    return "dt <= " + at_most(most * settings.method.water_substeps) + " s";
}

std::string or_water_substeps(const Settings& settings, double most) {
    const double wanted = std::ceil(settings.dt / most);
    if (!(wanted <= WATER_SUBSTEPS_MOST) || settings.method.published()) return "";
    return ", or method.water_substeps " + number_text(wanted);
}

std::string outside_text(const std::string& path, double value, double least, double most) {
    return path + ": " + number_text(value) + " is outside " + number_text(least) + " ... " + number_text(most);
}

int edit_distance(const std::string& a, const std::string& b) {
    const std::size_t width = b.size() + 1;
    std::vector<int> cost((a.size() + 1) * width);
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j < width; ++j) {
            int& best = cost[i * width + j];
            if (i == 0 || j == 0) {
                best = static_cast<int>(i + j);
                continue;
            }
            best = std::min(cost[(i - 1) * width + j], cost[i * width + j - 1]) + 1;
            best = std::min(best, cost[(i - 1) * width + j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                best = std::min(best, cost[(i - 2) * width + j - 2] + 1);
        }
    return cost.back();
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
    constexpr std::size_t longest = 64; // no key is that long: do not measure what cannot be near
    const std::string* nearest = nullptr;
    int nearest_distance = 0;
    std::string list;
    for (const std::string& name : known) {
        list += (list.empty() ? "; known: " : ", ") + name;
        if (word.size() > longest) continue;
        const int distance = edit_distance(word, name);
        if (nearest == nullptr || distance < nearest_distance) {
            nearest = &name;
            nearest_distance = distance;
        }
    }
    const int close = std::max(2, static_cast<int>(std::min(word.size(), longest)) / 3);
    if (nearest != nullptr && nearest_distance <= close && nearest_distance < static_cast<int>(nearest->size()))
        return ", did you mean \"" + *nearest + "\"?";
    return list;
}

} // namespace wadi
