// The buffers of a part of a world, by label: those wanted are made, those no longer wanted are freed.
#pragma once
#include "engine/step/world_state.hpp"

namespace wadi {

class NamedBuffers {
  public:
    explicit NamedBuffers(WorldState& state) : state_(state) {}

    /// Makes those that do not exist yet. On an error (out_of_memory) none of them was made.
    Status keep_also(const std::vector<compute::BufferDesc>& wanted);
    /// Frees all others. Waits for the device where one is freed.
    void keep_only(const std::vector<compute::BufferDesc>& wanted);
    /// Null where there is none.
    compute::Buffer operator[](const std::string& label) const;

  private:
    struct Made {
        compute::Buffer buffer;
        std::uint64_t bytes = 0;
    };
    WorldState& state_;
    std::map<std::string, Made> made_;
};

} // namespace wadi
