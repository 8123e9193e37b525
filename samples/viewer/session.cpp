#include "session.hpp"
#include "picture_file.hpp"
#include "video.hpp"
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace viewer {
namespace {

constexpr uint32_t PROFILE_POINTS = 256;
constexpr double RECORDED_FRAME = 1.0 / 30; // [s]
constexpr const char* FOUND_VARIANT = "found for the budget";

} // namespace

Session::Session(const Gpu& device, Renderer& picture_renderer, const Options& options)
    : gpu(device), renderer(picture_renderer), options_(options) {
    picture.quality = quality_preset(options.quality);
    picture.view = view_number(options.view);
    picture.low = views()[static_cast<std::size_t>(picture.view)].low;
    picture.high = views()[static_cast<std::size_t>(picture.view)].high;
    picture.arrows = options.arrows;
    picture.look.features = ~feature_bits(options.without);
    picture.look.land = !options.block;
    open(options.level_name, options.simulation);
}

void Session::open(const std::string& name, const SimulationChoice& choice) {
    renderer.wait();
    auto made = std::make_unique<Simulation>(gpu, choice); // throws before anything of the old world is touched
    const bool other_level = !simulation_ || choice.level_file != choice_.level_file;
    const std::vector<wadi_material_info> kept = other_level ? std::vector<wadi_material_info>() : material();
    history_.reset();
    simulation_ = std::move(made);
    history_ = std::make_unique<History>(*simulation_);
    take_over(kept);
    choice_ = choice;
    level_name = name;
    if (other_level) {
        settings = LevelSettings(choice.level_file);
        budget_.stop();
        found_settings.clear();
        picture.camera = camera_preset(options_.camera, simulation_->grid.block,
                                       static_cast<float>(renderer.width()) / static_cast<float>(renderer.height()));
        picture.look.clarity = default_clarity(simulation_->grid);
        picture.section = {};
        sources.clear();
        switched_off_.clear();
        const glm::vec2 lengths = simulation_->grid.lengths();
        brush_radius = 0.04f * std::max(lengths.x, lengths.y);
        brush_strength = 0.5f * brush_radius;
    }
    profile.clear();
    profile_asked_ = false;
    pointed_ = last_pointed_ = std::nullopt;
    profiling = false;
    host_seconds_ = simulated_at_ = 0;
    steps_at_ = 0;
}

void Session::find_settings(double minutes) {
    SimulationChoice choice = choice_;
    choice.text = settings.text();
    if (choice.text.empty()) throw std::runtime_error("only a level file has settings to find");
    if (choice.variant != FOUND_VARIANT) untuned_variant_ = choice.variant;
    choice.variant = untuned_variant_;
    if (choice.backend == "auto") choice.backend = simulation_->info.backend; // which with a device of the host's own is Vulkan
    budget_.start(level_name, choice, static_cast<double>(budget_ms), minutes);
}

void Session::take_settings() {
    const std::optional<Budget::Found> found = budget_.take();
    if (!found) return;
    found_settings = found->conclusion;
    if (found->patch.empty()) return;
    settings.set_variant(FOUND_VARIANT, found->patch);
    SimulationChoice choice = choice_;
    choice.text = settings.text();
    choice.variant = FOUND_VARIANT;
    choice.accuracy.clear();
    choice.nx = choice.ny = 0;
    open(level_name, choice);
}

void Session::restart() {
    SimulationChoice choice = choice_;
    choice.text = settings.text();
    open(level_name, choice);
}

std::vector<wadi_material_info> Session::material() const {
    uint32_t count = 0;
    check(wadi_world_get_material(simulation_->world, nullptr, &count), "the material");
    std::vector<wadi_material_info> infos(count);
    check(wadi_world_get_material(simulation_->world, infos.data(), &count), "the material");
    return infos;
}

void Session::set_material(const std::string& name, double value) {
    history_->begin(name);
    check(wadi_world_set_material(simulation_->world, name.c_str(), value), "changing the material");
}

// Numbers that must stay in order may need another turn.
void Session::take_over(const std::vector<wadi_material_info>& kept) {
    level_material_ = material();
    for (int turn = 0; turn < 3; ++turn) {
        const std::vector<wadi_material_info> now = material();
        for (std::size_t n = 0; n < std::min(kept.size(), now.size()); ++n) {
            if (kept[n].value != now[n].value) wadi_world_set_material(simulation_->world, kept[n].name, kept[n].value);
        }
    }
}

namespace {

struct Switch {
    const char* number;
    double usual;
};

// The numbers that are all 0 where an effect is off.
const std::map<std::string, std::vector<Switch>> switches = {
    {"elastoplastic", {{"young_modulus", 2e5}}},
    {"drag", {{"exchange_rate", 1e5}}},
    {"diffusion", {{"diffusion_rate", 0.01}}},
    {"bed_friction", {{"bed_friction", 0.02}, {"manning", 0}}},
    {"bed_shear", {{"bed_shear", 0.01}}},
    {"slope_normal", {{"slope_normal", 1}}},
    {"internal_friction", {{"internal_friction", 0.4}, {"sand_viscosity", 0.05}}},
    {"retention", {{"retention", 0.4925}}}};

} // namespace

bool Session::has_switch(const std::string& effect) { return switches.contains(effect); }

void Session::switch_effect(const std::string& effect, bool on) {
    const auto found = switches.find(effect);
    if (found == switches.end()) throw std::runtime_error("effect \"" + effect + "\" cannot be switched while the world runs");
    const auto value_in = [](const std::vector<wadi_material_info>& infos, const std::string& number) {
        for (const wadi_material_info& info : infos) {
            if (info.name == number) return info.value;
        }
        return 0.0;
    };
    std::vector<double> values;
    for (const auto& [number, usual] : found->second) {
        if (!on) {
            if (const double now = value_in(material(), number); now > 0) switched_off_[number] = now;
            values.push_back(0);
        } else {
            values.push_back(switched_off_.contains(number) ? switched_off_.at(number) : value_in(level_material_, number));
        }
    }
    const bool none = std::none_of(values.begin(), values.end(), [](double value) { return value > 0; });
    for (std::size_t n = 0; n < values.size(); ++n)
        set_material(found->second[n].number, on && none ? found->second[n].usual : values[n]);
}

void Session::queue_edits(double simulated_seconds, double seconds) {
    std::vector<wadi_edit> edits;
    for (const PlacedSource& source : sources) {
        if (!source.on || simulated_seconds <= 0) continue;
        wadi_edit edit = wadi_default_edit();
        edit.layer = source.layer;
        edit.x0 = source.x;
        edit.y0 = source.y;
        edit.radius = source.radius;
        edit.amount = source.rate * simulated_seconds;
        edits.push_back(edit);
    }
    if (pressed_ && pointed_ && tool >= Tool::add_sand && tool <= Tool::push) {
        wadi_edit edit = wadi_default_edit();
        const glm::vec3 from = last_pointed_.value_or(*pointed_);
        edit.capsule = 1;
        edit.x0 = static_cast<double>(from.x);
        edit.y0 = static_cast<double>(from.y);
        edit.x1 = static_cast<double>(pointed_->x);
        edit.y1 = static_cast<double>(pointed_->y);
        edit.radius = static_cast<double>(brush_radius);
        edit.softness = 1;
        if (tool == Tool::push) {
            edit.kind = WADI_EDIT_PUSH;
            edit.strength = std::clamp(static_cast<double>(brush_strength), 0.0, 1.0);
            edit.velocity_x = (edit.x1 - edit.x0) / std::max(seconds, 1e-3);
            edit.velocity_y = (edit.y1 - edit.y0) / std::max(seconds, 1e-3);
        } else {
            const bool takes = tool == Tool::take_sand || tool == Tool::take_water || tool == Tool::lower;
            edit.layer = tool == Tool::add_sand || tool == Tool::take_sand     ? WADI_LAYER_SAND
                         : tool == Tool::add_water || tool == Tool::take_water ? WADI_LAYER_WATER
                                                                               : WADI_LAYER_TERRAIN;
            edit.amount = (takes ? -1 : 1) * static_cast<double>(brush_strength) * seconds;
        }
        edits.push_back(edit);
    }
    last_pointed_ = pressed_ ? pointed_ : std::nullopt;
    if (edits.empty()) return;
    if (!sources.empty() || pressed_) history_->begin(tool_names[static_cast<std::size_t>(tool)]);
    const wadi_result result = wadi_world_edit(simulation_->world, edits.data(), static_cast<uint32_t>(edits.size()));
    if (result != WADI_OK) message = wadi_get_last_error();
}

void Session::advance(double seconds) {
    seconds = recording_ ? RECORDED_FRAME : std::clamp(seconds, 0.0, 0.1);
    take_settings();
    const bool stands = paused || budget_.running();
    const double simulated = stands ? 0 : seconds * static_cast<double>(speed);
    queue_edits(stands ? steps_due_ * simulation_->info.dt : simulated, seconds);
    if (simulated > 0 || steps_due_ > 0) history_->follow();
    if (stands && steps_due_ > 0) simulation_->step(steps_due_);
    steps_due_ = 0;
    simulation_->show(host_field_of(picture.view));
    simulation_->update(static_cast<uint64_t>(simulated * 1e9));
    history_->keep();
    count_rates(seconds);
    follow_section();
    for (const std::string& line : take_log()) message = line;
}

void Session::count_rates(double seconds) {
    host_seconds_ += seconds;
    if (host_seconds_ < 0.5) return;
    const wadi_frame& frame = simulation_->frame;
    real_time_factor = std::max(frame.time - simulated_at_, 0.0) / host_seconds_;
    steps_per_second = frame.total_steps >= steps_at_ ? static_cast<double>(frame.total_steps - steps_at_) / host_seconds_ : 0;
    simulated_at_ = frame.time;
    steps_at_ = frame.total_steps;
    host_seconds_ = 0;
}

void Session::draw(const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after) {
    picture.time = static_cast<float>(simulation_->frame.time + simulation_->frame.interpolation * simulation_->info.dt);
    renderer.wait(); // the last picture reads what is filled now
    const Sources& outputs = simulation_->sources(recording_);
    Submission submission = simulation_->next_submission();
    submission.wait = swapchain.wait;
    submission.signal = swapchain.signal;
    renderer.draw(picture, simulation_->grid, outputs, simulation_->foreign_memory(), submission, after);
    if (screenshot_due_) {
        screenshot_due_ = false;
        std::filesystem::create_directories(options_.out);
        const std::filesystem::path file = options_.out / numbered("screenshot", screenshots_++);
        write_picture(file, renderer.read_picture(), renderer.width(), renderer.height());
        message = "wrote " + file.string();
    }
    if (recording_) {
        const std::vector<uint8_t> pixels = renderer.read_picture();
        write_picture(recording_folder_ / numbered("recording", recorded_++), pixels, renderer.width(), renderer.height());
    }
}

void Session::point(uint32_t x, uint32_t y, bool pressed) {
    const bool begins = pressed && !pressed_;
    pressed_ = pressed;
    picture.brush.w = 0;
    if (tool == Tool::look) return;
    pointed_ = renderer.place_at(x, y);
    if (!pointed_) return;
    if (tool != Tool::section) picture.brush = {pointed_->x, pointed_->y, brush_radius, 1};
    if (tool == Tool::section && pressed) {
        if (begins) picture.section.ends = {pointed_->x, pointed_->y, pointed_->x, pointed_->y};
        picture.section.ends.z = pointed_->x;
        picture.section.ends.w = pointed_->y;
        picture.section.shown = true;
    }
    if (tool == Tool::spring && begins) {
        PlacedSource source;
        source.x = static_cast<double>(pointed_->x);
        source.y = static_cast<double>(pointed_->y);
        source.radius = static_cast<double>(brush_radius);
        source.rate = static_cast<double>(brush_strength);
        sources.push_back(source);
    }
}

void Session::point_away() {
    pressed_ = false;
    pointed_ = last_pointed_ = std::nullopt;
    picture.brush.w = 0;
}

void Session::follow_section() {
    if (profile_asked_) {
        std::vector<wadi_query_result> results(PROFILE_POINTS);
        uint32_t count = 0;
        const wadi_result result =
            wadi_world_get_query(simulation_->world, profile_ticket_, results.data(), PROFILE_POINTS, &count, nullptr);
        if (result == WADI_NOT_READY) return;
        profile_asked_ = false;
        check(result, "the section's profile");
        profile.clear();
        for (uint32_t n = 0; n < count; ++n) {
            const wadi_query_result& r = results[n];
            profile.push_back({r.terrain, r.terrain + r.sand_depth, r.terrain + r.sand_depth + r.water_depth});
        }
    }
    if (!picture.section.shown) return;
    std::vector<float> points;
    for (uint32_t n = 0; n < PROFILE_POINTS; ++n) {
        const glm::vec4& ends = picture.section.ends;
        const float share = static_cast<float>(n) / static_cast<float>(PROFILE_POINTS - 1);
        points.push_back(glm::mix(ends.x, ends.z, share));
        points.push_back(glm::mix(ends.y, ends.w, share));
    }
    const wadi_result result = wadi_world_query(simulation_->world, points.data(), PROFILE_POINTS, &profile_ticket_);
    if (result == WADI_NOT_READY) return;
    check(result, "asking for the section's profile");
    profile_asked_ = true;
}

void Session::went(const std::string& how) {
    simulated_at_ = 0;
    check(wadi_world_get_time(simulation_->world, &simulated_at_, &steps_at_), "the time");
    profile_asked_ = false;
    message = how + ", step " + std::to_string(steps_at_);
}

void Session::undo() {
    const std::string what = history_->undoable();
    history_->undo();
    went("undone: " + what);
}

void Session::redo() {
    const std::string what = history_->redoable();
    history_->redo();
    went("done again: " + what);
}

void Session::go_to(uint64_t step) {
    paused = true;
    history_->go_to(step);
    went("went");
}

std::filesystem::path Session::save_file() const { return options_.out / "saved.wadi"; }

void Session::save() {
    history_->save(save_file());
    message = "saved to " + save_file().string();
}

void Session::load() {
    history_->load(save_file());
    went("loaded from " + save_file().string());
}

void Session::set_profiling(bool on) {
    check(wadi_world_set_profiling(simulation_->world, on ? 1 : 0), "timing stages");
    profiling = on;
}

std::vector<wadi_stage_timing> Session::stage_timings() const {
    uint32_t count = 0;
    if (wadi_world_get_stage_timings(simulation_->world, nullptr, &count) != WADI_OK) return {};
    std::vector<wadi_stage_timing> timings(count);
    if (wadi_world_get_stage_timings(simulation_->world, timings.data(), &count) != WADI_OK) return {};
    timings.resize(count);
    return timings;
}

void Session::set_recording(bool on) {
    if (on == recording_) return;
    recording_ = on;
    if (on) {
        recording_folder_ = options_.out / "recording";
        std::filesystem::remove_all(recording_folder_);
        std::filesystem::create_directories(recording_folder_);
        recorded_ = 0;
    } else {
        message = "video: " + make_video(recording_folder_, "recording", 1 / RECORDED_FRAME);
    }
    simulation_->set_recording(on);
}

} // namespace viewer
