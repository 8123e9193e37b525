#include "budget.hpp"
#include "../tune/print.hpp"
#include "../tune/write_variant.hpp"

namespace viewer {

void Budget::start(const std::string& level_name, const SimulationChoice& choice, double milliseconds, double minutes) {
    stop();
    tune::Level level(choice.text, std::filesystem::path(choice.level_file).parent_path(),
                      choice.variant); // throws here, not there
    tune::Request request;
    request.budget_ms = milliseconds;
    request.minutes = minutes;
    request.device = {choice.backend, choice.device, choice.threads, false};
    request.tell = [this](const std::string& text) {
        const std::lock_guard lock(mutex_);
        progress_ = text;
    };
    request.stop = [this] { return stop_.load(); };
    stop_ = false;
    running_ = true;
    thread_ = std::thread([this, level_name, level = std::move(level), request = std::move(request)] {
        std::optional<Found> found;
        try {
            const tune::Outcome outcome = tune::tune(level, request);
            found = {tune::variant_of(level, outcome.chosen.settings).dump(),
                     tune::conclusion(level_name, level, request, outcome)};
        } catch (const tune::Stopped&) {
        } catch (const std::exception& error) {
            found = {"", error.what()};
        }
        const std::lock_guard lock(mutex_);
        found_ = std::move(found);
        running_ = false;
    });
}

void Budget::stop() {
    stop_ = true;
    wait();
    found_.reset();
    progress_.clear();
}

void Budget::wait() {
    if (thread_.joinable()) thread_.join();
}

std::string Budget::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

std::optional<Budget::Found> Budget::take() {
    if (running_) return {};
    wait();
    const std::lock_guard lock(mutex_);
    return std::exchange(found_, {});
}

} // namespace viewer
