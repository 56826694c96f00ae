// What bent and twisted limbs of generated people look like.

#include "content/make/person/person.h"
#include "content/make/person/person_face.h"
#include "ecs/base/rotation.h"
#include "ecs/components/bend_shapes.h"
#include "systems/animation/twist_pose.h"
#include "tests/content/mesh_laws.h"
#include "tests/content/posed_person.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
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

/// The triangles that `top` and what is below it move alone.
MeshData limb_shell(const MeshData& mesh, const SkeletonData& skeleton, const char* top) {
    std::vector<bool> carried(skeleton.joints.size(), false);
    for (std::size_t j = joint_called(skeleton, top); j < carried.size(); ++j) {
        const std::int32_t parent = skeleton.parents[j];
        carried[j] = j == joint_called(skeleton, top)
                     || (parent >= 0 && carried[static_cast<std::size_t>(parent)]);
    }
    MeshData shell = mesh;
    shell.indices.clear();
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.indices[i + k];
            for (std::uint32_t w = mesh.skin.first[v]; w < mesh.skin.first[v + 1]; ++w) {
                inside = inside && carried[mesh.skin.joints[w]];
            }
        }
        if (inside) {
            shell.indices.insert(
                shell.indices.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
        }
    }
    return shell;
}

/// The rest pose with one joint bent about its first axis, to the side of its wider limit.
LocalPose bent(const SkeletonData& skeleton, const char* joint, float angle) {
    LocalPose pose = skeleton.rest;
    const std::size_t index = joint_called(skeleton, joint);
    for (const JointFreedom& freedom : skeleton.freedoms) {
        if (freedom.joint == index) {
            const float side = freedom.max >= -freedom.min ? 1.0f : -1.0f;
            pose.rotations[index] = rotation_about(freedom.axis, side * angle);
            break;
        }
    }
    return pose;
}

/// Arms raised from where they hang by `angle` [rad], by a shoulder girdle that takes a third; the
/// axis is forward, that of the second freedom of the joints.
LocalPose raised(const SkeletonData& skeleton, float angle) {
    LocalPose pose = skeleton.rest;
    const float beyond = angle - kPi / 4;  // at rest, arms are 45 degrees below the horizontal
    for (const auto& [side, name] : {std::pair(1.0f, "Left"), std::pair(-1.0f, "Right")}) {
        const std::string s = name;
        pose.rotations[joint_called(skeleton, s + "Shoulder")] =
            rotation_about({0, 0, side}, beyond / 3);
        pose.rotations[joint_called(skeleton, s + "UpperArm")] =
            rotation_about({0, 0, side}, 2 * beyond / 3);
    }
    return pose;
}

/// Of the skin below the left shoulder that the arm moves about half: its smallest distance from
/// the axis of the joint, over that at rest. `rest`: without corrective shapes.
float nearest_armpit(
    const MeshData& rest, const MeshData& mesh, const SkeletonData& skeleton,
    const LocalPose& pose) {
    const LocalPose placed = placed_joints(skeleton, pose);
    const std::size_t arm = joint_called(skeleton, "LeftUpperArm");
    const std::size_t twist = joint_called(skeleton, "LeftUpperArmTwist");
    const Vec3 center = rest_point(skeleton, static_cast<std::int32_t>(arm));
    const MeshData moved = posed_mesh(mesh, skeleton, pose);
    float least = 10;
    for (std::size_t v = 0; v < rest.positions.size(); ++v) {
        float share = 0;
        for (std::uint32_t i = rest.skin.first[v]; i < rest.skin.first[v + 1]; ++i) {
            const std::size_t joint = rest.skin.joints[i];
            share += joint == arm || joint == twist ? rest.skin.weights[i] : 0.0f;
        }
        const Vec3 from = rest.positions[v] - center;
        if (share > 0.25f && share < 0.75f && from.x + from.y < -0.4f * glm::length(from)) {
            const float before = glm::length(Vec2(from));
            const float after = glm::length(Vec2(moved.positions[v] - placed.translations[arm]));
            least = std::min(least, after / before);
        }
    }
    return least;
}

/// With the bend shape of a joint.
MeshData with_bend(MeshData mesh, const std::string& joint, float weight) {
    for (const MorphTarget& shape : mesh.morphs) {
        for (std::size_t i = 0; shape.name == "bend " + joint && i < shape.vertices.size(); ++i) {
            mesh.positions[shape.vertices[i]] += weight * shape.positions[i];
        }
    }
    return mesh;
}

/// How far the skin reaches from a joint away from where it bends to.
float outermost(
    const MeshData& mesh, const SkeletonData& skeleton, const LocalPose& pose, const char* joint,
    const char* end) {
    const LocalPose placed = placed_joints(skeleton, pose);
    const std::size_t middle = joint_called(skeleton, joint);
    const auto top = static_cast<std::size_t>(skeleton.parents[middle]);
    const Vec3 center = placed.translations[middle];
    const Vec3 upper = glm::normalize(placed.translations[top] - center);
    const Vec3 lower = glm::normalize(placed.translations[joint_called(skeleton, end)] - center);
    const LocalPose folded = placed_joints(skeleton, bent(skeleton, joint, kFullBend));
    const Vec3 fold =
        folded.translations[joint_called(skeleton, end)] - folded.translations[middle];
    const bool straight = glm::dot(upper, lower) < -0.8f;
    const Vec3 out = straight ? -glm::normalize(fold - glm::dot(fold, upper) * upper)
                              : -glm::normalize(upper + lower);
    const MeshData moved = posed_mesh(mesh, skeleton, pose);
    float farthest = 0;
    for (const std::uint32_t v : mesh.indices) {
        const Vec3 from = moved.positions[v] - center;
        const float height = glm::dot(from, out);
        if (glm::length(from - height * out) < 0.025f) {
            farthest = std::max(farthest, height);
        }
    }
    return farthest;
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
    "person: an upper arm that turns about itself keeps its cross-section by twist joints"
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
        CHECK(twisted >= 0.85);
        CHECK(bare < 0.8);
    }
}

TEST_CASE(
    "person: elbows and knees bent by 120 degrees keep the volume of a limb, by corrective shapes"
    * technique("char.skin-defects")) {
    struct Limb {
        const char* joint;
        const char* end;
        const char* top;  ///< whose weights alone move the shell that is measured
        float most_lost;
    };
    constexpr Limb kLimbs[] = {
        {"LeftForearm", "LeftHand", "LeftUpperArm", 0.03f},
        {"LeftShin", "LeftFoot", "LeftThigh", 0.03f}};
    for (const int seed : {1, 2, 3}) {
        const PersonShape shape = {
            .part = PersonPart::Skin,
            .seed = seed,
            .legs = PersonLegwear::Shorts,
            .sleeves = PersonSleeves::Short};
        const MeshData skin = make_person(shape);
        const SkeletonData skeleton = make_person_rig(shape).skeleton;
        for (const Limb& limb : kLimbs) {
            CAPTURE(seed);
            CAPTURE(limb.joint);
            const MeshData shell = limb_shell(skin, skeleton, limb.top);
            const LocalPose pose = bent(skeleton, limb.joint, kFullBend);
            const double volume = signed_volume(shell);
            const double bare = signed_volume(posed_mesh(shell, skeleton, pose));
            const double corrected =
                signed_volume(posed_mesh(with_bend(shell, limb.joint, 1), skeleton, pose));
            CAPTURE(bare / volume);
            CAPTURE(corrected / volume);
            CHECK(std::abs(corrected / volume - 1) < limb.most_lost);
            CHECK(std::abs(corrected / volume - 1) < 0.5 * std::abs(bare / volume - 1));
            // The tip of the elbow, the knee cap: half and half between two bones.
            CHECK(outermost(shell, skeleton, skeleton.rest, limb.joint, limb.end) > 0.02f);
            const float rest = outermost(shell, skeleton, skeleton.rest, limb.joint, limb.end);
            CHECK(outermost(shell, skeleton, pose, limb.joint, limb.end) < 0.75f * rest);
            CHECK(
                outermost(with_bend(shell, limb.joint, 1), skeleton, pose, limb.joint, limb.end)
                > 0.9f * rest);
        }
    }
}

TEST_CASE(
    "person: arms raised by 90 and 150 degrees keep their armpits, by a corrective shape"
    * technique("char.skin-defects")) {
    for (const int seed : {1, 2, 3}) {
        for (const float degrees : {90.0f, 150.0f}) {
            CAPTURE(seed);
            CAPTURE(degrees);
            const PersonShape shape = {
                .part = PersonPart::Shirt, .seed = seed, .sleeves = PersonSleeves::Long};
            const MeshData shirt = make_person(shape);
            const SkeletonData skeleton = make_person_rig(shape).skeleton;
            const float angle = radians(degrees);
            const LocalPose pose = raised(skeleton, angle);
            const float weight = bend_shape_weight(2 * (angle - kPi / 4) / 3);
            MeshData corrected = shirt;
            for (const char* joint : {"LeftUpperArm axis 2", "RightUpperArm axis 2"}) {
                corrected = with_bend(corrected, joint, weight);
            }
            const double volume = signed_volume(shirt);
            const double whole = signed_volume(posed_mesh(corrected, skeleton, pose));
            CHECK(whole == near(volume).epsilon(0.12));
            const float bare = nearest_armpit(shirt, shirt, skeleton, pose);
            const float kept = nearest_armpit(shirt, corrected, skeleton, pose);
            CAPTURE(bare);
            CAPTURE(kept);
            CHECK(kept > (degrees > 100 ? 0.9f : 0.98f));
            CHECK((degrees < 100 || bare < 0.85f));
        }
    }
}

TEST_CASE("person: bend shapes of all parts are the same list, and levels of detail have none") {
    std::vector<std::string> names;
    for (const PersonPart part :
         {PersonPart::Skin, PersonPart::Shirt, PersonPart::Trousers, PersonPart::All}) {
        const MeshData mesh = make_person({.part = part, .seed = 2});
        // The face of what has one follows.
        const bool face = part == PersonPart::Skin || part == PersonPart::All;
        REQUIRE(mesh.morphs.size() == 8u + (face ? kPersonFaceShapes : 0u));
        for (std::size_t t = 0; t < 8; ++t) {
            const MorphTarget& shape = mesh.morphs[t];
            names.push_back(shape.name);
            CHECK(shape.name == names[t]);
            CHECK(shape.positions.size() == shape.vertices.size());
            for (const Vec3& shift : shape.positions) {
                CHECK(glm::length(shift) < (shape.name.ends_with("axis 2") ? 0.27f : 0.12f));
            }
        }
    }
    CHECK(names[0] == "bend LeftForearm");
    CHECK(make_person({.seed = 2, .triangles = 2000}).morphs.empty());
}

}  // namespace limn::person_bend_test
