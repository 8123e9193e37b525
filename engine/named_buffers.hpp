// The buffers of a part of a world, by label: those wanted are made, those no longer wanted are freed.
#pragma once
#include "engine/world_state.hpp"

namespace wadi {

class NamedBuffers {
  public:
    explicit NamedBuffers(WorldState& state) : state_(state) {}

    /// Afterwards exactly these exist; those that did keep handle and content. Waits for the device where one is freed. On an
    /// error (out_of_memory) nothing has changed.
    Status keep(const std::vector<compute::BufferDesc>& wanted);
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
