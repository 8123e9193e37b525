// The passes of a step plan one by one on a device, every field in a buffer of its own and readable in between: what a World
// runs in one go, taken apart to find the first pass that differs, or to time each.
#pragma once
#include "engine/compute/device.hpp"
#include "engine/step/plan/step_plan.hpp"
#include "tests/conformance/inputs.hpp"
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wadi::conformance {

class PassRunner {
  public:
    PassRunner(compute::Device& device, const Scene& scene, PlanChoice choice = {});
    ~PassRunner();
    PassRunner(const PassRunner&) = delete;
    PassRunner& operator=(const PassRunner&) = delete;

    /// Makes the buffers and loads the scene's state as a World does.
    Status open();

    const StepPlan& plan() const { return plan_; }
    const WorldParams& params() const { return params_; }
    FieldLayout layout() const { return {params_.nx, params_.ny}; }
    /// All passes of one water step, the substeps' repeated; `first`: of a world's first, with what starts it.
    std::vector<const PlanPass*> passes(bool first = false) const;

    /// Appends a pass to a program and makes its flips current.
    Status append(compute::ProgramBuilder& builder, const PlanPass& pass);
    /// Runs one pass and waits for it.
    Status run(const PlanPass& pass, const StepInput& input);

    /// A field by the name a pass gives it, "_next" included, as words; to write, the same number of words.
    Result<std::vector<std::uint32_t>> read(const std::string& field);
    Status write(const std::string& field, const std::vector<std::uint32_t>& words);
    compute::Buffer buffer(const std::string& field) const;
    /// The same by buffer: a pass's flips rename what it wrote.
    Result<std::vector<std::uint32_t>> read(compute::Buffer buffer, const std::string& field);
    /// Bytes that a pass moves: each existing binding once per thread of its extent, twice where it is read and written.
    double bytes_of(const PlanPass& pass) const;

  private:
    std::size_t words_of(const PlanField& field) const;

    compute::Device& device_;
    const Scene& scene_;
    StepPlan plan_;
    WorldParams params_;
    std::map<std::string, std::array<compute::Buffer, 2>> buffers_;
    std::set<std::string> flipped_; // fields whose second buffer is the current one
};

/// "limit_sand_outflow of substep 1": a pass of passes() by its place.
std::string pass_label(const StepPlan& plan, const std::vector<const PlanPass*>& passes, std::size_t pass);

} // namespace wadi::conformance
