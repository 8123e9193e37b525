#include "engine/step/named_buffers.hpp"
#include <algorithm>

namespace wadi {

Status NamedBuffers::keep_also(const std::vector<compute::BufferDesc>& wanted) {
    std::map<std::string, Made> fresh;
    for (const auto& desc : wanted) {
        if (made_.contains(desc.label)) continue;
        auto buffer = state_.make_buffer(desc);
        if (!buffer) {
            for (const auto& [label, made] : fresh) state_.free_buffer(made.buffer, made.bytes);
            return state_.note(buffer.status());
        }
        fresh[desc.label] = {*buffer, desc.bytes};
    }
    made_.merge(fresh);
    return ok_status();
}

void NamedBuffers::keep_only(const std::vector<compute::BufferDesc>& wanted) {
    std::erase_if(made_, [&](const auto& entry) {
        const bool keep = std::any_of(wanted.begin(), wanted.end(), [&](const auto& desc) { return desc.label == entry.first; });
        if (!keep) state_.free_buffer(entry.second.buffer, entry.second.bytes);
        return !keep;
    });
}

compute::Buffer NamedBuffers::operator[](const std::string& label) const {
    const auto found = made_.find(label);
    return found == made_.end() ? compute::Buffer{} : found->second.buffer;
}

} // namespace wadi
