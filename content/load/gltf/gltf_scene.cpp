#include "content/load/gltf/gltf_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

GltfAssetLists list_assets(const GltfScene& scene) {
    const std::size_t skeletons = scene.skeleton.joints.empty() ? 0 : 1;
    return {
        scene.meshes,
        scene.materials,
        scene.images,
        {&scene.skeleton, skeletons},
        scene.skins,
        scene.clips,
        {}};
}

std::vector<Affine> find_node_matrices(const GltfScene& scene) {
    std::vector<Affine> matrices;
    matrices.reserve(scene.nodes.size());
    for (const GltfNode& node : scene.nodes) {
        const Transform& t = node.transform;
        const Affine local = affine_from(t.position, t.rotation, t.scale);
        matrices.push_back(
            node.parent < 0 ? local : matrices[static_cast<std::size_t>(node.parent)] * local);
    }
    return matrices;
}

Bounds transform_bounds(const Affine& matrix, const Bounds& box) {
    Bounds result;
    if (is_empty(box)) {
        return result;
    }
    // The extent along an axis is the sum over the three half extents (Arvo 1990).
    const Vec3 box_center = transform_point(matrix, center(box));
    const Vec3 half = half_extent(box);
    Vec3 extent;
    for (int i = 0; i < 3; ++i) {
        extent[i] = glm::dot(glm::abs(Vec3(matrix.row[i])), half);
    }
    grow(result, box_center - extent);
    grow(result, box_center + extent);
    return result;
}

std::vector<Affine> find_rest_joints(const SkeletonData& skeleton) {
    std::vector<Affine> joints;
    joints.reserve(skeleton.joints.size());
    for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
        const LocalPose& rest = skeleton.rest;
        const Affine local = affine_from(rest.translations[i], rest.rotations[i], rest.scales[i]);
        const std::int32_t parent = skeleton.parents[i];
        joints.push_back(parent < 0 ? local : joints[static_cast<std::size_t>(parent)] * local);
    }
    return joints;
}

Bounds posed_bounds(const MeshData& mesh, const SkinData& skin, std::span<const Affine> joints) {
    std::vector<Affine> palette;
    palette.reserve(skin.joints.size());
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        palette.push_back(joints[skin.joints[i]] * skin.joint_from_mesh[i]);
    }
    Bounds bounds;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const std::uint32_t first = mesh.skin.empty() ? 0 : mesh.skin.first[v];
        const std::uint32_t end = mesh.skin.empty() ? 0 : mesh.skin.first[v + 1];
        Vec3 position = first == end ? mesh.positions[v] : Vec3(0);
        for (std::uint32_t i = first; i < end; ++i) {
            position += mesh.skin.weights[i]
                        * transform_point(palette[mesh.skin.joints[i]], mesh.positions[v]);
        }
        grow(bounds, position);
    }
    return bounds;
}

Bounds find_bounds(const GltfScene& scene) {
    const std::vector<Affine> matrices = find_node_matrices(scene);
    const std::vector<Affine> joints = find_rest_joints(scene.skeleton);
    Bounds bounds;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const std::int32_t skin = scene.nodes[i].skin;
        for (const GltfPart& part : scene.nodes[i].parts) {
            const MeshData& mesh = scene.meshes[part.mesh];
            const Bounds rest =
                skin < 0 ? mesh.bounds
                         : posed_bounds(mesh, scene.skins[static_cast<std::size_t>(skin)], joints);
            const Bounds box = transform_bounds(matrices[i], rest);
            if (!is_empty(box)) {
                grow(bounds, box);
            }
        }
    }
    return bounds;
}

namespace {

/// Corners of a box about the origin, also of the box while it turns.
std::vector<Vec3> framed_corners(const Vec3& half, bool turns) {
    constexpr int kTurns = 64;
    std::vector<Vec3> corners;
    for (int turn = 0; turn < (turns ? kTurns : 1); ++turn) {
        const float angle = 2 * kPi * static_cast<float>(turn) / kTurns;
        const float cosine = std::cos(angle);
        const float sine = std::sin(angle);
        for (int c = 0; c < 8; ++c) {
            const Vec3 p = half * Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1);
            corners.emplace_back(cosine * p.x + sine * p.z, p.y, cosine * p.z - sine * p.x);
        }
    }
    return corners;
}

}  // namespace

Framing frame_bounds(const Bounds& bounds, float fov_y, float aspect, bool turns) {
    const Bounds box = is_empty(bounds) ? Bounds{Vec3(-0.5f), Vec3(0.5f)} : bounds;
    const Vec3 to_camera = glm::normalize(Vec3(0.45f, 0.3f, 1.0f));  // by eye
    const Vec3 right = glm::normalize(glm::cross(Vec3(0, 1, 0), to_camera));
    const Vec3 up = glm::cross(to_camera, right);

    // The smallest distance at which all corners of the box are within the frame, with a margin.
    constexpr float kMargin = 1.08f;
    const float tan_y = std::tan(0.5f * fov_y) / kMargin;
    const float tan_x = tan_y * aspect;
    const Vec3 extent = half_extent(box);
    const float size = std::max({extent.x, extent.y, extent.z});
    const Vec3 half = glm::max(extent, Vec3(size > 0 ? 1e-6f * size : 1e-6f));
    const std::vector<Vec3> corners = framed_corners(half, turns);
    float distance = 0;
    for (const Vec3& p : corners) {
        const float toward = glm::dot(p, to_camera);
        distance = std::max(
            {distance, toward + std::abs(glm::dot(p, right)) / tan_x,
             toward + std::abs(glm::dot(p, up)) / tan_y});
    }
    Framing framing;
    for (const Vec3& p : corners) {
        const float depth = distance - glm::dot(p, to_camera);
        framing.aspect = std::max(framing.aspect, std::abs(glm::dot(p, right)) / (depth * tan_y));
    }
    framing.camera.position = center(box) + distance * to_camera;
    framing.camera.rotation = glm::quat_cast(Mat3(right, up, to_camera));
    return framing;
}

}  // namespace limn
