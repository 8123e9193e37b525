#include "panel.hpp"
#include "../common/levels.hpp"
#include "material_presets.hpp"
#include "tool_bar.hpp"
#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <imgui.h>

namespace viewer {
namespace {

constexpr double TUNING_MINUTES = 0.5;

/// A list to choose from; true where another entry was chosen.
template <class Names> bool choose(const char* label, const Names& names, int count, int& chosen) {
    bool changed = false;
    if (!ImGui::BeginCombo(label, chosen >= 0 && chosen < count ? names(chosen) : "")) return false;
    for (int n = 0; n < count; ++n) {
        if (ImGui::Selectable(names(n), n == chosen)) {
            changed = n != chosen;
            chosen = n;
        }
    }
    ImGui::EndCombo();
    return changed;
}

void bar(const char* name, double value, double whole, const char* unit) {
    char text[96];
    std::snprintf(text, sizeof(text), "%s %.2f %s", name, value, unit);
    ImGui::ProgressBar(whole > 0 ? static_cast<float>(value / whole) : 0.0f, ImVec2(-1, 0), text);
}

} // namespace

void Panel::draw(Session& session, LevelEditor& editor, double frame_seconds) {
    frame_milliseconds_ += 0.1f * (static_cast<float>(1e3 * frame_seconds) - frame_milliseconds_);
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(WIDTH, ImGui::GetIO().DisplaySize.y));
    ImGui::Begin("Wadi", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse);
    ImGui::PushItemWidth(150);
    session.picture.shift = WIDTH / ImGui::GetIO().DisplaySize.x;
    try {
        simulation(session, editor);
        if (ImGui::CollapsingHeader("Tools", ImGuiTreeNodeFlags_DefaultOpen)) tools(session);
        if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen)) quality(session);
        if (ImGui::CollapsingHeader("Costs", ImGuiTreeNodeFlags_DefaultOpen)) costs(session);
        if (ImGui::CollapsingHeader("Material")) material(session);
        if (ImGui::CollapsingHeader("Effects")) effects(session);
        if (ImGui::CollapsingHeader("Ledger")) ledger(session, frame_seconds);
        if (ImGui::CollapsingHeader("Time", ImGuiTreeNodeFlags_DefaultOpen)) time_travel(session);
    } catch (const std::exception& error) {
        session.message = error.what();
    }
    if (!session.message.empty()) {
        ImGui::Separator();
        ImGui::TextWrapped("%s", session.message.c_str());
    }
    ImGui::PopItemWidth();
    ImGui::End();
    if (session.picture.section.shown) profile(session);
}

void Panel::simulation(Session& session, LevelEditor& editor) {
    static const std::vector<common::LevelEntry> levels = common::list_levels();
    int level = -1;
    for (std::size_t n = 0; n < levels.size(); ++n) {
        if (levels[n].name == session.level_name) level = static_cast<int>(n);
    }
    const auto level_at = [&](int n) { return levels[static_cast<std::size_t>(n)].name.c_str(); };
    if (choose("level", level_at, static_cast<int>(levels.size()), level)) {
        SimulationChoice choice = session.choice();
        choice.level_file = levels[static_cast<std::size_t>(level)].file.string();
        choice.text.clear();
        choice.variant.clear();
        choice.nx = choice.ny = 0;
        session.open(levels[static_cast<std::size_t>(level)].name, choice);
    }
    if (ImGui::Button("edit (F2)")) editor.shown = !editor.shown;
    ImGui::SameLine();
    if (ImGui::Button("write the world as a level")) session.write_world();
    static const std::vector<SimulationDevice> devices = simulation_devices();
    const auto device_at = [&](int n) { return devices[static_cast<std::size_t>(n)].label.c_str(); };
    const auto used = [&](const SimulationDevice& d) {
        const SimulationChoice& choice = session.choice();
        return d.backend == choice.backend && (d.device == choice.device || (choice.device < 0 && d.device <= 0));
    };
    int device = static_cast<int>(std::find_if(devices.begin(), devices.end(), used) - devices.begin());
    if (choose("runs on", device_at, static_cast<int>(devices.size()), device)) {
        SimulationChoice choice = session.choice();
        choice.backend = devices[static_cast<std::size_t>(device)].backend;
        choice.device = devices[static_cast<std::size_t>(device)].device;
        session.open(session.level_name, choice);
    }
    static const char* const accuracies[] = {"", "level", "draft", "balanced", "accurate", "fine"};
    const auto named = [](int n) { return n == 0 ? "fine on a graphics card" : n == 1 ? "as the level says" : accuracies[n]; };
    int accuracy = static_cast<int>(std::find(std::begin(accuracies), std::end(accuracies), session.choice().accuracy) -
                                    std::begin(accuracies));
    if (choose("accuracy", named, 6, accuracy)) {
        SimulationChoice choice = session.choice();
        choice.accuracy = accuracies[accuracy];
        session.open(session.level_name, choice);
    }
    budget(session);
    const wadi_world_info& info = session.simulation().info;
    ImGui::TextWrapped("%d x %d cells of %g m, dt %g s\n%s: %s", info.nx, info.ny, info.dx, info.dt, info.backend,
                       info.device_name);
    const wadi_frame& frame = session.simulation().frame;
    ImGui::Text("t = %.2f s, step %" PRIu64, frame.time, frame.total_steps);
    limits(frame);
    ImGui::Checkbox("pause", &session.paused);
    ImGui::SameLine();
    if (ImGui::Button("step")) {
        session.paused = true;
        session.single_step();
    }
    ImGui::SameLine();
    if (ImGui::Button("restart")) session.restart();
    ImGui::SliderFloat("speed", &session.speed, 0.02f, 4.0f, "%.2f x", ImGuiSliderFlags_Logarithmic);
}

/// What the newest look at limits found, where it found anything.
void Panel::limits(const wadi_frame& frame) {
    if (frame.limits_step == UINT64_MAX) return;
    const auto line = [](const char* what, uint64_t held, uint64_t of, double dt) {
        if (held == 0) return;
        const double percent = 100 * static_cast<double>(held) / static_cast<double>(std::max<uint64_t>(of, 1));
        if (dt > 0) {
            ImGui::TextWrapped("%s at %.2g %% of its faces: dt %.3g s", what, percent, dt);
        } else {
            ImGui::TextWrapped("%s at %.2g %% of its faces: more substeps", what, percent);
        }
    };
    line("water at the speed limit", frame.clamped_water_faces, frame.wet_faces, frame.unlimited_dt);
    line("water with capped gravity", frame.capped_water_faces, frame.wet_faces, frame.unlimited_dt);
    line("sand at the speed limit", frame.clamped_sand_faces, frame.sand_faces, 0);
    line("sand with capped gravity", frame.capped_sand_faces, frame.sand_faces, 0);
    if (frame.high_columns > 0) ImGui::TextWrapped("%" PRIu64 " columns above largest_height", frame.high_columns);
}

void Panel::budget(Session& session) {
    if (session.budget().running()) {
        ImGui::TextWrapped("measuring for %.1f ms a frame ...\n%s", static_cast<double>(session.budget_ms),
                           session.budget().progress().c_str());
        if (ImGui::Button("stop measuring")) session.budget().stop();
        return;
    }
    ImGui::SliderFloat("budget [ms]", &session.budget_ms, 0.2f, 16.0f, "%.1f", ImGuiSliderFlags_Logarithmic);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("of each frame at 60 a second, for the simulation");
    if (ImGui::Button("find settings for the budget")) session.find_settings(TUNING_MINUTES);
    if (!session.found_settings.empty()) ImGui::TextWrapped("%s", session.found_settings.c_str());
}

void Panel::tools(Session& session) {
    Tools& tools = session.tools;
    Brush& brush = tools.brush;
    draw_tool_bar(tools.tool);
    const glm::vec2 lengths = session.simulation().grid.lengths();
    const float longest = std::max(lengths.x, lengths.y), dx = session.simulation().grid.dx;
    const auto is = [&](std::initializer_list<Tool> some) {
        return std::find(some.begin(), some.end(), tools.tool) != some.end();
    };
    if (!is({Tool::look, Tool::section}))
        ImGui::SliderFloat("radius [m]", &brush.radius, dx, 0.2f * longest, "%.2f", ImGuiSliderFlags_Logarithmic);
    if (is({Tool::wall, Tool::stamp}))
        ImGui::SliderFloat("height [m]", &brush.height, 0.01f, 0.1f * longest, "%.2f", ImGuiSliderFlags_Logarithmic);
    else if (is({Tool::push}))
        ImGui::SliderFloat("strength", &brush.strength, 0, 1, "%.2f");
    else if (!is({Tool::look, Tool::section, Tool::smooth}))
        ImGui::SliderFloat("rate [m/s]", &brush.rate, 0.01f, 0.1f * longest, "%.2f", ImGuiSliderFlags_Logarithmic);
    if (is({Tool::sand, Tool::wall, Tool::stamp})) {
        ImGui::SliderFloat("wet", &brush.wetness, 0, 1, "%.2f");
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("share of its pores that is full: 0 dry, 0.25 damp, 1 soaked");
    }
    if (is({Tool::stamp})) {
        const std::vector<std::string>& names = built_in_stamps();
        int stamp = static_cast<int>(std::find(names.begin(), names.end(), tools.stamp()) - names.begin());
        if (choose(
                "shape", [&](int n) { return names[static_cast<std::size_t>(n)].c_str(); }, static_cast<int>(names.size()),
                stamp))
            tools.set_stamp(names[static_cast<std::size_t>(stamp)]);
        if (ImGui::InputText("or a picture", stamp_file_.data(), stamp_file_.size(), ImGuiInputTextFlags_EnterReturnsTrue))
            tools.set_stamp(stamp_file_.data()); // an error is shown, and the shape stays
    }
    ImGui::TextWrapped("%s", tools.footprint().numbers.c_str());
    springs(session);
    ImGui::Text("sand:");
    for (const MaterialPreset& preset : material_presets()) {
        ImGui::SameLine();
        if (ImGui::SmallButton(preset.name)) session.set_preset(preset.name);
    }
    if (ImGui::Button("screenshot")) session.screenshot();
    ImGui::SameLine();
    if (ImGui::Button("record (F9 stops)")) session.set_recording(true);
}

void Panel::springs(Session& session) {
    const glm::vec2 lengths = session.simulation().grid.lengths();
    const float most = 0.1f * std::max(lengths.x, lengths.y);
    for (Spring spring : session.tools.springs()) {
        if (spring.rate == 0) continue;
        ImGui::PushID(static_cast<int>(spring.index));
        ImGui::PushItemWidth(80);
        bool changed = ImGui::SliderFloat(spring.rate > 0 ? "m/s, spring" : "m/s, drain", &spring.rate, -most, most, "%.2f");
        ImGui::PopItemWidth();
        ImGui::SameLine();
        if (ImGui::SmallButton("close")) {
            spring.rate = 0;
            changed = true;
        }
        ImGui::PopID();
        if (changed) session.tools.change(spring);
    }
}

void Panel::quality(Session& session) {
    Picture& picture = session.picture;
    const std::vector<Quality>& presets = quality_presets();
    int preset = 0;
    for (std::size_t n = 0; n < presets.size(); ++n) {
        if (presets[n].name == picture.quality.name) preset = static_cast<int>(n);
    }
    if (choose(
            "quality", [&](int n) { return presets[static_cast<std::size_t>(n)].name.c_str(); }, static_cast<int>(presets.size()),
            preset))
        picture.quality = presets[static_cast<std::size_t>(preset)];
    bool holds = session.render_scale.target > 0;
    if (ImGui::Checkbox("hold 10 pictures a second", &holds)) session.render_scale.target = holds ? 100 : 0;
    ImGui::SameLine();
    ImGui::Text("%.0f %%", 100.0 * static_cast<double>(session.render_scale.value()));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("of the picture's width that is drawn, then enlarged");
    ImGui::SliderInt("samples", &picture.quality.samples, 1, 16);
    ImGui::SliderInt("reflection steps", &picture.quality.reflection_steps, 0, 256);
    ImGui::SliderInt("sky sectors", &picture.quality.sky_sectors, 4, 32);
    ImGui::SliderInt("octaves of patterns", &picture.quality.octaves, 1, 10);
    ImGui::Checkbox("land beyond the block", &picture.look.land);
    if (ImGui::TreeNode("drawn")) {
        for (std::size_t n = 0; n < features().size(); ++n)
            ImGui::CheckboxFlags(features()[n].c_str(), &picture.look.features, 1u << n);
        ImGui::TreePop();
    }
    const std::vector<std::string>& cameras = camera_presets();
    int camera = -1;
    if (choose(
            "camera", [&](int n) { return cameras[static_cast<std::size_t>(n)].c_str(); }, static_cast<int>(cameras.size()),
            camera))
        picture.camera =
            camera_preset(cameras[static_cast<std::size_t>(camera)], session.simulation().grid.block,
                          static_cast<float>(session.renderer.width()) / static_cast<float>(session.renderer.height()));
    if (choose(
            "view", [](int n) { return views()[static_cast<std::size_t>(n)].name; }, static_cast<int>(views().size()),
            picture.view)) {
        picture.low = views()[static_cast<std::size_t>(picture.view)].low;
        picture.high = views()[static_cast<std::size_t>(picture.view)].high;
    }
    if (picture.view != 0) {
        const View& view = views()[static_cast<std::size_t>(picture.view)];
        ImGui::DragFloatRange2(view.unit[0] == 0 ? "range" : view.unit, &picture.low, &picture.high,
                               0.01f * (view.high - view.low));
        if (picture.high <= picture.low) picture.high = picture.low + 1e-3f;
    }
    ImGui::Checkbox("arrows", &picture.arrows);
    ImGui::SameLine();
    ImGui::Checkbox("section line", &picture.section.shown);
    Look& look = picture.look;
    ImGui::SliderFloat("sun azimuth", &look.sun_azimuth, 0, 360, "%.0f deg");
    ImGui::SliderFloat("sun elevation", &look.sun_elevation, 5, 85, "%.0f deg");
    ImGui::SliderFloat("exposure", &look.exposure, 0.1f, 3, "%.2f");
    ImGui::SliderFloat("clarity of water", &look.clarity, 0.02f, 50, "%.2f m", ImGuiSliderFlags_Logarithmic);
    ImGui::SliderFloat("ripples", &look.ripples, 0, 4);
}

void Panel::costs(Session& session) {
    ImGui::Text("frame %.1f ms (%.1f/s), %.0f steps/s", static_cast<double>(frame_milliseconds_),
                1e3 / std::max(static_cast<double>(frame_milliseconds_), 1e-3), session.steps_per_second);
    ImGui::Text("%.2f times real time, dropped %.2f s", session.real_time_factor,
                1e-9 * static_cast<double>(session.simulation().frame.dropped_nanoseconds_total));
    const Milliseconds times = session.renderer.times();
    if (session.renderer.timed()) {
        bar("grid", times.grid, times.all(), "ms");
        bar("see", times.see, times.all(), "ms");
        bar("shade", times.shade, times.all(), "ms");
        bar("finish", times.finish, times.all(), "ms");
        bar("panel, copy", times.after, times.all(), "ms");
    }
    bool profiling = session.profiling;
    if (ImGui::Checkbox("time the stages of a step", &profiling)) session.set_profiling(profiling);
    if (!profiling) return;
    std::vector<wadi_stage_timing> stages = session.stage_timings();
    double all = 0;
    for (const wadi_stage_timing& stage : stages) all += stage.milliseconds;
    ImGui::Text("%.3f ms per water step", all);
    for (const wadi_stage_timing& stage : stages) bar(stage.name, stage.milliseconds, all, "ms");
}

void Panel::material(Session& session) {
    const std::vector<wadi_material_info>& first = session.level_material();
    const std::vector<wadi_material_info> now = session.material();
    if (ImGui::Button("as the level has it")) {
        for (const wadi_material_info& info : first) session.set_material(info.name, info.value);
    }
    for (std::size_t n = 0; n < now.size(); ++n) {
        const wadi_material_info& info = now[n];
        // A slider over all that is allowed would have no resolution: up to 10 times the level's value, still within the range.
        const double most = info.most > 100 ? std::min(info.most, 10 * std::max(first[n].value, 100.0)) : info.most;
        const bool small = info.most <= 1e6 && first[n].value < 0.05 * info.most;
        double value = info.value;
        if (ImGui::SliderScalar(info.name, ImGuiDataType_Double, &value, &info.least, &most, "%.4g",
                                ImGuiSliderFlags_AlwaysClamp | (small ? ImGuiSliderFlags_Logarithmic : 0)))
            session.set_material(info.name, value);
        const auto help = session.settings.material_help.find(std::string(info.name).substr(0, std::string(info.name).find('[')));
        if (ImGui::IsItemHovered() && help != session.settings.material_help.end())
            ImGui::SetTooltip("%s; %g ... %g", help->second.c_str(), info.least, info.most);
    }
}

void Panel::effects(Session& session) {
    uint32_t count = 0;
    check(wadi_world_get_effects(session.simulation().world, nullptr, &count), "effects");
    std::vector<wadi_effect_info> effects(count);
    check(wadi_world_get_effects(session.simulation().world, effects.data(), &count), "effects");
    ImGui::TextWrapped("At once, by the number of the material that is 0 without:");
    for (const wadi_effect_info& now : effects) {
        if (!Session::has_switch(now.name)) continue;
        bool on = now.on != 0;
        if (ImGui::Checkbox(now.name, &on)) session.switch_effect(now.name, on);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", now.why);
    }
    if (session.settings.effects.empty()) return;
    ImGui::TextWrapped("Forced from the next start of the level:");
    if (ImGui::Button("restart with these")) session.restart();
    for (EffectSetting& effect : session.settings.effects) {
        ImGui::PushID("forced");
        choose(
            effect.name.c_str(), [](int n) { return effect_forces[n]; }, static_cast<int>(std::size(effect_forces)),
            effect.force);
        ImGui::PopID();
        for (const wadi_effect_info& now : effects) {
            if (effect.name != now.name) continue;
            ImGui::SameLine();
            ImGui::Text("%s", now.on ? "on" : "off");
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", now.why);
        }
    }
}

void Panel::ledger(Session& session, double seconds) {
    stats_age_ += seconds;
    if (stats_age_ > 1) { // reads the whole state: not every frame
        stats_ = wadi_default_world_stats();
        check(wadi_world_get_stats(session.simulation().world, &stats_), "statistics");
        stats_age_ = 0;
    }
    ImGui::Text("          sand [m3]    water [m3]");
    ImGui::Text("first  %12.3f  %12.3f", stats_.sand_initial, stats_.water_initial);
    ImGui::Text("in     %12.3f  %12.3f", stats_.sand_in, stats_.water_in);
    ImGui::Text("out    %12.3f  %12.3f", stats_.sand_out, stats_.water_out);
    ImGui::Text("now    %12.3f  %12.3f", stats_.sand_volume, stats_.water_volume);
    ImGui::Text("drift  %10" PRId64 " q  %10" PRId64 " q", stats_.sand_drift_quanta, stats_.water_drift_quanta);
    ImGui::Text("speed  %8.2f m/s  %8.2f m/s", stats_.largest_sand_speed, stats_.largest_water_speed);
    ImGui::Text("clamped %" PRIu64 ", capped %" PRIu64 ", limited %" PRIu64, stats_.clamped_faces, stats_.capped_faces,
                stats_.limited_cells);
    ImGui::Text("hash %016" PRIx64, stats_.hash);
}

void Panel::time_travel(Session& session) {
    History& history = session.history();
    const auto action = [&](const char* label, const std::string& what, void (Session::*act)()) {
        const std::string text = std::string(label) + (what.empty() ? "" : ": " + what);
        if (ImGui::Button(text.c_str()) && !what.empty()) (session.*act)();
    };
    action("undo", history.undoable(), &Session::undo);
    ImGui::SameLine();
    action("redo", history.redoable(), &Session::redo);
    const uint64_t first = history.first(), last = history.last();
    uint64_t now = session.simulation().frame.total_steps;
    ImGui::PushItemWidth(-1);
    const double dt = session.simulation().info.dt;
    char text[48];
    std::snprintf(text, sizeof(text), "%.2f of %.2f s", dt * static_cast<double>(now), dt * static_cast<double>(last));
    if (ImGui::SliderScalar("##scrub", ImGuiDataType_U64, &now, &first, &last, text, ImGuiSliderFlags_NoInput))
        session.go_to(now);
    ImGui::PopItemWidth();
    ImGui::Text("%zu states kept, %.0f MB", history.kept_states(), 1e-6 * static_cast<double>(history.kept_bytes()));
    if (ImGui::Button("save (F5)")) session.save();
    ImGui::SameLine();
    if (ImGui::Button("load (F8)")) session.load();
    ImGui::SameLine();
    if (ImGui::Button("replay all")) replay_ = history.replay();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("from the first state by the command log: the hash must be the same");
    if (!replay_.empty()) ImGui::TextWrapped("%s", replay_.c_str());
}

void Panel::profile(const Session& session) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(WIDTH + 10, size.y - 190), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(std::max(size.x - WIDTH - 20, 200.0f), 180), ImGuiCond_FirstUseEver);
    ImGui::Begin("Section");
    if (session.profile.size() < 2) {
        ImGui::Text("draw a line with the tool \"section\"");
        ImGui::End();
        return;
    }
    float low = 1e9f, high = -1e9f;
    for (const ProfilePoint& point : session.profile) {
        low = std::min(low, point.terrain);
        high = std::max(high, point.water);
    }
    low -= 0.1f * std::max(high - low, 0.1f);
    high += 0.1f * std::max(high - low, 0.1f);
    const glm::vec4& ends = session.picture.section.ends;
    const float length = std::hypot(ends.z - ends.x, ends.w - ends.y);
    ImGui::Text("%.1f m along, elevation %.2f ... %.2f m", static_cast<double>(length), static_cast<double>(low),
                static_cast<double>(high));
    const ImVec2 origin = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->Flags &= ~ImDrawListFlags_AntiAliasedFill; // soft edges would leave seams between the columns
    const auto place = [&](std::size_t n, float height) {
        return ImVec2(origin.x + room.x * static_cast<float>(n) / static_cast<float>(session.profile.size() - 1),
                      origin.y + room.y * (1 - (height - low) / (high - low)));
    };
    const auto band = [&](auto&& bottom, auto&& top, ImU32 colour) {
        for (std::size_t n = 0; n + 1 < session.profile.size(); ++n) {
            const ProfilePoint &a = session.profile[n], &b = session.profile[n + 1];
            list->AddQuadFilled(place(n, bottom(a)), place(n, top(a)), place(n + 1, top(b)), place(n + 1, bottom(b)), colour);
        }
    };
    const auto terrain = [](const ProfilePoint& p) { return p.terrain; };
    const auto sand = [](const ProfilePoint& p) { return p.sand; };
    const auto water = [](const ProfilePoint& p) { return p.water; };
    band([&](const ProfilePoint&) { return low; }, terrain, IM_COL32(110, 100, 92, 255));
    band(terrain, sand, IM_COL32(214, 170, 100, 255));
    band(sand, water, IM_COL32(50, 120, 190, 220));
    ImGui::End();
}

} // namespace viewer
