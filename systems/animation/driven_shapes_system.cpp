#include "systems/animation/driven_shapes_system.h"

#include "ecs/base/rotation.h"
#include "ecs/components/bend_shapes.h"
#include "systems/animation/twist_pose.h"

#include <algorithm>
#include <cstddef>
#include <vector>

// Techniques: char.skin-defects

namespace limn {
namespace {

float tent(float weight, float peak) {
    const float rise = weight / peak;
    const float fall = peak < 1 ? (1 - weight) / (1 - peak) : 1;
    return std::clamp(std::min(rise, fall), 0.0f, 1.0f);
}

bool has_drivers(const MorphTarget& target) {
    return !target.drivers.empty();
}

/// `weights`: of a character; those of `targets` begin at `first`.
void drive(std::span<const MorphTarget> targets, std::size_t first, std::vector<float>& weights) {
    if (weights.size() <= first) {
        return;
    }
    const std::span<float> own = std::span(weights).subspan(first);
    for (std::size_t t = 0; t < std::min(targets.size(), own.size()); ++t) {
        if (has_drivers(targets[t])) {
            own[t] = driven_weight(targets[t].drivers, own);
        }
    }
}

/// Shapes jump with their drivers.
void drive_jumps(std::span<const MorphTarget> targets, std::size_t first, MorphWeights& morph) {
    if (morph.jumps.empty()) {
        return;
    }
    std::vector<float> before = morph.previous;
    for (const ValueJump<float>& jump : morph.jumps) {
        before[jump.index] = jump.before;
    }
    drive(targets, first, before);
    const float at = morph.jumps.front().at;
    for (std::size_t t = first; t < std::min(first + targets.size(), before.size()); ++t) {
        if (has_drivers(targets[t - first]) && before[t] != morph.previous[t]
            && std::ranges::find(morph.jumps, t, &ValueJump<float>::index) == morph.jumps.end()) {
            morph.jumps.push_back({static_cast<std::uint16_t>(t), at, before[t]});
        }
    }
    std::ranges::sort(morph.jumps, {}, &ValueJump<float>::index);
}

bool is_bend(const MorphTarget& target) {
    return target.name.starts_with(kBendShapePrefix);
}

Quat rotation_of(const Affine& place) {
    const auto& row = place.row;
    const Mat3 axes(
        Vec3(row[0].x, row[1].x, row[2].x), Vec3(row[0].y, row[1].y, row[2].y),
        Vec3(row[0].z, row[1].z, row[2].z));
    return extract_rotation(axes).value_or(Quat(1, 0, 0, 0));
}

/// `weights`: of a character with these joint matrices; those of `targets` begin at `first`.
void drive_bends(
    std::span<const MorphTarget> targets, std::size_t first, const SkeletonData& skeleton,
    std::span<const Affine> joints, std::vector<float>& weights) {
    for (std::size_t t = 0; t < targets.size() && first + t < weights.size(); ++t) {
        if (!is_bend(targets[t])) {
            continue;
        }
        const BendName name = parse_bend_name(targets[t].name);
        const auto found = std::ranges::find(skeleton.joints, name.joint);
        if (found != skeleton.joints.end()) {
            const auto index = static_cast<std::size_t>(found - skeleton.joints.begin());
            weights[first + t] = bend_shape_weight(joint_bend(skeleton, joints, index, name.axis));
        }
    }
}

}  // namespace

float joint_bend(
    const SkeletonData& skeleton, std::span<const Affine> joints, std::size_t joint,
    std::size_t axis) {
    const auto first = std::ranges::find(skeleton.freedoms, joint, &JointFreedom::joint);
    if (static_cast<std::size_t>(skeleton.freedoms.end() - first) <= axis || joint >= joints.size()
        || skeleton.parents[joint] < 0) {
        return 0;
    }
    const auto freedom = first + static_cast<std::ptrdiff_t>(axis);
    if (freedom->joint != joint) {
        return 0;
    }
    const Quat parent = rotation_of(joints[static_cast<std::size_t>(skeleton.parents[joint])]);
    const Quat local = glm::conjugate(parent) * rotation_of(joints[joint]);
    const float angle =
        twist_angle(glm::conjugate(skeleton.rest.rotations[joint]) * local, freedom->axis);
    return freedom->max >= -freedom->min ? angle : -angle;
}

float driven_weight(std::span<const ShapeDriver> drivers, std::span<const float> weights) {
    float product = 1;
    for (const ShapeDriver& driver : drivers) {
        const float weight = driver.target < weights.size() ? weights[driver.target] : 0.0f;
        product *= weight > 0 ? tent(weight, driver.peak) : 0.0f;  // NaN: 0
    }
    return product;
}

void update_driven_shapes(
    Query<const Deformed, const MeshInstance> meshes, Query<MorphWeights> faces,
    Query<const Skeleton, const Pose> bodies, Res<const Assets> assets) {
    meshes.each([&](const Deformed& deformed, const MeshInstance& instance) {
        if (instance.mesh.index >= assets->meshes.size()) {
            return;
        }
        const std::span<const MorphTarget> targets = assets->meshes[instance.mesh.index].morphs;
        const bool drives = std::ranges::any_of(targets, has_drivers);
        const bool bends = std::ranges::any_of(targets, is_bend);
        MorphWeights* const morph =
            drives || bends ? faces.find<MorphWeights>(deformed.character) : nullptr;
        if (morph == nullptr) {
            return;
        }
        const Skeleton* const body =
            bends ? bodies.find<const Skeleton>(deformed.character) : nullptr;
        if (body != nullptr && body->skeleton.index < assets->skeletons.size()) {
            const SkeletonData& skeleton = assets->skeletons[body->skeleton.index];
            const Pose& pose = *bodies.find<const Pose>(deformed.character);
            drive_bends(targets, deformed.first_morph, skeleton, pose.joints, morph->weights);
            drive_bends(targets, deformed.first_morph, skeleton, pose.previous, morph->previous);
        }
        if (drives) {
            drive(targets, deformed.first_morph, morph->weights);
            drive(targets, deformed.first_morph, morph->previous);
            drive_jumps(targets, deformed.first_morph, *morph);
        }
    });
}

}  // namespace limn
