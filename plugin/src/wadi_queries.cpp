// The state at points of the world, and what it does to a floating body.
#include "engine/reads/buoyancy.hpp"
#include "plugin/src/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

namespace {

wadi_query_result to_result(std::span<const float, SAMPLE_FLOATS> s) {
    return {s[0], s[1], s[2], s[3], {s[4], s[5]}, {s[6], s[7], s[8]}, s[9], s[10] > 0 ? 1 : 0};
}

Vector3 to_vector(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// ok, or why the body is refused.
Status to_body(const char* function, const wadi_body* given, Body& body) {
    if (auto status = understood(std::string(function) + ": body", given); !status) return status;
    const auto from = taken(given, wadi_default_body());
    if (from.shape != WADI_BODY_BOX && from.shape != WADI_BODY_SPHERE)
        return error(Code::bad_argument, std::string(function) + ": body.shape is " + std::to_string(from.shape) +
                                             ", allowed are 0 (box) and 1 (sphere)");
    const auto& q = from.orientation;
    body = {from.shape == WADI_BODY_BOX ? BodyShape::box : BodyShape::sphere,
            to_vector(from.position),
            {q[0], q[1], q[2], q[3]},
            to_vector(from.half_size),
            from.radius,
            to_vector(from.velocity),
            to_vector(from.angular_velocity),
            from.water_density,
            from.gravity,
            from.linear_drag,
            from.quadratic_drag,
            from.samples};
    auto status = validate(body);
    if (!status) status.message = std::string(function) + ": " + status.message;
    return status;
}

} // namespace

extern "C" {

wadi_result wadi_world_query(wadi_world_id id, const float* xy, uint32_t count, uint64_t* ticket) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (ticket == nullptr || (xy == nullptr && count > 0)) return bad_argument("wadi_world_query: xy or ticket is NULL");
        auto asked = hosted.world->queries().ask({xy, std::size_t{count} * 2});
        if (asked) *ticket = *asked;
        return report(asked.status());
    });
}

wadi_result wadi_world_get_query(wadi_world_id id, uint64_t ticket, wadi_query_result* results, uint32_t capacity,
                                 uint32_t* count, uint64_t* step) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        auto answer = hosted.world->queries().answer(ticket);
        if (!answer) return report(answer.status());
        if (results != nullptr && capacity < answer->count) {
            return bad_argument("wadi_world_get_query: capacity is " + std::to_string(capacity) + ", the batch has " +
                                std::to_string(answer->count) + " points");
        }
        for (uint32_t n = 0; results != nullptr && n < answer->count; ++n)
            results[n] = to_result(answer->samples.subspan(std::size_t{n} * SAMPLE_FLOATS).first<SAMPLE_FLOATS>());
        if (count != nullptr) *count = answer->count;
        if (step != nullptr) *step = answer->step;
        return report(ok_status());
    });
}

wadi_result wadi_buoyancy_points(const wadi_body* from, float* xy, uint32_t* count) {
    return guarded(__func__, [&] {
        Body body;
        if (auto status = to_body("wadi_buoyancy_points", from, body); !status) return report(status);
        if (count == nullptr) return bad_argument("wadi_buoyancy_points: count is NULL");
        const uint32_t capacity = *count;
        *count = count_body_points(body);
        if (xy == nullptr) return report(ok_status());
        if (capacity < *count) {
            return bad_argument("wadi_buoyancy_points: count is " + std::to_string(capacity) + ", the body has " +
                                std::to_string(*count) + " points");
        }
        for_body_points(body, [&](double x, double y) {
            *xy++ = static_cast<float>(x);
            *xy++ = static_cast<float>(y);
        });
        return report(ok_status());
    });
}

wadi_result wadi_buoyancy_force(const wadi_body* from, const wadi_query_result* results, uint32_t count, float force[3],
                                float torque[3]) {
    return guarded(__func__, [&] {
        Body body;
        if (auto status = to_body("wadi_buoyancy_force", from, body); !status) return report(status);
        if (results == nullptr || force == nullptr || torque == nullptr)
            return bad_argument("wadi_buoyancy_force: results, force or torque is NULL");
        if (count != count_body_points(body)) {
            return bad_argument("wadi_buoyancy_force: count is " + std::to_string(count) + ", the body has " +
                                std::to_string(count_body_points(body)) + " points");
        }
        const auto wrench = buoyancy(body, [&](std::uint32_t n) {
            const auto& r = results[n];
            return WaterAt{r.inside != 0, r.surface, r.water_depth, r.velocity[0], r.velocity[1]};
        });
        for (std::size_t k = 0; k < 3; ++k) {
            force[k] = static_cast<float>(wrench.force[k]);
            torque[k] = static_cast<float>(wrench.torque[k]);
        }
        return report(ok_status());
    });
}

} // extern "C"
