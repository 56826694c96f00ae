#include "content/load/motion/bone_figure.h"

#include "content/bake/tangents.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/components/humanoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

namespace limn {
namespace {

constexpr float kBoneWidth = 0.1f;    // of the bone's length; by eye
constexpr float kBoneWaist = 0.2f;    // where it is widest, of the length
constexpr float kJointSize = 0.035f;  // of the mean length of bones that meet; by eye
constexpr float kMaxWidth = 0.02f;    // of the figure's size

enum class BodySide : std::uint8_t { Middle, Left, Right };

/// The side of each joint: that of the limb that it belongs to.
std::vector<BodySide> find_sides(const SkeletonData& skeleton) {
    const BodyJoints body = find_body_joints(skeleton);
    std::vector<BodySide> sides(skeleton.joints.size(), BodySide::Middle);
    const auto mark = [&](BodyPart part, BodySide side) {
        if (body.has(part)) {
            sides[body[part]] = side;
        }
    };
    for (const BodyPart part :
         {BodyPart::LeftShoulder, BodyPart::LeftUpperArm, BodyPart::LeftThigh}) {
        mark(part, BodySide::Left);
    }
    for (const BodyPart part :
         {BodyPart::RightShoulder, BodyPart::RightUpperArm, BodyPart::RightThigh}) {
        mark(part, BodySide::Right);
    }
    for (std::size_t j = 1; j < sides.size(); ++j) {  // parents first
        if (sides[j] == BodySide::Middle) {
            sides[j] = sides[static_cast<std::size_t>(skeleton.parents[j])];
        }
    }
    return sides;
}

/// Adds an octahedron from `from` to `to`, `width` thick at `waist` of its length, that moves with
/// `joint` of the skin.
void add_octahedron(
    MeshData& mesh, const Vec3& from, const Vec3& to, float width, float waist,
    std::uint16_t joint) {
    const Vec3 along = normalize_or(to - from, Vec3(0, 1, 0));
    const Vec3 x = any_perpendicular(along);
    const Vec3 y = glm::cross(along, x);
    const Vec3 middle = glm::mix(from, to, waist);
    for (int side = 0; side < 4; ++side) {
        constexpr std::array<Vec2, 5> kCorners = {
            Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1), Vec2(1, 0)};
        const auto corner = [&](int i) {
            const Vec2 c = width * kCorners[static_cast<std::size_t>(i)];
            return middle + c.x * x + c.y * y;
        };
        const Vec3 a = corner(side);
        const Vec3 b = corner(side + 1);
        for (const auto& triangle : {std::array{a, b, to}, std::array{b, a, from}}) {
            for (const Vec3& p : triangle) {
                mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
                mesh.positions.push_back(p);
                mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
                mesh.skin.joints.push_back(joint);
                mesh.skin.weights.push_back(1.0f);
            }
        }
    }
}

void finish_mesh(MeshData& mesh) {
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    mesh.uvs.assign(mesh.positions.size(), Vec2(0));
    generate_normals(mesh, 0.0f);
    generate_tangents(mesh);
    update_bounds(mesh);
}

}  // namespace

BoneFigure make_bone_figure(const SkeletonData& skeleton) {
    const std::size_t count = skeleton.joints.size();
    const std::vector<Affine> rest = find_rest_joints(skeleton);
    const std::vector<BodySide> sides = find_sides(skeleton);
    std::vector<Vec3> positions;
    Bounds box;
    for (std::size_t j = 0; j < count; ++j) {
        positions.push_back(transform_point(rest[j], Vec3(0)));
        if (j > 0) {
            grow(box, positions[j]);
        }
    }
    const float size = is_empty(box) ? 0.0f : 2 * glm::length(half_extent(box));
    std::array<MeshData, 3> meshes;
    std::vector<float> lengths(count, 0.0f);  // sums over the bones that meet in a joint
    std::vector<float> bones(count, 0.0f);
    for (std::size_t j = 1; j < count; ++j) {
        const std::int32_t parent = skeleton.parents[j];
        const auto p = static_cast<std::size_t>(parent);
        const float length = glm::distance(positions[j], positions[p]);
        if (p == 0 || !(length > 1e-5f * size)) {
            continue;
        }
        for (const std::size_t end : {j, p}) {
            lengths[end] += length;
            bones[end] += 1;
        }
        add_octahedron(
            meshes[static_cast<std::size_t>(sides[j])], positions[p], positions[j],
            std::min(kBoneWidth * length, kMaxWidth * size), kBoneWaist,
            static_cast<std::uint16_t>(p - 1));
    }
    for (std::size_t j = 1; j < count; ++j) {
        if (bones[j] > 0) {
            const float radius =
                std::min(kJointSize * lengths[j] / bones[j], 0.4f * kMaxWidth * size);
            const Vec3 up(0, radius, 0);
            add_octahedron(
                meshes[static_cast<std::size_t>(sides[j])], positions[j] - up, positions[j] + up,
                radius, 0.5f, static_cast<std::uint16_t>(j - 1));
        }
    }
    constexpr std::array<const char*, 3> kNames = {"middle", "left side", "right side"};
    const std::array<Vec4, 3> colors = {
        Vec4(0.35f, 0.34f, 0.32f, 1), Vec4(0.06f, 0.2f, 0.6f, 1), Vec4(0.75f, 0.22f, 0.03f, 1)};
    BoneFigure figure;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        if (!meshes[m].positions.empty()) {
            meshes[m].name = kNames[m];
            finish_mesh(meshes[m]);
            figure.meshes.push_back(std::move(meshes[m]));
            figure.materials.push_back({.name = kNames[m], .base_color = colors[m]});
        }
    }
    figure.skin.name = "bones";
    figure.skin.joints.resize(count - 1);
    std::iota(figure.skin.joints.begin(), figure.skin.joints.end(), std::uint16_t{1});
    for (std::size_t j = 1; j < count; ++j) {
        figure.skin.joint_from_mesh.push_back(to_affine(glm::inverse(to_mat4(rest[j]))));
    }
    return figure;
}

}  // namespace limn
