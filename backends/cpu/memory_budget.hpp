// Memory for buffers of all CPU devices of the process, asked for before any of it is touched.
#pragma once
#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>

namespace wadi::cpu {

/// Operating systems promise more memory than they have and end the process that touches it: what was promised to buffers and not
/// touched yet counts as taken.
class MemoryBudget {
  public:
    /// Of the process.
    static MemoryBudget& of_process();
    /// False where the memory that is available now, less a tenth and 32 MiB at least, does not hold that many bytes more.
    bool take(std::uint64_t bytes);
    void give_back(std::uint64_t bytes);
    /// What take() would grant at most [bytes], after a look.
    std::uint64_t room();

  private:
    MemoryBudget() = default;
    std::uint64_t measure() const;

    std::mutex mutex_;
    std::uint64_t promised_ = 0; // to buffers that exist
    std::uint64_t granted_ = 0;  // may still be taken without another look
    std::chrono::steady_clock::time_point looked_{};
};

/// What take() granted, given back at the end.
class BudgetShare {
  public:
    BudgetShare() = default;
    explicit BudgetShare(std::uint64_t taken) : bytes_(taken) {}
    BudgetShare(BudgetShare&& from) noexcept : bytes_(std::exchange(from.bytes_, 0)) {}
    BudgetShare& operator=(BudgetShare&& from) noexcept {
        std::swap(bytes_, from.bytes_);
        return *this;
    }
    ~BudgetShare() {
        if (bytes_ > 0) MemoryBudget::of_process().give_back(bytes_);
    }

  private:
    std::uint64_t bytes_ = 0;
};

} // namespace wadi::cpu
