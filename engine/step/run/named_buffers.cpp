#include "engine/step/run/named_buffers.hpp"
#include <algorithm>

namespace wadi {

Status NamedBuffers::keep_also(const std::vector<compute::BufferDesc>& wanted) {
    struct Fresh {
        WorldDevice& device;
        Made made;
        ~Fresh() {
            for (const auto& [label, buffer] : made) device.destroy_buffer(buffer);
        }
    } fresh{device_, {}};
    for (const auto& desc : wanted) {
        if (made_.contains(desc.label)) continue;
        auto& place = fresh.made[desc.label];
        auto buffer = device_.create_buffer(desc);
        if (!buffer) return buffer.status();
        place = *buffer;
    }
    made_.merge(fresh.made);
    return ok_status();
}

void NamedBuffers::go_back(Made&& made) noexcept {
    for (const auto& [label, buffer] : made_) {
        const bool old = std::any_of(made.begin(), made.end(), [&, b = buffer](const auto& entry) { return entry.second == b; });
        if (!old) device_.destroy_buffer(buffer);
    }
    made_ = std::move(made);
}

void NamedBuffers::keep_only(const std::vector<compute::BufferDesc>& wanted) {
    std::erase_if(made_, [&](const auto& entry) {
        const bool keep = std::any_of(wanted.begin(), wanted.end(), [&](const auto& desc) { return desc.label == entry.first; });
        if (!keep) device_.destroy_buffer(entry.second);
        return !keep;
    });
}

compute::Buffer NamedBuffers::operator[](const std::string& label) const {
    const auto found = made_.find(label);
    return found == made_.end() ? compute::Buffer{} : found->second;
}

} // namespace wadi
