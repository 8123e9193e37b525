// Advice on a level that loads but would not do what its author expects. Each message has the numbers and what to change.
// Rules and constants: NUMERICS.md sections 2.4b, 2.4d, 2.7, 2.8 and 4.
#include "engine/level/corner_streams.hpp"
#include "engine/level/level.hpp"
#include "engine/level/source_rates.hpp"
#include "engine/level/stream_speeds.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wadi {
namespace {

constexpr double WAVE_CFL = 0.45;     // above it the gravity cap slows waves on still water (2.4b)
constexpr double UNCAPPED_CFL = 0.70; // above it waves without a gravity cap grow (NUMERICS 5)
constexpr double STIFFNESS_LEAST = 5; // E in units of rho_s g h0 (section 4)
constexpr double STIFFNESS_MOST = 15;
constexpr double WALL_SLOPE = 1.5;  // a step steeper than this is a wall that only cohesion holds
constexpr double WET_SHARE = 0.02;  // sand with less water than this share of its depth counts as dry
constexpr double NEARLY_FULL = 0.9; // of largest_height

std::string meters(double value) { return number_text(std::round(value * 1000) / 1000) + " m"; }

/// The extremes of the initial fields that the rules need.
struct Survey {
    double highest_column = 0; // H + hs + W [m]
    double deepest_water = 0;  // W [m]
    double deepest_sand = 0;   // hs [m]
    std::size_t dry_cells = 0; // without water above their sand
    double dry_front = 0;      // pure water beside lower dry ground [m]
    double wet_wall = 0;       // step of wet sand [m]
    double wet_wall_ratio = 0; // W / hs there
    double steepest_wet = 0;   // slope of wet sand beyond what friction holds
    double steepest_limit = 0; // that limit
    std::size_t steep_faces = 0;
};

struct Column {
    double terrain = 0;
    double sand = 0;
    double water = 0; // from the terrain to its surface
    double ground() const { return terrain + sand; }
    double surface() const { return terrain + sand + std::max(water - sand, 0.0); }
    double wetness() const { return sand > 0 ? std::min(water / sand, 1.0) : 0; }
};

/// Cohesion at a saturation before smoothing [Pa].
double cohesion_at(const Material& m, double phi) {
    const auto& s = m.saturation;
    if (phi < s[0]) return m.cohesion_dry + (m.cohesion_wet - m.cohesion_dry) * phi / s[0];
    if (phi < s[1]) return m.cohesion_wet + (m.cohesion_capillary - m.cohesion_wet) * (phi - s[0]) / (s[1] - s[0]);
    if (phi < s[2]) return m.cohesion_capillary * (s[2] - phi) / (s[2] - s[1]);
    return 0;
}

/// Cohesion that holds a vertical wall of this height, by Rankine's law [Pa].
double wall_cohesion(const Settings& settings, double height) {
    const double c_f = settings.material.yield_friction;
    return settings.material.sand_density * settings.gravity * height / (4 * (c_f + std::sqrt(1 + c_f * c_f)));
}

bool forced_off(const Settings& settings, const char* effect) {
    return std::any_of(settings.effects.begin(), settings.effects.end(),
                       [&](const auto& entry) { return entry.first == effect && entry.second == Force::off; });
}

/// What of the settings decides whether a wet slope holds.
struct SlopeLaw {
    double density_ratio, friction, chi; // chi > 0: pressure in pores bears weight, too (NUMERICS 2.18)
    double porosity, buoyancy;           // n, beta (NUMERICS 2.23)
    bool drag;
    double retained; // what pores hold back, of sand on its slope

    explicit SlopeLaw(const Settings& settings)
        : density_ratio(settings.material.water_density / settings.material.sand_density), friction(settings.material.friction),
          chi(forced_off(settings, "slope_normal") || settings.method.published() ? 0 : settings.material.slope_normal),
          porosity(forced_off(settings, "mixture") || settings.method.published() ? 1 : settings.material.porosity),
          buoyancy(porosity < 1 ? 1 - porosity : 1), drag(settings.material.exchange_rate > 0 && !forced_off(settings, "drag")),
          retained(chi > 0 && drag && !forced_off(settings, "retention") && !forced_off(settings, "mixture")
                       ? settings.material.retention
                       : 0) {}
};

/// What pushes and holds sand on a wet slope, per weight of the sand (section 4).
struct WetSlope {
    double held = 0;   // by friction, what pressure bears taken off
    double weight = 0; // that pushes
    double water = 0;  // push of pore water by drag, per slope of the sand
    double chi = 0;

    /// `wetness`: share of the sand's depth that water fills; `fall`: of the water's surface per fall of the sand's.
    WetSlope(const SlopeLaw& law, double wetness, double fall) {
        const double ratio = law.density_ratio * std::max(wetness - law.retained, 0.0) / (1 - law.retained);
        const double left = std::max(1 - law.buoyancy * ratio, 0.0);
        held = law.friction * left;
        weight = law.chi > 0 ? left : 1;
        water = law.drag ? ratio * fall : 0;
        chi = law.chi;
    }
    double push(double slope) const { return slope * (weight + water * (1 + chi * slope * slope)); }
    /// Slope where both are the same.
    double limit() const {
        const double least = weight + water;
        if (least <= 0) return 0;
        double slope = held / least; // no less than it, and Newton's steps stay so
        for (int n = 0; n < 8; ++n) slope -= (push(slope) - held) / (least + 3 * water * chi * slope * slope);
        return slope;
    }
};

/// The columns of the initial fields.
class Columns {
  public:
    Columns(const Settings& settings, const InitialFields& fields) : law(settings), grid_(settings.grid), fields_(fields) {}
    const SlopeLaw law;

    Column at(int i, int j) const {
        const std::size_t cell = static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.nx) + static_cast<std::size_t>(i);
        const auto part = [&](const std::vector<float>& field) { return field.empty() ? 0.0 : static_cast<double>(field[cell]); };
        const double sand = part(fields_.sand), water = part(fields_.water), pores = law.porosity * sand;
        return Column{part(fields_.terrain), sand, water < pores ? water / law.porosity : water + (sand - pores)};
    }

    /// How far sand falls within a cell of (i, j): a wall that runs through cells is lower in these, and whole around them.
    double fall_around(int i, int j) const {
        Column highest = at(i, j);
        double lowest = highest.ground();
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, grid_.ny - 1); ++b)
            for (int a = std::max(i - 1, 0); a <= std::min(i + 1, grid_.nx - 1); ++a) {
                const Column column = at(a, b);
                if (column.ground() > highest.ground()) highest = column;
                lowest = std::min(lowest, column.ground());
            }
        return std::min(highest.ground() - lowest, highest.sand);
    }

  private:
    Grid grid_;
    const InitialFields& fields_;
};

/// The face between the cell (i, j), whose column is `a`, and its neighbour to the east or north, `b`.
void survey_face(const Settings& settings, const Columns& columns, const Column& a, const Column& b, int i, int j, bool north,
                 Survey& survey) {
    const double eps = settings.method.dry_threshold;
    if (std::max(a.water, b.water) <= 0) return; // and no sand is wet
    const auto find_front = [&](const Column& wet, const Column& other) {
        const double pure = wet.water - wet.sand;
        if (pure > eps && other.water <= eps)
            survey.dry_front = std::max(survey.dry_front, std::min(pure, wet.surface() - other.ground()));
    };
    find_front(a, b);
    find_front(b, a);
    const Column& high = a.ground() >= b.ground() ? a : b;
    const Column& low = a.ground() >= b.ground() ? b : a;
    if (high.water <= WET_SHARE * high.sand || high.sand <= eps) return;
    const double step = std::min(high.ground() - low.ground(), high.sand);
    const double slope = step / settings.grid.dx;
    const Material& m = settings.material;
    const double water_step = std::max((high.terrain + high.water) - (low.terrain + low.water), 0.0);
    const WetSlope balance(columns.law, high.wetness(), step > 0 ? water_step / step : 0);
    if (slope <= WALL_SLOPE && balance.push(slope) <= balance.held) return;
    const double fall = std::max(columns.fall_around(i, j), columns.fall_around(i + (north ? 0 : 1), j + (north ? 1 : 0)));
    if (slope > WALL_SLOPE || fall > 2 * WALL_SLOPE * settings.grid.dx) {
        if (fall > survey.wet_wall) {
            survey.wet_wall = fall;
            survey.wet_wall_ratio = high.wetness();
        }
        return;
    }
    const bool submerged = low.surface() > low.ground() + eps;
    const bool held = cohesion_at(m, high.wetness()) >= wall_cohesion(settings, high.sand);
    if (submerged || held) return;
    ++survey.steep_faces;
    if (slope > survey.steepest_wet) {
        survey.steepest_wet = slope;
        survey.steepest_limit = balance.limit();
    }
}

/// The rows from `begin` on, with the faces to the row behind them.
Survey survey_rows(const Settings& settings, const Columns& columns, int begin, int end) {
    Survey survey;
    const int nx = settings.grid.nx;
    for (int j = begin; j < end; ++j) {
        Column east = columns.at(0, j);
        for (int i = 0; i < nx; ++i) {
            const Column here = east;
            survey.highest_column = std::max(survey.highest_column, here.ground() + here.water);
            survey.deepest_water = std::max(survey.deepest_water, here.water);
            if (here.water - here.sand <= settings.method.dry_threshold) ++survey.dry_cells;
            survey.deepest_sand = std::max(survey.deepest_sand, here.sand);
            if (i + 1 < nx) {
                east = columns.at(i + 1, j);
                survey_face(settings, columns, here, east, i, j, false, survey);
            }
            if (j + 1 < settings.grid.ny) survey_face(settings, columns, here, columns.at(i, j + 1), i, j, true, survey);
        }
    }
    return survey;
}

/// Adds what later rows hold; of equals the earlier one stays.
void join(Survey& all, const Survey& later) {
    all.highest_column = std::max(all.highest_column, later.highest_column);
    all.deepest_water = std::max(all.deepest_water, later.deepest_water);
    all.deepest_sand = std::max(all.deepest_sand, later.deepest_sand);
    all.dry_cells += later.dry_cells;
    all.dry_front = std::max(all.dry_front, later.dry_front);
    if (later.wet_wall > all.wet_wall) {
        all.wet_wall = later.wet_wall;
        all.wet_wall_ratio = later.wet_wall_ratio;
    }
    if (later.steepest_wet > all.steepest_wet) {
        all.steepest_wet = later.steepest_wet;
        all.steepest_limit = later.steepest_limit;
    }
    all.steep_faces += later.steep_faces;
}

Survey survey_fields(const Settings& settings, const InitialFields& fields) {
    const Columns columns(settings, fields);
    const auto rows = static_cast<std::size_t>(settings.grid.ny);
    const std::size_t band = row_band(static_cast<std::size_t>(settings.grid.nx));
    std::vector<Survey> parts(bands_of(rows, band));
    in_bands(rows, band, [&](std::size_t n, std::size_t begin, std::size_t end) {
        parts[n] = survey_rows(settings, columns, static_cast<int>(begin), static_cast<int>(end));
    });
    Survey survey;
    for (const Survey& part : parts) join(survey, part);
    return survey;
}

void warn_water(const Settings& s, const Survey& survey, std::vector<std::string>& warnings) {
    const double dt = s.water_dt(), k = dt / s.grid.dx;
    const std::string grid = "dx " + number_text(s.grid.dx) + " m, dt " + number_text(dt) + " s: ";
    const double celerity = std::sqrt(s.gravity * survey.deepest_water);
    const bool capped = s.method.gravity_cap > 0;
    const double cfl = capped ? WAVE_CFL : UNCAPPED_CFL;
    if (k * celerity > cfl) {
        const double depth = std::pow(cfl / k, 2) / s.gravity;
        warnings.push_back(grid + "water deeper than " + meters(depth) +
                           (capped ? " moves slower than it should" : " is unstable while method.gravity_cap is off") +
                           ", and the level has " + meters(survey.deepest_water) + "; use " +
                           longest_dt(s, cfl * s.grid.dx / celerity) + " or dx >= " + at_least(dt * celerity / cfl) + " m" +
                           or_water_substeps(s, cfl * s.grid.dx / celerity));
    }
    const double front = 2 * std::sqrt(s.gravity * survey.dry_front);
    const double clamp = s.method.velocity_clamp / k;
    if (front > clamp)
        warnings.push_back(grid + "water of " + meters(survey.dry_front) + " beside dry ground should run at up to " +
                           number_text(std::round(front * 100) / 100) +
                           " m/s but is held at velocity_clamp dx/dt = " + number_text(std::round(clamp * 100) / 100) +
                           " m/s; use " + longest_dt(s, s.method.velocity_clamp * s.grid.dx / front) +
                           " or dx >= " + at_least(dt * front / s.method.velocity_clamp) + " m" +
                           or_water_substeps(s, s.method.velocity_clamp * s.grid.dx / front));
    for (std::size_t n = 0; n < s.sources.size(); ++n) {
        const Source& source = s.sources[n];
        const double speed = std::max(std::fabs(source.velocity[0]), std::fabs(source.velocity[1]));
        if (source.set_velocity && speed > clamp)
            warnings.push_back("sources[" + std::to_string(n) + "].velocity: " + number_text(speed) +
                               " m/s is more than velocity_clamp dx/dt = " + number_text(clamp) + " m/s; use " +
                               longest_dt(s, s.method.velocity_clamp * s.grid.dx / speed) +
                               or_water_substeps(s, s.method.velocity_clamp * s.grid.dx / speed));
    }
    const double diffusion_most = 0.2 * s.grid.dx / k;
    if (survey.deepest_sand > 0 && s.material.diffusion_rate > diffusion_most && !forced_off(s, "diffusion"))
        warnings.push_back("material.diffusion_rate: " + number_text(s.material.diffusion_rate) + " m2/s acts like " +
                           number_text(diffusion_most) + " m2/s, the most that dx and dt allow (0.2 dx^2/dt)");
}

void warn_sand(const Settings& s, const Survey& survey, std::vector<std::string>& warnings) {
    const Material& m = s.material;
    const double weight = m.sand_density * s.gravity * survey.deepest_sand;
    if (m.young_modulus > 0 && weight > 0 && !forced_off(s, "elastoplastic")) {
        const double nu = m.poisson_ratio;
        const double modulus = m.young_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu)); // lambda + 2 mu
        const double dts = s.dt / s.method.substeps;
        const double most = s.method.elastic_cap * m.sand_density * std::pow(s.grid.dx / dts, 2);
        const double scale = s.method.elastic_cap > 0 ? std::min(1.0, most / modulus) : 1;
        const std::string range = at_least(STIFFNESS_LEAST * weight) + " ... " + at_most(STIFFNESS_MOST * weight) +
                                  " Pa (5 ... 15 times the weight of the deepest sand, " + meters(survey.deepest_sand) + ")";
        if (m.young_modulus < STIFFNESS_LEAST * weight || m.young_modulus > STIFFNESS_MOST * weight)
            warnings.push_back("material.young_modulus: " + number_text(m.young_modulus) + " Pa is outside " + range +
                               ": sand is " +
                               (m.young_modulus < STIFFNESS_LEAST * weight ? "compressed by its own weight"
                                                                           : "so stiff that it does not fill hollows"));
        else if (scale * m.young_modulus < STIFFNESS_LEAST * weight)
            warnings.push_back("material.young_modulus: " + number_text(m.young_modulus) + " Pa acts like " +
                               at_most(scale * m.young_modulus) + " Pa at this sand substep, below " + range +
                               "; use dt <= " + at_most(s.dt * std::sqrt(scale * m.young_modulus / (STIFFNESS_LEAST * weight))) +
                               " s or more substeps");
    }
    if (survey.wet_wall > 0 && !forced_off(s, "cohesion")) {
        const double least = wall_cohesion(s, survey.wet_wall);
        const double peak = std::max(m.cohesion_wet, m.cohesion_capillary);
        if (survey.wet_wall_ratio < m.saturation[2] && peak < least)
            warnings.push_back(
                "material.cohesion_wet: a wet sand wall of " + meters(survey.wet_wall) + " needs " + at_least(least) +
                " Pa (sand_density g h / (4 tan(45 deg + phi/2)), tan phi = yield_friction) and the level has " +
                number_text(peak) + " Pa: it will fall; raise cohesion_wet and cohesion_capillary, or lower the wall");
    }
    if (s.method.sand_transport_order == 2 && s.method.water_transport_order == 1 && survey.deepest_water > 0)
        warnings.push_back(
            "method.sand_transport_order: 2 with water_transport_order 1 moves sand and the water in it apart, and "
            "damp sand tears into ripples; set both to 2");
    if (survey.steep_faces > 0)
        warnings.push_back("wet sand slopes up to " + number_text(std::round(survey.steepest_wet * 1000) / 1000) + " at " +
                           std::to_string(survey.steep_faces) + " faces, more than friction holds there, " +
                           number_text(std::round(survey.steepest_limit * 1000) / 1000) +
                           " (friction (1 - b r) over 1 - b r + r (1 + slope_normal slope^2) where the water's surface falls as "
                           "the sand's does, r = "
                           "density ratio times the share of full pores, b = 1 - porosity, or 1): it will slump; lower the "
                           "slopes or the water, or raise material.friction");
}

/// True when a cell centre lies inside the source; a point always has its cell.
bool covers_a_cell(const Source& source, const Grid& grid) {
    if (source.shape == SourceShape::point) return true;
    const bool box = source.shape == SourceShape::box;
    std::array<std::array<int, 2>, 2> span{}; // first and last cell along x and y
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double low = box ? source.box[axis] : source.center[axis] - source.radius;
        const double high = box ? source.box[axis + 2] : source.center[axis] + source.radius;
        const int cells = axis == 0 ? grid.nx : grid.ny;
        span[axis] = {static_cast<int>(std::clamp(std::ceil(low / grid.dx - 0.5), 0.0, double{GRID_MOST})),
                      static_cast<int>(std::clamp(std::floor(high / grid.dx - 0.5), -1.0, cells - 1.0))};
        if (span[axis][0] > span[axis][1]) return false;
    }
    if (box) return true;
    // The cell centre nearest to the disc's centre decides.
    double square = 0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double cells = axis == 0 ? grid.nx : grid.ny;
        const double nearest = (std::clamp(std::floor(source.center[axis] / grid.dx), 0.0, cells - 1) + 0.5) * grid.dx;
        square += (nearest - source.center[axis]) * (nearest - source.center[axis]);
    }
    return square <= source.radius * source.radius;
}

/// Of discs that stay where they are; one that moves or a line meets cells somewhere.
bool misses_every_cell(const ScriptedEdit& script, const Grid& grid) {
    if (script.edit.capsule || script.move != std::array<double, 2>{0, 0}) return false;
    Source disc;
    disc.center = {script.edit.x0, script.edit.y0};
    disc.radius = script.edit.radius;
    return !covers_a_cell(disc, grid);
}

bool opens_a_cell(const Settings& settings, std::size_t index) {
    const Side& side = settings.sides[index];
    const bool along_y = index == static_cast<std::size_t>(SideName::west) || index == static_cast<std::size_t>(SideName::east);
    const double last = (along_y ? settings.grid.ny : settings.grid.nx) - 1;
    return std::ceil(side.from / settings.grid.dx - 0.5) <= std::min(std::floor(side.to / settings.grid.dx - 0.5), last);
}

/// The shortest swing of a series: twice the time from a highest or lowest value to the next; 0 where it has no two of them.
double shortest_period(const TimeSeries& series) {
    const auto& at = series.samples;
    double period = 0, last = 0;
    bool met = false;
    for (std::size_t n = 1; n + 1 < at.size(); ++n) {
        if ((at[n].second - at[n - 1].second) * (at[n + 1].second - at[n].second) >= 0) continue;
        const double swing = 2 * (at[n].first - last);
        if (met && (period == 0 || swing < period)) period = swing;
        last = at[n].first;
        met = true;
    }
    return period;
}

/// A held level that swings faster than a basin can follow: its own waves come back from it.
void warn_levels(const Settings& s, const InitialFields& fields, std::vector<std::string>& warnings) {
    for (std::size_t n = 0; n < s.sides.size(); ++n) {
        const Side& side = s.sides[n];
        if (side.kind != SideKind::level || side.absorb > 0) continue;
        const double period = shortest_period(side.value);
        if (period == 0) continue;
        const bool along_y = n == static_cast<std::size_t>(SideName::west) || n == static_cast<std::size_t>(SideName::east);
        const bool high = n == static_cast<std::size_t>(SideName::east) || n == static_cast<std::size_t>(SideName::north);
        const auto nx = static_cast<std::size_t>(s.grid.nx), ny = static_cast<std::size_t>(s.grid.ny);
        double deep = 0;
        for (std::size_t at = 0; at < (along_y ? ny : nx); ++at) {
            const std::size_t cell = along_y ? at * nx + (high ? nx - 1 : 0) : (high ? (ny - 1) * nx : 0) + at;
            deep = std::max(deep, side.value.at(0) - (fields.terrain.empty() ? 0 : static_cast<double>(fields.terrain[cell])));
        }
        const double across = s.grid.dx * (along_y ? s.grid.nx : s.grid.ny) / std::sqrt(std::max(s.gravity * deep, 1e-9));
        if (deep > 0 && period < 8 * across)
            warnings.push_back("sides." + side_names()[n] + ".value: a level that swings within " + number_text(period) +
                               " s throws back what returns from the other end after " + at_least(2 * across) +
                               " s; for waves that come in use kind \"waves\" (value: the still level, wave: the rest)");
    }
}

} // namespace

std::vector<std::string> level_warnings(const Settings& settings, const InitialFields& fields) {
    std::vector<std::string> warnings;
    const Survey survey = survey_fields(settings, fields);
    warn_water(settings, survey, warnings);
    warn_sand(settings, survey, warnings);
    warn_discharges(settings, warnings);
    warn_streams(settings, fields, warnings);
    warn_corner_streams(settings, fields, warnings);
    warn_levels(settings, fields, warnings);
    for (std::size_t n = 0; n < settings.sources.size(); ++n)
        if (!covers_a_cell(settings.sources[n], settings.grid))
            warnings.push_back("sources[" + std::to_string(n) +
                               "]: covers no cell centre, so nothing flows; make it larger than dx, " +
                               number_text(settings.grid.dx) + " m, or use a point");
    for (std::size_t n = 0; n < settings.edits.size(); ++n)
        if (misses_every_cell(settings.edits[n], settings.grid))
            warnings.push_back("edits[" + std::to_string(n) +
                               "]: covers no cell centre, so nothing happens; make it larger than dx, " +
                               number_text(settings.grid.dx) + " m, or move it into the grid");
    for (std::size_t n = 0; n < settings.sides.size(); ++n)
        if (settings.sides[n].kind != SideKind::wall && !opens_a_cell(settings, n))
            warnings.push_back("sides." + side_names()[n] +
                               ": no cell centre lies between from and to, so the side stays closed; widen the opening to " +
                               number_text(settings.grid.dx) + " m or more");
    const Method& method = settings.method;
    if (survey.highest_column > NEARLY_FULL * method.largest_height)
        warnings.push_back("method.largest_height: the highest column is " + meters(survey.highest_column) + " of " +
                           meters(method.largest_height) + "; what would rise above is refused, use " +
                           number_text(std::exp2(std::ceil(std::log2(survey.highest_column / NEARLY_FULL)))) + " or more");
    return warnings;
}

} // namespace wadi
