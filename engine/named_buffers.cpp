#include "engine/named_buffers.hpp"

namespace wadi {

Status NamedBuffers::keep(const std::vector<compute::BufferDesc>& wanted) {
    std::map<std::string, Made> kept, fresh;
    for (const auto& desc : wanted) {
        const auto found = made_.find(desc.label);
        if (found != made_.end()) {
            kept.insert(*found);
            continue;
        }
        auto buffer = state_.make_buffer(desc);
        if (!buffer) {
            for (const auto& [label, made] : fresh) state_.free_buffer(made.buffer, made.bytes);
            return state_.note(buffer.status());
        }
        fresh[desc.label] = {*buffer, desc.bytes};
    }
    for (const auto& [label, made] : made_) {
        if (!kept.contains(label)) state_.free_buffer(made.buffer, made.bytes);
    }
    kept.merge(fresh);
    made_ = std::move(kept);
    return ok_status();
}

compute::Buffer NamedBuffers::operator[](const std::string& label) const {
    const auto found = made_.find(label);
    return found == made_.end() ? compute::Buffer{} : found->second.buffer;
}

} // namespace wadi
