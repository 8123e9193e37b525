#include "engine/step/named_buffers.hpp"
#include <algorithm>

namespace wadi {

Status NamedBuffers::keep_also(const std::vector<compute::BufferDesc>& wanted) {
    std::map<std::string, compute::Buffer> fresh;
    for (const auto& desc : wanted) {
        if (made_.contains(desc.label)) continue;
        auto buffer = device_.create_buffer(desc);
        if (!buffer) {
            for (const auto& [label, made] : fresh) device_.destroy_buffer(made);
            return buffer.status();
        }
        fresh[desc.label] = *buffer;
    }
    made_.merge(fresh);
    return ok_status();
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
