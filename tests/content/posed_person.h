#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::test {

// Meshes in poses of skeletons whose rest rotations are the identity.

/// Where a joint rests.
inline Vec3 rest_point(const SkeletonData& skeleton, std::int32_t joint) {
    Vec3 p(0);
    for (; joint >= 0; joint = skeleton.parents[static_cast<std::size_t>(joint)]) {
        p += skeleton.rest.translations[static_cast<std::size_t>(joint)];
    }
    return p;
}

inline std::size_t joint_called(const SkeletonData& skeleton, const std::string& name) {
    for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
        if (skeleton.joints[i] == name) {
            return i;
        }
    }
    FAIL("no joint ", name);
    return 0;
}

/// At the first key of the sheets of a clip.
inline LocalPose first_pose(const SkeletonData& skeleton, const ClipData& clip) {
    LocalPose pose = skeleton.rest;
    for (const ClipSheet& sheet : clip.sheets) {
        for (std::size_t i = 0; i < sheet.rotating.size(); ++i) {
            pose.rotations[sheet.rotating[i]] = sheet.rotations[i];
        }
        for (std::size_t i = 0; i < sheet.translating.size(); ++i) {
            pose.translations[sheet.translating[i]] = sheet.translations[i];
        }
    }
    return pose;
}

/// Rotations and positions of all joints in the space of the character.
inline LocalPose placed_joints(const SkeletonData& skeleton, const LocalPose& pose) {
    LocalPose placed = pose;
    for (std::size_t j = 1; j < placed.rotations.size(); ++j) {
        const auto parent = static_cast<std::size_t>(skeleton.parents[j]);
        placed.translations[j] =
            placed.translations[parent] + placed.rotations[parent] * pose.translations[j];
        placed.rotations[j] = placed.rotations[parent] * pose.rotations[j];
    }
    return placed;
}

/// By linear blend skinning.
inline MeshData
posed_mesh(const MeshData& mesh, const SkeletonData& skeleton, const LocalPose& pose) {
    const LocalPose placed = placed_joints(skeleton, pose);
    MeshData moved = mesh;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Vec3 sum(0);
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            const std::uint16_t j = mesh.skin.joints[i];
            const Vec3 from = mesh.positions[v] - rest_point(skeleton, j);
            sum += mesh.skin.weights[i] * (placed.translations[j] + placed.rotations[j] * from);
        }
        moved.positions[v] = sum;
    }
    return moved;
}

}  // namespace limn::test
