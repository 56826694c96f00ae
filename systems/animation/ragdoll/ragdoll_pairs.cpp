#include "systems/animation/ragdoll/ragdoll_pairs.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

// Techniques: char.dynamics

namespace limn {
namespace {

constexpr double kPairMargin = 0.005;  // within which capsules that hardly move touch [m]

RigidVec point_velocity(const RigidCapsule& body, const RigidVec& at) {
    return body.velocity + glm::cross(body.spin, at - body.position);
}

double longest_way(const RigidCapsule& body, double dt) {
    const double arm = 0.5 * glm::distance(body.segment.from, body.segment.to) + body.radius;
    return dt * (glm::length(body.velocity) + arm * glm::length(body.spin));
}

}  // namespace

RagdollBodies bound_ragdoll(std::vector<RigidCapsule> bodies, double dt) {
    RagdollBodies bounded = {.bodies = std::move(bodies)};
    for (const RigidCapsule& body : bounded.bodies) {
        const LineSegment segment = body.placed();
        const RigidVec reach(body.radius + longest_way(body, dt) + kPairMargin);
        for (const RigidVec& end : {segment.from, segment.to}) {
            grow(bounded.box, Vec3(end - reach));
            grow(bounded.box, Vec3(end + reach));
        }
    }
    return bounded;
}

std::vector<std::vector<std::size_t>>
find_ragdoll_neighbors(std::span<const RagdollBodies> ragdolls) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < ragdolls.size(); ++i) {
        if (!ragdolls[i].bodies.empty()) {
            order.push_back(i);
        }
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return ragdolls[i].box.min.x; });
    std::vector<std::vector<std::size_t>> neighbors(ragdolls.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Bounds& box = ragdolls[order[i]].box;
        for (std::size_t k = i + 1; k < order.size(); ++k) {
            const Bounds& next = ragdolls[order[k]].box;
            if (next.min.x > box.max.x) {
                break;
            }
            if (box.min.y <= next.max.y && next.min.y <= box.max.y && box.min.z <= next.max.z
                && next.min.z <= box.max.z) {
                neighbors[order[i]].push_back(order[k]);
                neighbors[order[k]].push_back(order[i]);
            }
        }
    }
    for (std::vector<std::size_t>& list : neighbors) {
        std::ranges::sort(list);
    }
    return neighbors;
}

void find_parting_planes(
    const std::vector<RigidCapsule>& own, const std::vector<RigidCapsule>& other, double dt,
    std::vector<PartingPlane>& planes) {
    for (std::size_t i = 0; i < own.size(); ++i) {
        const RigidCapsule& a = own[i];
        for (const RigidCapsule& b : other) {
            const ClosestPair nearest = closest_points(a.placed(), b.placed());
            const double distance = glm::distance(nearest.on_a, nearest.on_b);
            const double gap = distance - a.radius - b.radius;
            if (!(distance > 1e-9) || gap > longest_way(a, dt) + longest_way(b, dt) + kPairMargin) {
                continue;
            }
            const RigidVec normal = (nearest.on_a - nearest.on_b) / distance;
            const RigidVec surface = nearest.on_a - a.radius * normal;
            const RigidVec velocity_a = point_velocity(a, surface);
            const RigidVec velocity_b = point_velocity(b, nearest.on_b + b.radius * normal);
            const double approach = -glm::dot(velocity_a - velocity_b, normal);
            if (gap > std::max(approach, 0.0) * dt + kPairMargin) {
                continue;
            }
            const double masses = a.inverse_mass + b.inverse_mass;
            const double share = masses > 0 ? a.inverse_mass / masses : 0;
            PartingPlane plane = {.body = i, .normal = normal};
            plane.velocity = velocity_a + share * (velocity_b - velocity_a);
            plane.point =
                surface
                - gap * share * normal;  // there when they meet; where they overlap, between
            planes.push_back(plane);
        }
    }
}

std::vector<RigidVec> balance_momentum(
    std::span<const RagdollOutcome> outcomes, std::span<const std::vector<std::size_t>> neighbors) {
    std::vector<RigidVec> changes(outcomes.size(), RigidVec(0));
    std::vector<std::uint8_t> is_done(outcomes.size(), 0);
    std::vector<std::size_t> group;
    for (std::size_t first = 0; first < outcomes.size(); ++first) {
        if (is_done[first] != 0 || !outcomes[first].meets) {
            continue;
        }
        group.assign(1, first);
        is_done[first] = 1;
        RigidVec received(0);
        double mass = 0;
        bool is_free = true;
        for (std::size_t i = 0; i < group.size(); ++i) {
            const RagdollOutcome& one = outcomes[group[i]];
            received += one.received;
            mass += one.mass;
            is_free = is_free && one.is_free;
            for (const std::size_t other : neighbors[group[i]]) {
                if (is_done[other] == 0 && outcomes[other].meets) {
                    is_done[other] = 1;
                    group.push_back(other);
                }
            }
        }
        for (const std::size_t i : group) {
            changes[i] = is_free && mass > 0 ? -received / mass : RigidVec(0);
        }
    }
    return changes;
}

}  // namespace limn
