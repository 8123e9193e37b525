// The buffers of a component of a world, by label: those wanted are made, those no longer wanted are freed.
#pragma once
#include "engine/step/run/world_device.hpp"
#include <map>

namespace wadi {

class NamedBuffers {
  public:
    explicit NamedBuffers(WorldDevice& device) : device_(device) {}

    /// Makes those that do not exist yet. On an error (out_of_memory) or an exception none of them was made.
    Status keep_also(const std::vector<compute::BufferDesc>& wanted);
    /// Frees all others. Waits for the device where one is freed.
    void keep_only(const std::vector<compute::BufferDesc>& wanted);
    /// Which there are.
    using Made = std::map<std::string, compute::Buffer>;
    Made made() const { return made_; }
    /// Frees those made since and goes back to the labels of then. Nothing may have been freed in between.
    void go_back(Made&& made) noexcept;
    /// Two buffers of one size change their labels.
    void exchange(const std::string& a, const std::string& b) { std::swap(made_.at(a), made_.at(b)); }
    /// Null where there is none.
    compute::Buffer operator[](const std::string& label) const;

  private:
    WorldDevice& device_;
    Made made_;
};

} // namespace wadi
