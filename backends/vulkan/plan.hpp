// From the operations of a program to the flat list of Vulkan commands: handles resolved, barriers placed.
#pragma once
#include "backends/vulkan/program.hpp"

namespace wadi::vulkan {

struct Plan {
    VkDescriptorPool descriptors = VK_NULL_HANDLE; // the caller's to destroy, after an error too
    std::vector<Command> commands;
};

/// Resolves a program that the front end accepted. Writes every descriptor set that it will ever need.
Status plan_commands(const ProgramParts& parts, const compute::ProgramBuilder& builder, VkBuffer params, Plan& plan);

} // namespace wadi::vulkan
