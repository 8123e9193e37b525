#include "session.hpp"
#include "../common/files.hpp"
#include "level_writer.hpp"
#include "material_presets.hpp"
#include "picture_file.hpp"
#include "video.hpp"
#include <algorithm>
#include <cmath>
#include <fstream>
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
    const bool other = !simulation_ || choice.level_file != choice_.level_file;
    replace(name, choice, other ? Anew::level : Anew::world);
}

void Session::replace(const std::string& name, const SimulationChoice& choice, Anew anew) {
    renderer.wait();
    auto made = std::make_unique<Simulation>(gpu, choice); // throws before anything of the old world is touched
    const std::vector<wadi_material_info> kept = anew == Anew::world ? material() : std::vector<wadi_material_info>();
    history_.reset();
    simulation_ = std::move(made);
    history_ = std::make_unique<History>(*simulation_);
    take_over(kept);
    choice_ = choice;
    level_name = name;
    if (anew != Anew::world) settings = LevelSettings(choice.level_file, choice.text);
    if (anew == Anew::level) {
        watch_.watch(choice.level_file);
        budget_.stop();
        found_settings.clear();
        picture.camera = camera_preset(options_.camera, simulation_->grid.block,
                                       static_cast<float>(renderer.width()) / static_cast<float>(renderer.height()));
        picture.look.clarity = default_clarity(simulation_->grid);
        picture.section = {};
        switched_off_.clear();
    }
    tools.enter(*simulation_, *history_, anew == Anew::level);
    profile.clear();
    profile_asked_ = false;
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
    choice.accuracy = "level";
    choice.nx = choice.ny = 0;
    open(level_name, choice);
}

void Session::restart() {
    SimulationChoice choice = choice_;
    if (const std::string text = settings.text(); !text.empty()) choice.text = text;
    open(level_name, choice);
}

// With what the library warns of in the world made just now.
void Session::tell(const std::string& what) {
    message = what;
    for (const std::string& line : take_log()) message += "\n" + line;
}

std::string Session::level_text() const {
    if (std::filesystem::path(choice_.level_file).extension() != ".json") return {};
    std::ifstream file(choice_.level_file, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void Session::try_level(const std::string& text) {
    SimulationChoice choice = choice_;
    choice.text = text;
    replace(level_name, choice, Anew::text);
    tell("begun again with the edited level");
}

void Session::write_level_text(const std::string& text) {
    try_level(text);
    const std::string error = common::write_file(choice_.level_file, text);
    if (!error.empty()) throw std::runtime_error("writing the level: " + error);
    watch_.watch(choice_.level_file);
    message = "wrote " + choice_.level_file;
}

void Session::write_world() {
    const std::filesystem::path folder = options_.out / "level";
    const std::string settings_text = settings.text();
    write_level(*simulation_, choice_, settings_text.empty() ? level_text() : settings_text, folder);
    message = "wrote " + (folder / "level.json").string();
}

// An editor saved the level: begins again with it, or tells why not.
void Session::follow_file(double seconds) {
    if (!watch_.changed(seconds)) return;
    SimulationChoice choice = choice_;
    choice.text.clear();
    try {
        replace(level_name, choice, Anew::text);
        tell("the level's file changed: begun again");
    } catch (const std::exception& error) {
        message = std::string("the level's file changed, the world goes on: ") + error.what();
    }
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

void Session::set_preset(const std::string& name) {
    const MaterialPreset& preset = material_preset(name);
    const std::vector<wadi_material_info> before = material();
    history_->begin(name + " sand");
    for (const auto& [number, value] : preset.numbers) {
        if (wadi_world_set_material(simulation_->world, number, value) == WADI_OK) continue;
        const std::string why = wadi_get_last_error();
        for (const wadi_material_info& info : before) wadi_world_set_material(simulation_->world, info.name, info.value);
        throw std::runtime_error(name + " sand: " + why);
    }
    tools.brush.wetness = preset.wetness;
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

void Session::advance(double seconds) {
    seconds = recording_ ? RECORDED_FRAME : std::clamp(seconds, 0.0, 0.1);
    take_settings();
    follow_file(seconds);
    const bool stands = paused || budget_.running();
    const double simulated = stands ? 0 : seconds * static_cast<double>(speed);
    if (!budget_.running()) use_tool(seconds);
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

// What a tool does shows while the world stands, too: such a picture takes one step.
void Session::use_tool(double seconds) {
    try {
        if (tools.act(seconds) && paused && steps_due_ == 0) steps_due_ = 1;
    } catch (const std::exception& error) {
        message = error.what();
    }
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
    picture.scale = picture_is_kept() ? 1.0f : render_scale.value();
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
    if (tools.tool == Tool::look) return tools.point(std::nullopt, false);
    const std::optional<glm::vec3> place = renderer.place_at(x, y);
    tools.point(place, pressed);
    if (tools.tool != Tool::section || !pressed || !place) return;
    if (begins) picture.section.ends = {place->x, place->y, place->x, place->y};
    picture.section.ends.z = place->x;
    picture.section.ends.w = place->y;
    picture.section.shown = true;
}

void Session::point_away() {
    pressed_ = false;
    tools.point(std::nullopt, false);
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
