// What bent and twisted limbs of generated people look like.

#include "content/make/person/person.h"
#include "ecs/base/rotation.h"
#include "systems/animation/twist_pose.h"
#include "tests/content/posed_mesh.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace limn::person_bend_test {

using namespace test;

namespace {

/// Area of the cross-section of a mesh by the plane through `center` with this normal, within
/// `radius`.
double section_area(const MeshData& mesh, const Vec3& center, const Vec3& normal, float radius) {
    Vec3 area(0);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        std::array<Vec3, 3> corners;
        std::array<float, 3> heights{};
        bool near_center = true;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = mesh.positions[mesh.indices[i + k]] - center;
            heights[k] = glm::dot(corners[k], normal);
            near_center = near_center && glm::length(corners[k]) < radius;
        }
        Vec3 enters(0);
        Vec3 leaves(0);
        int crossings = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            if ((heights[k] < 0) != (heights[next] < 0)) {
                const Vec3 p =
                    corners[k]
                    + heights[k] / (heights[k] - heights[next]) * (corners[next] - corners[k]);
                (heights[k] < 0 ? enters : leaves) = p;
                ++crossings;
            }
        }
        if (near_center && crossings == 2) {
            area += glm::cross(enters, leaves);
        }
    }
    return std::abs(0.5 * static_cast<double>(glm::dot(area, normal)));
}

/// The smallest ratio of the areas of cross-sections of a bone from `from` to `to`, in lengths of
/// the bone, in a pose to those at rest. The bone does not move.
double narrowest(
    const MeshData& mesh, const SkeletonData& skeleton, const LocalPose& pose,
    const char* const (&bone)[2], float from, float to) {
    const MeshData moved = posed_mesh(mesh, skeleton, pose);
    const auto at = [&](const char* joint) {
        return rest_point(skeleton, static_cast<std::int32_t>(joint_called(skeleton, joint)));
    };
    const Vec3 begin = at(bone[0]);
    const Vec3 along = at(bone[1]) - begin;
    const Vec3 normal = glm::normalize(along);
    double least = 1;
    constexpr int kSections = 32;
    for (int i = 0; i <= kSections; ++i) {
        const float s = std::lerp(from, to, static_cast<float>(i) / kSections);
        const Vec3 center = begin + s * along;
        least = std::min(
            least,
            section_area(moved, center, normal, 0.1f) / section_area(mesh, center, normal, 0.1f));
    }
    return least;
}

LocalPose with_twists(const SkeletonData& skeleton, LocalPose pose) {
    apply_twist_joints(skeleton, find_twist_links(skeleton, {}), 1, pose);
    return pose;
}

}  // namespace

TEST_CASE(
    "person: a forearm keeps its cross-section when the hand turns by a quarter, by twist joints"
    * technique("char.skin-defects")) {
    for (const int seed : {1, 2, 3}) {
        CAPTURE(seed);
        const PersonShape shape = {
            .part = PersonPart::Skin, .seed = seed, .sleeves = PersonSleeves::Short};
        const MeshData skin = make_person(shape);
        const SkeletonData skeleton = make_person_rig(shape).skeleton;
        LocalPose pose = skeleton.rest;
        const std::size_t hand = joint_called(skeleton, "LeftHand");
        pose.rotations[hand] = rotation_about(skeleton.rest.translations[hand], kPi / 2);
        constexpr const char* kForearm[] = {"LeftForearm", "LeftHand"};
        const double bare = narrowest(skin, skeleton, pose, kForearm, 0.25f, 1.05f);
        const double twisted =
            narrowest(skin, skeleton, with_twists(skeleton, pose), kForearm, 0.25f, 1.05f);
        CAPTURE(bare);
        CAPTURE(twisted);
        CHECK(twisted >= 0.85);
        CHECK(bare < 0.6);
    }
}

TEST_CASE(
    "person: an upper arm that turns about itself is less narrow below the shoulder by twist joints"
    * technique("char.skin-defects")) {
    for (const int seed : {1, 2, 3}) {
        CAPTURE(seed);
        const PersonShape shape = {
            .part = PersonPart::Shirt, .seed = seed, .sleeves = PersonSleeves::Long};
        const MeshData shirt = make_person(shape);
        const SkeletonData skeleton = make_person_rig(shape).skeleton;
        LocalPose pose = skeleton.rest;
        const std::size_t arm = joint_called(skeleton, "LeftUpperArm");
        const std::size_t elbow = joint_called(skeleton, "LeftForearm");
        pose.rotations[arm] = rotation_about(skeleton.rest.translations[elbow], radians(80.0f));
        constexpr const char* kArm[] = {"LeftUpperArm", "LeftForearm"};
        const double bare = narrowest(shirt, skeleton, pose, kArm, 0.2f, 0.6f);
        const double twisted =
            narrowest(shirt, skeleton, with_twists(skeleton, pose), kArm, 0.2f, 0.6f);
        CAPTURE(bare);
        CAPTURE(twisted);
        CHECK(twisted > bare + 0.02);
    }
}

}  // namespace limn::person_bend_test
