#include "history.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <thread>

namespace viewer {
namespace {

constexpr std::size_t MOST_BYTES = std::size_t{512} << 20; // of kept states
constexpr double INTERVAL = 1;                             // simulated time between states [s]

/// Of the ground, which the state's hash leaves out: FNV-1a.
uint64_t ground_hash(const Simulation& simulation) {
    std::vector<float> heights(static_cast<std::size_t>(simulation.info.nx) * static_cast<std::size_t>(simulation.info.ny));
    check(wadi_world_read_field(simulation.world, WADI_FIELD_TERRAIN, heights.data(), heights.size()), "reading the ground");
    uint64_t hash = 0xcbf29ce484222325u;
    const auto* bytes = reinterpret_cast<const unsigned char*>(heights.data());
    for (std::size_t n = 0; n < heights.size() * sizeof(float); ++n) hash = (hash ^ bytes[n]) * 0x100000001b3u;
    return hash;
}

uint64_t state_hash(const Simulation& simulation) {
    uint64_t hash = 0;
    check(wadi_world_get_hash(simulation.world, &hash), "the state's hash");
    return hash ^ ground_hash(simulation);
}

} // namespace

History::History(Simulation& simulation) : simulation_(simulation) { restart_log(); }

History::~History() {
    try {
        finish_saving();              // its memory must stay until then
    } catch (const std::exception&) { // a lost device: nothing is written any more
    }
}

void History::restart_log() {
    check(wadi_world_set_command_log(simulation_.world, 0), "the command log");
    check(wadi_world_set_command_log(simulation_.world, 1), "the command log");
    states_.clear();
    states_.push_back({now(), save_now()});
    points_.clear();
    redo_.clear();
    ahead_.clear();
    open_.clear();
    last_ = now();
}

uint64_t History::now() const {
    uint64_t step = 0;
    check(wadi_world_get_time(simulation_.world, nullptr, &step), "the time");
    return step;
}

uint64_t History::last() const { return std::max(last_, now()); }

History::Bytes History::commands_since(uint64_t step) const {
    std::size_t size = 0;
    check(wadi_world_get_commands_since(simulation_.world, step, WADI_EVERY_PLAYER, nullptr, &size), "the command log");
    Bytes commands(size);
    check(wadi_world_get_commands_since(simulation_.world, step, WADI_EVERY_PLAYER, commands.data(), &size), "the command log");
    return commands;
}

bool History::has_commands_since(uint64_t step) const {
    std::size_t size = 0, none = 0;
    check(wadi_world_get_commands_since(simulation_.world, step, WADI_EVERY_PLAYER, nullptr, &size), "the command log");
    check(wadi_world_get_commands_since(simulation_.world, UINT64_MAX, WADI_EVERY_PLAYER, nullptr, &none), "the command log");
    return size != none;
}

void History::play(const Bytes& commands) {
    check(wadi_world_play_commands(simulation_.world, commands.data(), commands.size()), "playing commands again");
}

History::Bytes History::save_now() const {
    std::size_t size = 0;
    check(wadi_world_save(simulation_.world, nullptr, &size), "the size of a state");
    Bytes bytes(size);
    check(wadi_world_save(simulation_.world, bytes.data(), &size), "keeping the state");
    return bytes;
}

void History::load_bytes(const Bytes& state) {
    check(wadi_world_load(simulation_.world, state.data(), state.size()), "going back");
}

void History::begin_saving() {
    finish_saving();
    if (newest_state(now()).step == now()) return;
    Saving saving;
    saving.state.step = now();
    check(wadi_world_begin_save(simulation_.world, &saving.ticket), "keeping the state");
    std::size_t size = 0;
    check(wadi_world_end_save(simulation_.world, saving.ticket, nullptr, &size), "the size of a state");
    saving.state.bytes.resize(size);
    saving_ = std::move(saving);
}

bool History::try_to_finish_saving() {
    if (!saving_) return true;
    std::size_t size = saving_->state.bytes.size();
    const wadi_result result = wadi_world_end_save(simulation_.world, saving_->ticket, saving_->state.bytes.data(), &size);
    if (result == WADI_NOT_READY) return false;
    State state = std::move(saving_->state);
    saving_.reset();
    check(result, "keeping the state");
    const auto after = [](uint64_t step, const State& other) { return step < other.step; };
    states_.insert(std::upper_bound(states_.begin(), states_.end(), state.step, after), std::move(state));
    thin();
    return true;
}

void History::finish_saving() {
    while (!try_to_finish_saving()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void History::drop_states(uint64_t after) {
    finish_saving();
    std::erase_if(states_, [&](const State& state) { return state.step > after; });
}

std::size_t History::kept_bytes() const {
    std::size_t bytes = 0;
    for (const State& state : states_) bytes += state.bytes.size();
    for (const Undone& undone : redo_) {
        for (const State& state : undone.states) bytes += state.bytes.size();
    }
    return bytes;
}

// Old states may lie farther apart than new ones, and beginnings of actions go last. The first one stays.
void History::thin() {
    while (kept_bytes() > MOST_BYTES && states_.size() > 2) {
        std::size_t least = 0;
        double least_loss = 0;
        for (std::size_t n = 1; n + 1 < states_.size(); ++n) {
            const uint64_t step = states_[n].step;
            const auto gap = static_cast<double>(states_[n + 1].step - states_[n - 1].step);
            double loss = gap / static_cast<double>(last() - step + 1);
            if (std::any_of(points_.begin(), points_.end(), [&](const Point& point) { return point.step == step; })) loss += 1e9;
            if (least == 0 || loss < least_loss) {
                least = n;
                least_loss = loss;
            }
        }
        states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(least));
    }
}

const History::State& History::newest_state(uint64_t up_to) const {
    auto found = states_.end();
    while (found != states_.begin() && (--found)->step > up_to) {
    }
    return *found;
}

void History::follow() {
    if (ahead_.empty()) return;
    play(ahead_);
    ahead_.clear();
}

void History::begin(const std::string& what) {
    if (open_ == what) return;
    finish_saving();
    const uint64_t step = now();
    if (step < last_) {
        if (ahead_.empty()) go_to(step); // commands of this step may have been followed already
        ahead_.clear();
        last_ = step;
    } else if (has_commands_since(step)) {
        simulation_.step(1);
    }
    redo_.clear();
    drop_states(now());
    std::erase_if(points_, [&](const Point& point) { return point.step >= now(); });
    points_.push_back({what, now()});
    begin_saving();
    open_ = what;
}

void History::keep() {
    if (!try_to_finish_saving()) return;
    const uint64_t step = now();
    const auto interval = static_cast<uint64_t>(std::max(std::llround(INTERVAL / simulation_.info.dt), 1ll));
    if (step >= newest_state(step).step + interval && !has_commands_since(step)) begin_saving();
}

std::string History::undoable() const {
    const uint64_t step = now();
    for (auto point = points_.rbegin(); point != points_.rend(); ++point) {
        if (point->step <= step) return point->what;
    }
    return {};
}

void History::undo() {
    const uint64_t reached = now();
    const auto is_after = [&](const Point& point) { return point.step > reached; };
    const auto after = std::find_if(points_.begin(), points_.end(), is_after);
    if (after == points_.begin()) throw std::runtime_error("there is nothing to undo");
    const auto first = after - 1;
    Undone undone;
    undone.points.assign(first, points_.end());
    undone.reached = reached;
    undone.last = last();
    const uint64_t step = first->step;
    go_to(step);
    points_.erase(first, points_.end());
    undone.commands = std::move(ahead_);
    ahead_.clear();
    last_ = step;
    for (State& state : states_) {
        if (state.step > step) undone.states.push_back(std::move(state));
    }
    drop_states(step);
    redo_.push_back(std::move(undone));
    open_.clear();
}

void History::redo() {
    if (redo_.empty()) throw std::runtime_error("there is nothing to redo");
    Undone undone = std::move(redo_.back());
    redo_.pop_back();
    const uint64_t step = undone.points.front().step;
    go_to(step);
    drop_states(step);
    ahead_ = std::move(undone.commands);
    last_ = undone.last;
    points_.insert(points_.end(), undone.points.begin(), undone.points.end());
    for (State& state : undone.states) states_.push_back(std::move(state));
    go_to(undone.reached);
    open_.clear();
}

// From the newest kept state, or from the world's own where that is nearer.
void History::arrive(uint64_t step) {
    const State& from = newest_state(step);
    if (now() > step || now() < from.step) {
        const Bytes commands = commands_since(from.step);
        load_bytes(from.bytes);
        play(commands);
    }
    while (now() < step) simulation_.step(static_cast<uint32_t>(std::min<uint64_t>(step - now(), 256)));
}

void History::go_to(uint64_t step) {
    if (step < first() || step > last())
        throw std::runtime_error("step " + std::to_string(step) + " is not one of " + std::to_string(first()) + " ... " +
                                 std::to_string(last()));
    finish_saving();
    last_ = last();
    open_.clear();
    follow();
    const bool something_ahead = has_commands_since(step);
    const Bytes ahead = commands_since(step);
    const State& kept = newest_state(step);
    if (something_ahead && kept.step == step) {
        load_bytes(kept.bytes); // ends the log ahead of this step
    } else {
        const bool disturbed = commands_since(step + 1).size() != ahead.size(); // some count at once, when the step begins
        arrive(step);
        if (something_ahead) load_bytes(save_now());
        if (disturbed) {
            const State& from = newest_state(step);
            const Bytes commands = commands_since(from.step);
            load_bytes(from.bytes);
            play(commands);
            arrive(step);
        }
    }
    if (something_ahead) ahead_ = ahead;
}

std::string History::replay() {
    const uint64_t step = now();
    const uint64_t live = state_hash(simulation_);
    finish_saving();
    const Bytes here = save_now();
    const Bytes commands = commands_since(first());
    const Bytes later = commands_since(step);
    load_bytes(states_.front().bytes);
    play(commands);
    while (now() < step) simulation_.step(static_cast<uint32_t>(std::min<uint64_t>(step - now(), 256)));
    const uint64_t again = state_hash(simulation_);
    load_bytes(here); // commands of this step that wait are played again: those that count at once change nothing twice
    play(later);
    char text[160];
    std::snprintf(text, sizeof(text), "%s: %zu bytes of commands from step %llu to %llu, hash %016llx and %016llx",
                  live == again ? "equal" : "DIFFERENT", commands.size(), static_cast<unsigned long long>(first()),
                  static_cast<unsigned long long>(step), static_cast<unsigned long long>(live),
                  static_cast<unsigned long long>(again));
    return text;
}

void History::save(const std::filesystem::path& file) {
    std::filesystem::create_directories(file.parent_path());
    check(wadi_world_save_file(simulation_.world, file.string().c_str()), "saving");
}

void History::load(const std::filesystem::path& file) {
    finish_saving();
    check(wadi_world_load_file(simulation_.world, file.string().c_str()), "loading");
    restart_log();
}

} // namespace viewer
