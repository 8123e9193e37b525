#include "engine/reads/limits.hpp"
#include "engine/settings/rules/messages.hpp"
#include "shaders/physics/limit_marks.glsl"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <span>

namespace wadi {

namespace {

// Of the faces or cells that have anything to hold: up to this share is a front or an impact that passes, and is not told.
constexpr double told_share = 0.02;
// Of the time step: a cap of gravity that a step this much shorter would lift slows waves by no more than it says.
constexpr double told_dt = 0.95;

std::string rounded(double value) { return number_text(std::round(value * 100) / 100); }

std::string share(std::uint64_t held, std::uint64_t of, const char* what) {
    const double percent = 100 * static_cast<double>(held) / static_cast<double>(std::max<std::uint64_t>(of, 1));
    return std::to_string(held) + " of " + std::to_string(of) + what + " (" + number_text(std::round(percent * 10) / 10) + " %)";
}

std::string around(const LimitCounts::Place& place) {
    return ", most of them around (" + number_text(place.x) + ", " + number_text(place.y) + ") m";
}

bool many(std::uint64_t held, std::uint64_t of) { return static_cast<double>(held) > told_share * static_cast<double>(of); }

/// Of the marks of one layer in a cell and on its four faces.
std::uint32_t held_by(std::uint32_t marks) {
    const auto bit = [marks](std::uint32_t of, std::uint32_t held) { return (marks & of) != 0 ? held : 0u; };
    return bit(3 * (MARK_CLAMPED_x + MARK_CLAMPED_y), HELD_SPEED) | bit(MARK_CAPPED_x + MARK_CAPPED_y, HELD_GRAVITY) |
           bit(MARK_LIMITED, HELD_OUTFLOW);
}

double clamp_speed(const Settings& settings) { return settings.method.velocity_clamp * settings.grid.dx / settings.water_dt(); }

} // namespace

double unlimited_dt(const Settings& settings, const LimitCounts& counts) {
    double dt = settings.water_dt();
    if (counts.water.clamped_faces > 0)
        dt = std::min(dt, settings.method.velocity_clamp * settings.grid.dx / std::max(counts.clamped_speed, 1e-30));
    if (counts.water.capped_faces > 0)
        dt = std::min(dt, settings.method.gravity_cap * settings.grid.dx / std::max(counts.wave_speed, 1e-30));
    return dt * settings.method.water_substeps;
}

Status Limits::prepare() {
    const LimitBytes bytes = limit_bytes(state_.layout());
    const compute::BufferDesc wanted[] = {{bytes.marks, "limits marks"},
                                          {bytes.columns, "limits of columns"},
                                          {bytes.tiles, "limits of tiles"},
                                          {bytes.tiles, "limits readback", compute::HostAccess::readback}};
    for (std::size_t n = 0; n < buffers_.size(); ++n) {
        if (buffers_[n].id != 0) continue;
        auto made = state_.device().create_buffer(wanted[n]);
        if (!made) return made.status();
        buffers_[n] = *made;
    }
    if (!program_) {
        const auto build = [this, bytes](compute::ProgramBuilder& builder, const Parity& parity) {
            const Slots slots = {{"limit_marks", buffers_[0]}, {"limit_columns", buffers_[1]}, {"limit_counts", buffers_[2]}};
            Status status;
            for (const char* stage : looking_stages)
                if (status) status = state_.append_stage(builder, stage, parity, slots);
            builder.copy({buffers_[2], buffers_[3], 0, 0, bytes.tiles});
            return status;
        };
        program_ = std::make_unique<StateProgram>(state_, "limits", build);
    }
    if (material_ != state_.settings().material) program_->forget();
    material_ = state_.settings().material;
    return program_->record();
}

LimitCounts Limits::counts(std::uint64_t step) const {
    const auto& layout = state_.layout();
    const Settings& settings = state_.settings();
    const auto bytes = state_.device().mapped(buffers_[3]);
    LimitCounts all;
    all.step = step;
    double driven2 = 0, top = -1e30, bottom = 1e30;
    all.highest_column = -1e30;
    std::array<std::uint32_t, LIMIT_WORDS> words{};
    const int tiles = layout.tile_columns() * layout.strips();
    for (int n = 0; n < tiles; ++n) {
        std::memcpy(words.data(), bytes.data() + static_cast<std::size_t>(n) * sizeof words, sizeof words);
        const auto number = [&](std::size_t at) {
            float value = 0;
            std::memcpy(&value, &words[at], sizeof value);
            return static_cast<double>(value);
        };
        const auto middle = [](int tile, int cells) { return 0.5 * (tile * STRIP + std::min((tile + 1) * STRIP, cells)); };
        const double x = middle(n % layout.tile_columns(), layout.nx) * settings.grid.dx,
                     y = middle(n / layout.tile_columns(), layout.ny) * settings.grid.dx;
        const auto add = [&](std::uint64_t& sum, std::size_t at, LimitCounts::Place* place) {
            sum += words[at];
            if (place != nullptr && words[at] > place->most) *place = {words[at], x, y};
        };
        add(all.water.wet_faces, 0, nullptr);
        add(all.water.clamped_faces, 1, &all.water_clamped_at);
        add(all.water.capped_faces, 2, &all.water_capped_at);
        add(all.water.limited_cells, 3, &all.water_limited_at);
        add(all.sand.wet_faces, 4, nullptr);
        add(all.sand.clamped_faces, 5, &all.sand_clamped_at);
        add(all.sand.capped_faces, 6, &all.sand_capped_at);
        add(all.sand.limited_cells, 7, &all.sand_limited_at);
        add(all.high_columns, 8, &all.high_at);
        driven2 = std::max(driven2, number(9));
        all.wave_speed = std::max(all.wave_speed, number(10));
        top = std::max(top, number(11));
        bottom = std::min(bottom, number(12));
        all.capped_sand = std::max(all.capped_sand, number(13));
        all.highest_column = std::max(all.highest_column, number(14));
    }
    // No faster than the bed lets it run, nor than what has fallen from the highest surface of all; but faster than it is held
    // at.
    if (all.water.clamped_faces > 0)
        all.clamped_speed = std::max(std::min(std::sqrt(driven2), std::sqrt(2 * settings.gravity * std::max(top - bottom, 0.0))),
                                     1.1 * clamp_speed(settings));
    return all;
}

Status Limits::run() {
    if (auto status = prepare(); !status) return status;
    auto ticket = program_->submit();
    if (!ticket) return ticket.status();
    if (auto status = state_.device().wait(*ticket); !status) return status;
    pending_ = {}; // what it found has been overwritten
    return ok_status();
}

Result<LimitCounts> Limits::count() {
    if (auto status = run(); !status) return status;
    newest_ = counts(state_.steps);
    tell(*newest_);
    return *newest_;
}

Status Limits::read(const Region& region, std::span<float> values) {
    if (auto status = run(); !status) return status;
    const auto& layout = state_.layout();
    const std::size_t pitch = static_cast<std::size_t>(layout.pitch()), width = static_cast<std::size_t>(region.nx);
    std::vector<std::uint32_t> rows(pitch + width + 1); // a row of cells with the faces beyond them
    for (int j = 0; j < region.ny; ++j) {
        const std::size_t first = layout.index(region.i0, region.j0 + j);
        if (auto status = state_.device().read(buffers_[0], first * 4, std::as_writable_bytes(std::span(rows))); !status)
            return status;
        for (std::size_t i = 0; i < width; ++i) {
            const std::uint32_t marks = rows[i] | (rows[i + 1] & FACE_MARKS_x) | (rows[i + pitch] & FACE_MARKS_y);
            values[static_cast<std::size_t>(j) * width + i] = static_cast<float>(
                held_by(marks) | held_by(marks >> SAND_MARKS) << HELD_SAND | ((marks & MARK_HIGH) != 0 ? HELD_HIGH : 0u));
        }
    }
    return ok_status();
}

Status Limits::watch() {
    auto status = prepare();
    watching_ = static_cast<bool>(status);
    return status;
}

// Nothing that goes wrong here stops a step: a lost device shows at the next one.
void Limits::stop(const Status& why) {
    watching_ = false;
    state_.tell(1, "limits at work are not looked for any more: " + why.message);
}

void Limits::look() {
    auto& device = *state_.device();
    const std::uint64_t submits = device.counters().submits, depth = device.capabilities().queue_depth;
    if (pending_.value != 0 || submits == seen_) return; // at one still, or nothing has changed since
    if (submits + 1 > depth && !device.finished({submits + 1 - depth})) return;
    auto status = prepare();
    auto ticket = status ? program_->submit() : Result<compute::Ticket>(status);
    if (!ticket) {
        // Inside a recording into the host's commands nothing new is compiled.
        if (ticket.status().code != Code::not_ready && state_.lost()) stop(ticket.status());
        return;
    }
    pending_ = *ticket;
    pending_step_ = state_.steps;
    seen_ = device.counters().submits;
}

void Limits::collect() {
    if (pending_.value == 0 || !state_.device().finished(pending_)) return;
    pending_ = {};
    newest_ = counts(pending_step_);
    tell(*newest_);
}

void Limits::after_step() {
    if (!watching_) return;
    try {
        collect();
        if (state_.steps % interval == 0) look();
    } catch (const std::bad_alloc&) {
        stop(error(Code::out_of_memory, "no memory"));
    }
}

std::uint64_t Limits::undisturbed(std::uint64_t most) const {
    return watching_ ? std::min(most, interval - state_.steps % interval) : most;
}

void Limits::tell_once(Told kind, bool due, const LimitCounts& counts, const std::function<std::string()>& text) {
    if (!due || told_[kind] || !state_.log) return;
    told_[kind] = true;
    state_.log(1, "t = " + rounded(static_cast<double>(counts.step) * state_.settings().dt) + " s (step " +
                      std::to_string(counts.step) + "): " + text() + ". This is said once; wadi_world_stats counts on");
}

void Limits::tell(const LimitCounts& c) {
    const Settings& s = state_.settings();
    const LayerLimits &w = c.water, &sand = c.sand;
    const double dts = s.dt / s.method.substeps;
    const std::string more_substeps = "more than method.substeps " + std::to_string(s.method.substeps) + " or a shorter dt";
    const auto water_dt = [&](double most) { return "use " + longest_dt(s, most) + or_water_substeps(s, most); };
    tell_once(water_clamp, many(w.clamped_faces, w.wet_faces), c, [&] {
        return "water is held at velocity_clamp dx/dt = " + rounded(clamp_speed(s)) + " m/s at " +
               share(w.clamped_faces, w.wet_faces, " wet faces") + around(c.water_clamped_at) + "; it would run at up to some " +
               rounded(c.clamped_speed) + " m/s: " + water_dt(s.method.velocity_clamp * s.grid.dx / c.clamped_speed);
    });
    const double wave_dt = s.method.gravity_cap * s.grid.dx / std::max(c.wave_speed, 1e-30);
    tell_once(water_gravity, many(w.capped_faces, w.wet_faces) && wave_dt < told_dt * s.water_dt(), c, [&] {
        return "gravity of water is capped at " + share(w.capped_faces, w.wet_faces, " wet faces") + around(c.water_capped_at) +
               ": waves are slower than they should be; " + water_dt(wave_dt);
    });
    tell_once(water_outflow, many(w.limited_cells, w.wet_faces / 2), c, [&] {
        return "water would leave more than it has in " + share(w.limited_cells, w.wet_faces / 2, " wet cells") +
               around(c.water_limited_at) + ", and is held back; " +
               water_dt(s.water_dt() / std::max(4 * s.method.velocity_clamp, 1.1));
    });
    tell_once(sand_clamp, many(sand.clamped_faces, sand.wet_faces), c, [&] {
        return "sand is held at velocity_clamp dx/dts = " + rounded(s.method.velocity_clamp * s.grid.dx / dts) + " m/s at " +
               share(sand.clamped_faces, sand.wet_faces, " faces with sand") + around(c.sand_clamped_at) + "; use " +
               more_substeps;
    });
    tell_once(sand_gravity, many(sand.capped_faces, sand.wet_faces), c, [&] {
        const double substeps = std::ceil(s.dt / s.grid.dx * std::sqrt(s.gravity * c.capped_sand / s.method.sand_gravity_cap));
        return "gravity of sand is capped at " + share(sand.capped_faces, sand.wet_faces, " faces with sand") +
               around(c.sand_capped_at) + ": deep sand is lighter than it should be; use method.substeps " +
               number_text(std::max(substeps, s.method.substeps + 1.0)) + " or a shorter dt";
    });
    tell_once(sand_outflow, many(sand.limited_cells, sand.wet_faces / 2), c, [&] {
        return "sand would leave more than it has in " + share(sand.limited_cells, sand.wet_faces / 2, " cells with sand") +
               around(c.sand_limited_at) + ", and is held back; use " + more_substeps;
    });
    tell_once(high_columns, c.high_columns > 0, c, [&] {
        return std::to_string(c.high_columns) + " columns are above method.largest_height " +
               number_text(s.method.largest_height) + " m" + around(c.high_at) +
               ", where heights are rounded and the books drift; use " +
               number_text(std::exp2(std::ceil(std::log2(1.1 * c.highest_column)))) + " or more";
    });
}

} // namespace wadi
