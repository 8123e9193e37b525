#include "level.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>

namespace tune {
namespace {

constexpr int MOST_CELLS = 16384; // along one axis

std::string read_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw BadInput("cannot read the level " + file.string());
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

/// To nine digits, so that a level file stays readable.
double rounded(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return std::strtod(text, nullptr);
}

} // namespace

Level::Level(const std::filesystem::path& file, const std::string& variant)
    : folder_(file.parent_path()), text_(read_text(file)) {
    read(variant);
}

Level::Level(const std::string& text, const std::filesystem::path& folder, const std::string& variant)
    : folder_(folder), text_(text) {
    read(variant);
}

/// The library itself tells in full what is wrong with a level; here only what the tuner calculates with.
void Level::read(const std::string& variant) {
    file_json_ = Json::parse(text_, nullptr, false, true);
    if (!file_json_.is_object()) throw BadInput("the level is no JSON object (a terrain map alone cannot be tuned)");
    json_ = file_json_;
    variant_patch_ = Json::object();
    if (!variant.empty()) {
        const Json variants = file_json_.value("variants", Json::object());
        if (!variants.is_object() || !variants.contains(variant)) throw BadInput("the level has no variant \"" + variant + "\"");
        variant_patch_ = variants[variant];
        json_.merge_patch(variant_patch_);
    }
    const auto number = [&](const Json& object, const char* key) {
        if (!object.is_object() || !object.contains(key) || !object[key].is_number() || object[key].get<double>() <= 0)
            throw BadInput(std::string("the level's ") + key + " is no number above 0");
        return object[key].get<double>();
    };
    const Json grid = json_.value("grid", Json::object());
    nx_ = static_cast<int>(std::min<double>(number(grid, "nx"), MOST_CELLS));
    ny_ = static_cast<int>(std::min<double>(number(grid, "ny"), MOST_CELLS));
    width_ = number(grid, "dx") * nx_;
    dt_ = number(json_, "dt");
    if (json_.contains("duration")) duration_ = number(json_, "duration");
}

Way Level::own_way() const {
    Way way;
    const Json method = json_.value("method", Json::object());
    way.substeps = method.value("substeps", 3);
    way.water_order = method.value("water_transport_order", 1);
    way.sand_order = method.value("sand_transport_order", 1);
    return way;
}

Settings Level::on_grid(double nx, const Way& way) const {
    const int common = std::gcd(nx_, ny_), unit = nx_ / common;
    int wide = std::max(static_cast<int>(std::lround(nx)), 1);
    // A multiple of the ratio's smallest grid, where those lie close enough together to choose among.
    if (unit <= 16) wide = std::max(static_cast<int>(std::lround(nx / unit)), 1) * unit;
    wide = std::min(wide, MOST_CELLS);
    const int high = std::clamp(static_cast<int>(std::lround(static_cast<double>(wide) * ny_ / nx_)), 1, MOST_CELLS);
    return {wide, high, way};
}

double Level::dt(const Settings& settings) const { return rounded(dt_ * nx_ / settings.nx); }

Json Level::patch(const Settings& settings) const {
    Json patch;
    patch["grid"] = {{"nx", settings.nx}, {"ny", settings.ny}, {"dx", width_ / settings.nx}};
    patch["dt"] = dt(settings);
    const Way own = own_way();
    const Way& way = settings.way;
    Json& method = patch["method"] = {{"substeps", way.substeps}};
    if (way.water_order != own.water_order) method["water_transport_order"] = way.water_order;
    if (way.sand_order != own.sand_order) method["sand_transport_order"] = way.sand_order;
    if (way.active_tiles >= 0) patch["active_tiles"] = way.active_tiles;
    if (json_.contains("accuracy")) patch["accuracy"] = nullptr; // a preset would change the cells once more
    return patch;
}

std::string Level::text(const Settings& settings) const {
    Json whole = json_;
    whole.merge_patch(patch(settings));
    whole.erase("variants");
    return whole.dump();
}

} // namespace tune
