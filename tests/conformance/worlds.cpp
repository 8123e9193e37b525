#include "tests/conformance/worlds.hpp"
#include "tests/conformance/compare.hpp"

namespace wadi::conformance {

Result<std::unique_ptr<World>> open_world(Session& session, const Scene& scene) {
    auto device = session.borrow();
    if (!device) return device.status();
    return World::create(scene.settings, scene.fields, std::move(*device));
}

Result<std::unique_ptr<World>> open_world(Session& session, const Scene& scene, const compute::DeviceOptions& options) {
    auto device = session.fresh(options);
    if (!device) return device.status();
    return World::create(scene.settings, scene.fields, std::move(*device));
}

Verdict same_state(World& got, World& expected) {
    const FieldLayout layout{got.settings().grid.nx, got.settings().grid.ny};
    for (const auto& field : expected.plan().fields) {
        if (field.role != FieldRole::state) continue;
        auto a = got.reader().read_raw(field.name);
        auto b = expected.reader().read_raw(field.name);
        if (!a) return verdict_of(a.status());
        if (!b) return verdict_of(b.status());
        const Verdict verdict = compare_bits(field.name, *a, *b, layout, whole_layout(layout));
        if (verdict.outcome != Outcome::ok) return verdict;
    }
    return {};
}

} // namespace wadi::conformance
