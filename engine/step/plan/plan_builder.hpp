// Passes of a step plan in order, as either method appends them.
#pragma once
#include "engine/step/plan/step_plan.hpp"
#include "shaders/params.hpp"
#include <map>
#include <string>
#include <vector>

namespace wadi {

using Names = std::map<std::string, std::string>; // a stage's binding name -> the plan's field name

class PlanBuilder {
  public:
    PlanBuilder(const StepPlan& plan, std::vector<PlanPass>& passes, bool in_substep)
        : plan_(plan), effects_(plan.effects), passes_(passes), in_substep_(in_substep) {}

    bool has(std::uint32_t bits) const { return (effects_ & bits) == bits; }

    /// Whether the plan has fused stages and the mask allows this one.
    bool can_fuse(const char* stage) const;
    /// Runs a fused stage, or returns false.
    bool fuse(const char* stage, std::vector<std::string> flips, const Names& names = {});
    /// In one pass with what accelerates the sand. That pass moves the water's velocities to their other buffers, which tiles
    /// without sand would have to do as well.
    bool fuses_momentum_exchange() const { return !tiles_by_material() && fuses_forces() && can_fuse("accelerate_mixture"); }
    /// Whether what accelerates sand may run in one pass.
    bool fuses_forces() const { return plan_.fused_slopes || !has(EFFECT_SLOPE_NORMAL); }
    /// Whether active tiles have a list for each material.
    bool tiles_by_material() const { return plan_.tiles_by_material; }
    std::vector<std::string> tile_lists() const { return plan_.tile_lists(); }

    void run(const char* stage, std::vector<std::string> flips = {}, const Names& names = {});
    /// The latest pass changes nothing but where water and sand meet.
    void only_where_both_run();

  private:
    const StepPlan& plan_;
    std::uint32_t effects_;
    std::vector<PlanPass>& passes_;
    bool in_substep_;
};

/// Parts that both methods have.
void account_water(PlanBuilder& b);
/// Heights of the sand, and what passes open sides.
void plan_sand_height(PlanBuilder& b);
void account_sand(PlanBuilder& b);
/// The water that drags the sand, by the names of the stages that do it.
Names drag_names(const PlanBuilder& b);

/// The paper's method (published_plan.cpp), beside plan_water and the like of Wadi's own in step_plan.cpp.
void plan_published_diffusion(PlanBuilder b);
void plan_published_water(PlanBuilder b);
void plan_published_sand(PlanBuilder b);
void plan_published_friction(PlanBuilder b); // after the sand height has become current

} // namespace wadi
