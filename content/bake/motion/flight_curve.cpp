#include "content/bake/motion/flight_curve.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

// Techniques: char.walk-retarget

namespace limn {
namespace {

Vec3 path_at(const std::vector<Vec3>& path, float frame) {
    const float at = std::clamp(frame, 0.0f, static_cast<float>(path.size() - 1));
    const auto first = static_cast<std::size_t>(at);
    const std::size_t second = std::min(first + 1, path.size() - 1);
    return glm::mix(path[first], path[second], at - static_cast<float>(first));
}

FlightCurve make_flight(
    const std::vector<Vec3>& path, float rate, const ClipContact& before, float end,
    std::size_t samples) {
    FlightCurve curve;
    curve.joint = before.joint;
    curve.begin = before.end;
    curve.end = end;
    const Vec3 start = path_at(path, curve.begin * rate);
    const Vec3 stop = path_at(path, curve.end * rate);
    const Vec3 way(stop.x - start.x, 0, stop.z - start.z);
    curve.length = glm::length(way);
    const Vec3 forward = normalize_or(way, Vec3(0, 0, 1));
    for (std::size_t i = 0; i < samples; ++i) {
        const float u = static_cast<float>(i) / static_cast<float>(samples - 1);
        const Vec3 at = path_at(path, glm::mix(curve.begin, curve.end, u) * rate);
        curve.points.emplace_back(
            glm::dot(at - start, forward), at.y - glm::mix(start.y, stop.y, u));
        curve.height = std::max(curve.height, curve.points.back().y);
    }
    for (Vec2& point : curve.points) {
        point.x = curve.length > 0 ? point.x / curve.length : 0.0f;
        point.y = curve.height > 0 ? point.y / curve.height : 0.0f;
    }
    return curve;
}

}  // namespace

std::vector<FlightCurve> extract_flights(
    const SkeletonData& skeleton, const MotionFrames& frames, std::span<const ClipContact> contacts,
    std::size_t samples) {
    LIMN_CHECK(samples >= 2);
    std::vector<FlightCurve> flights;
    std::map<std::uint16_t, std::pair<std::vector<Vec3>, const ClipContact*>> last;
    for (const ClipContact& contact : contacts) {
        auto& [path, previous] = last[contact.joint];
        if (path.empty()) {
            path = joint_path(skeleton, frames, contact.joint);
        }
        if (previous != nullptr && contact.begin > previous->end) {
            flights.push_back(make_flight(path, frames.rate, *previous, contact.begin, samples));
        }
        previous = &contact;
    }
    std::ranges::stable_sort(flights, {}, &FlightCurve::begin);
    return flights;
}

Vec2 sample_flight(const FlightCurve& curve, float u) {
    const float at = std::clamp(u, 0.0f, 1.0f) * static_cast<float>(curve.points.size() - 1);
    const auto first = static_cast<std::size_t>(at);
    const std::size_t second = std::min(first + 1, curve.points.size() - 1);
    return glm::mix(curve.points[first], curve.points[second], at - static_cast<float>(first));
}

}  // namespace limn
