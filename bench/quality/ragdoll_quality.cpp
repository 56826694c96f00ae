#include "bench/quality/characters_quality.h"
#include "content/make/models/mannequin.h"
#include "ecs/base/rng.h"
#include "systems/animation/ragdoll/ragdoll_contacts.h"
#include "systems/animation/ragdoll/ragdoll_scene.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

// Techniques: char.dynamics

namespace limn::ragdoll_quality {
namespace {

constexpr double kStep = 1.0 / 60;
constexpr double kDegrees = 180 / 3.14159265358979323846;

/// A mannequin in its rest pose, `height` above the ground.
RagdollScene make_figure(const RagdollRig& rig, const SkeletonData& skeleton, float height) {
    std::vector<Affine> joints;
    for (std::size_t j = 0; j < skeleton.parents.size(); ++j) {
        const LocalPose& rest = skeleton.rest;
        const Affine local = affine_from(rest.translations[j], rest.rotations[j], rest.scales[j]);
        const std::int32_t parent = skeleton.parents[j];
        joints.push_back(parent < 0 ? local : joints[static_cast<std::size_t>(parent)] * local);
    }
    const Affine world = affine_from({0, height, 0}, {1, 0, 0, 0}, Vec3(1));
    RagdollScene scene = make_ragdoll_scene(rig, {}, world, joints);
    for (RagdollJoint& joint : scene.joints) {
        joint.slack = limit_excess(scene, joint);
    }
    return scene;
}

void throw_about(RagdollScene& scene, std::uint64_t seed, float speed) {
    Random random(seed, 0, name_hash("throw ragdoll"), 0);
    for (RigidCapsule& body : scene.bodies) {
        const Vec3 direction = random.direction();
        body.velocity += RigidVec(speed * direction);
    }
}

/// A floor and ten steps down toward +z.
std::vector<RagdollObstacle> make_stairs() {
    std::vector<RagdollObstacle> obstacles;
    const auto add = [&](const Collider& shape) {
        RagdollObstacle& one = obstacles.emplace_back();
        one.shape = shape;
        one.bounds = find_collider_bounds(shape);
    };
    add(PlaneCollider{});
    for (int i = 0; i < 10; ++i) {
        const auto step = static_cast<float>(i);
        BoxCollider box;
        box.world_from_box =
            affine_from({0, 1.5f - 0.17f * step, 0.3f * step}, {1, 0, 0, 0}, Vec3(1));
        box.half = {1, 0.2f, 0.15f};
        add(box);
    }
    return obstacles;
}

struct TumblingErrors {
    double anchor = 0;  ///< [m]
    double excess = 0;  ///< [rad]
    double speed = 0;   ///< in the last second [m/s]
    double depth = 0;   ///< of the bodies in the obstacles [m]
};

/// Figures tumble down the stairs, each thrown in another way.
TumblingErrors measure_tumbling(const RagdollRig& rig, const SkeletonData& skeleton) {
    const std::vector<RagdollObstacle> obstacles = make_stairs();
    const RagdollOptions options = {.damping = 3};
    TumblingErrors errors;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        RagdollScene scene = make_figure(rig, skeleton, 1.75f);
        throw_about(scene, seed, 2);
        for (int i = 0; i < 360; ++i) {
            const RagdollContacts contacts(obstacles, rig.apart, scene.bodies, kStep);
            step_ragdoll(
                scene, kStep, options,
                [&](const std::vector<RigidCapsule>& bodies, double left,
                    std::vector<RagdollContact>& found) { contacts.find(bodies, left, found); });
            for (const RagdollJoint& joint : scene.joints) {
                errors.anchor = std::max(errors.anchor, anchor_error(scene, joint));
                errors.excess = std::max(errors.excess, limit_excess(scene, joint) - joint.slack);
            }
            std::vector<RagdollContact> found;
            contacts.find(scene.bodies, 0, found);
            for (const RagdollContact& contact : found) {
                const RigidCapsule& body = scene.bodies[contact.body];
                if (contact.other == RagdollContact::kNoBody) {
                    const RigidVec at = body.position + body.rotation * contact.point;
                    errors.depth =
                        std::max(errors.depth, -glm::dot(at - contact.under, contact.normal));
                }
            }
            if (i >= 300) {
                for (const RigidCapsule& body : scene.bodies) {
                    errors.speed = std::max(errors.speed, glm::length(body.velocity));
                }
            }
        }
    }
    return errors;
}

/// Changes of momenta of a free figure in 2 s, relative to what it had.
struct MomentumDrift {
    double linear = 0;
    double angular = 0;
    double energy = 0;  ///< gained
};
MomentumDrift measure_drift(const RagdollRig& rig, const SkeletonData& skeleton) {
    RagdollScene scene = make_figure(rig, skeleton, 0);
    throw_about(scene, 3, 2);
    const auto sums = [&](RigidVec& linear, RigidVec& angular, double& energy) {
        linear = angular = RigidVec(0);
        energy = 0;
        for (const RigidCapsule& body : scene.bodies) {
            const RigidVec axis = body.rotation * body.axis;
            const RigidVec along = glm::dot(axis, body.spin) * axis;
            const RigidVec turn =
                along / body.inverse_along + (body.spin - along) / body.inverse_across;
            const RigidVec push = body.velocity / body.inverse_mass;
            linear += push;
            angular += glm::cross(body.position, push) + turn;
            energy += 0.5 * glm::dot(push, body.velocity) + 0.5 * glm::dot(turn, body.spin);
        }
    };
    RigidVec linear, angular, linear_last, angular_last;
    double energy = 0;
    double energy_last = 0;
    sums(linear, angular, energy);
    const double first = energy;
    MomentumDrift drift;
    for (int i = 0; i < 120; ++i) {
        step_ragdoll(scene, kStep, {.gravity = RigidVec(0)});
        sums(linear_last, angular_last, energy_last);
        drift.energy = std::max(drift.energy, (energy_last - energy) / first);
        energy = energy_last;
    }
    drift.linear = glm::length(linear_last - linear) / glm::length(linear);
    drift.angular = glm::length(angular_last - angular) / glm::length(angular);
    return drift;
}

Status measure_ragdoll(HeadlessRenderer& /*headless*/, QualityReport& report) {
    const SkeletonData skeleton = make_mannequin_rig({}).skeleton;
    const RagdollRig rig = make_ragdoll_rig(skeleton);
    const TumblingErrors errors = measure_tumbling(rig, skeleton);
    report.at_most("anchors apart, eight figures down stairs", 1000 * errors.anchor, 1, "mm");
    report.at_most("joints beyond their limits", kDegrees * errors.excess, 3.5, "degrees");
    report.at_most("bodies in steps and floor, after a step", 1000 * errors.depth, 20, "mm");
    report.at_most("fastest limb in the sixth second, awake", errors.speed, 0.5, "m/s");
    const MomentumDrift drift = measure_drift(rig, skeleton);
    report.at_most("drift of linear momentum in 2 s, free", 100 * drift.linear, 1e-6, "%");
    report.at_most("drift of angular momentum", 100 * drift.angular, 1, "%");
    report.at_most("energy gained in a step", 100 * drift.energy, 0.01, "%");
    return Done{};
}

const RegisterCharacterPart kRagdollPart("ragdoll", measure_ragdoll);

}  // namespace
}  // namespace limn::ragdoll_quality
