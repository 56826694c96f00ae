#include "content/make/models/body_part.h"

#include "content/bake/tangents.h"
#include "content/make/models/implicit_mesh.h"
#include "content/make/models/implicit_model.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

// Techniques: wrinkle.furrow.presets

namespace limn {

namespace {

using Parts = std::vector<ModelPart>;

ModelPart cone(const Vec3& a, const Vec3& b, float radius_a, float radius_b, float blend = 0.5f) {
    return {.blend = blend, .a = a, .b = b, .radius_a = radius_a, .radius_b = radius_b};
}

ModelPart ball(const Vec3& center, const Vec3& radii, float blend = 0.5f) {
    return {.shape = PartShape::Ellipsoid, .blend = blend, .a = center, .b = radii};
}

/// What is before `z`, or above `y`, alone.
ModelPart before(float z, float blend) {
    return {.shape = PartShape::Before, .use = PartUse::Clip, .blend = blend, .a = {0, 0, z}};
}
ModelPart cut_before(float z, float blend) {
    return {.shape = PartShape::Before, .use = PartUse::Cut, .blend = blend, .a = {0, 0, z}};
}
ModelPart above(float y) {
    return {.shape = PartShape::Above, .use = PartUse::Clip, .blend = 0.1f, .a = {0, y, 0}};
}
ModelPart cut_above(float y) {
    return {.shape = PartShape::Above, .use = PartUse::Cut, .blend = 0.1f, .a = {0, y, 0}};
}

/// A chain of phalanges with thicker joints and a nail, from its knuckle [cm].
struct Digit {
    Vec3 root;
    Vec3 direction;  ///< unit
    Vec3 back;       ///< where its nail faces, unit
    float length;
    float radius;  ///< at its root
    float bend;    ///< of each joint to the other side [rad]
};

void append_digit(Parts& parts, const Digit& digit) {
    constexpr std::array<float, 3> kShares = {0.45f, 0.3f, 0.25f};  // of the length
    constexpr std::array<float, 4> kRadii = {1, 0.93f, 0.85f, 0.72f};
    Vec3 at = digit.root;
    Vec3 along = digit.direction;
    Vec3 up = digit.back;
    for (std::size_t k = 0; k < kShares.size(); ++k) {
        const Vec3 next = at + kShares[k] * digit.length * along;
        const float radius = digit.radius * kRadii[k + 1];
        parts.push_back(cone(at, next, digit.radius * kRadii[k], radius, 0.15f));
        if (k < 2) {  // skin over the joint, looser on its back
            parts.push_back(ball(next + 0.08f * radius * up, Vec3(1.03f * radius), 0.5f));
            const float c = std::cos(digit.bend);
            const float s = std::sin(digit.bend);
            std::tie(along, up) = std::pair(c * along - s * up, c * up + s * along);
        } else {
            const Vec3 root = next - 0.5f * radius * along + 0.62f * radius * up;
            parts.push_back(cone(
                root, root + 1.1f * radius * along - 0.12f * radius * up, 0.42f * radius,
                0.38f * radius, 0.06f));
        }
        at = next;
    }
}

std::vector<Parts> hand_parts() {
    const std::array<Digit, 4> fingers = {{
        {{2.9f, 9.6f, 0.1f}, glm::normalize(Vec3(0.13f, 1, 0)), {0, 0, 1}, 7.2f, 0.98f, 0.14f},
        {{0.95f, 10.2f, 0.25f}, glm::normalize(Vec3(0.02f, 1, 0)), {0, 0, 1}, 8.1f, 1.0f, 0.14f},
        {{-0.95f, 9.8f, 0.15f}, glm::normalize(Vec3(-0.09f, 1, 0)), {0, 0, 1}, 7.5f, 0.95f, 0.16f},
        {{-2.7f, 8.7f, -0.1f}, glm::normalize(Vec3(-0.24f, 1, 0)), {0, 0, 1}, 5.9f, 0.84f, 0.18f},
    }};
    std::vector<Parts> groups = {{}};
    Parts palm;
    palm.push_back(
        {.shape = PartShape::Squashed,
         .a = {0, -4, 0},
         .b = {0, 1, 0},
         .radius_a = 3.0f,
         .radius_b = 2.8f,
         .squash = {1, 1, 0.68f}});
    for (const Digit& finger : fingers) {
        const Vec3 wrist = {0.62f * finger.root.x, 1.2f, 0};
        palm.push_back(cone(wrist, finger.root - 0.5f * finger.direction, 1.45f, 1.12f, 1.2f));
        palm.push_back(ball(finger.root + Vec3(0, 0, 0.32f), Vec3(0.86f, 1.0f, 0.85f), 0.6f));
        const Vec3 tendon = finger.root + Vec3(0, 0, 0.86f);  // under the skin of the back
        palm.push_back(cone({0.45f * finger.root.x, 1.6f, 1.2f}, tendon, 0.18f, 0.26f, 0.5f));
    }
    palm.push_back(ball({-2.5f, 3.6f, -0.7f}, {1.3f, 2.9f, 1.3f}, 1));  // ball of the little finger
    palm.push_back(ball({2.5f, 3.4f, -0.9f}, {1.7f, 2.6f, 1.4f}, 1));   // ball of the thumb
    palm.push_back(ball({-1.9f, 0.0f, 1.15f}, {0.85f, 0.9f, 0.75f}, 1.6f));  // end of the ulna
    palm.push_back(cone({2.3f, 2.2f, -0.5f}, {4.4f, 5.0f, -0.8f}, 1.45f, 1.15f, 1));
    for (const Digit& finger : fingers) {
        append_digit(groups.emplace_back(), finger);
    }
    append_digit(
        groups.emplace_back(), {{4.3f, 4.8f, -0.8f},
                                glm::normalize(Vec3(0.5f, 1, 0.02f)),
                                glm::normalize(Vec3(0.75f, -0.4f, 0.6f)),
                                6.2f,
                                1.15f,
                                0.1f});
    palm.push_back(above(-3));
    groups[0] = std::move(palm);
    return groups;
}

std::vector<Parts> foot_parts() {
    std::vector<Parts> groups = {{}};
    Parts body;
    body.push_back(ball({0, 3.4f, 2.7f}, {3.1f, 3.5f, 3.2f}));
    body.push_back(cone({0, 4.4f, 5}, {0, 4.2f, 15}, 3.3f, 3.9f, 1.5f));
    body.push_back(cone({0.1f, 6.5f, 4.6f}, {0.9f, 15.5f, 2.4f}, 2.9f, 2.0f, 1.5f));
    body.push_back(cone({-1.2f, 5, 2.6f}, {-2.7f, 16, 1.4f}, 2.4f, 1.5f, 1.5f));
    body.push_back(cone({1.2f, 6, 3.2f}, {2.6f, 17.3f, 1.9f}, 2.4f, 1.75f, 1.5f));
    body.push_back(ball({-0.2f, 16.9f, 1.6f}, {4.5f, 2.5f, 1.5f}, 1));
    body.push_back(ball({3.2f, 4.9f, 7.4f}, {1.0f, 1.2f, 1.2f}, 1));  // ankles
    body.push_back(ball({-3.1f, 4.0f, 6.6f}, {1.0f, 1.2f, 1.3f}, 1));
    body.push_back(cone({0, 0.9f, 6}, {0, 1.6f, 14}, 0.7f, 0.9f, 2));  // Achilles' tendon
    struct Toe {
        Vec2 root;
        float length, radius, aside;
    };
    constexpr std::array<Toe, 5> kToes = {{
        {{2.75f, 18.0f}, 6.4f, 1.35f, -0.06f},
        {{0.85f, 18.5f}, 5.4f, 0.88f, -0.03f},
        {{-0.75f, 18.0f}, 4.9f, 0.82f, 0},
        {{-2.15f, 17.2f}, 4.3f, 0.78f, 0.03f},
        {{-3.45f, 16.1f}, 3.8f, 0.76f, 0.06f},
    }};
    for (const Toe& toe : kToes) {
        // Its tendon shows on the back of the foot.
        body.push_back(cone(
            {0.25f * toe.root.x, 8, 6.3f}, {toe.root.x, toe.root.y - 1, 2.4f}, 0.2f, 0.25f, 1));
        append_digit(
            groups.emplace_back(), {{toe.root, 1.6f},
                                    glm::normalize(Vec3(toe.aside, 1, 0.08f)),
                                    glm::normalize(Vec3(0, -0.08f, 1)),
                                    toe.length,
                                    toe.radius,
                                    0.1f});
    }
    body.push_back(before(0.1f, 0.8f));
    body.push_back(cut_before(11.5f, 0.2f));
    groups[0] = std::move(body);
    return groups;
}

std::vector<Parts> arm_parts() {
    Parts arm;
    arm.push_back(cone({0, -16, 0}, {0, -2, 0.2f}, 4.3f, 4.1f));
    arm.push_back(cone({0, -2, 0.2f}, {0, 16, 0}, 4.1f, 2.5f, 2));
    arm.push_back(cone({2.0f, -9, 0.8f}, {1.5f, 4, 0.6f}, 3.0f, 1.9f, 2.5f));     // brachioradialis
    arm.push_back(cone({-1.9f, -8, 0.4f}, {-1.1f, 5, 0.2f}, 3.0f, 1.9f, 2.5f));   // flexors
    arm.push_back(cone({-1.2f, -13, -1.9f}, {-1.7f, 14, -1.0f}, 2.0f, 1.6f, 2));  // along the ulna
    arm.push_back(cone({1.3f, 6, 0.1f}, {1.5f, 16, 0}, 1.8f, 2.1f, 2));  // along the radius
    arm.push_back(ball({-2.0f, 13.2f, -1.5f}, {1.0f, 1.2f, 1.0f}, 1));   // its head
    arm.push_back(
        cone({-0.3f, 2, 2.6f}, {-0.2f, 15, 1.9f}, 0.5f, 0.35f, 1));  // tendons of the palm
    arm.push_back(cone({0.6f, 3, 2.6f}, {0.6f, 15, 1.9f}, 0.5f, 0.35f, 1));
    arm.push_back(above(-12.5f));
    arm.push_back(cut_above(12.5f));
    return {std::move(arm)};
}

struct PartModel {
    std::vector<Parts> groups;
    Bounds box;        ///< [cm]
    float begin, end;  ///< along y [cm]
    bool unrolled;     ///< about the axis
};

PartModel part_model(BodyPartKind part) {
    switch (part) {
    case BodyPartKind::Foot:
        return {foot_parts(), {{-6, -1, -1}, {6, 27, 12.5f}}, 0, 24.5f, false};
    case BodyPartKind::Arm:
        return {arm_parts(), {{-7, -13.5f, -7}, {7, 13.5f, 7}}, -12.5f, 12.5f, true};
    default:
        return {hand_parts(), {{-6, -4, -4}, {10, 20, 3.5f}}, -3, 18.3f, false};
    }
}

}  // namespace

MeshData make_body_part(const BodyPartShape& shape) {
    const PartModel model = part_model(shape.part);
    const float height = model.end - model.begin;
    const float cell = height / static_cast<float>(shape.cells);
    constexpr float kWeb = 0.3f;  // skin between digits [cm]
    std::vector<ModelGroup> groups;
    for (const Parts& parts : model.groups) {
        groups.push_back({kWeb, parts});
    }
    const ImplicitMesh surface =
        mesh_surface([&](const Vec3& p) { return model_distance(groups, p); }, {model.box, cell});
    MeshData mesh;
    mesh.name = "body_part";
    const float scale = shape.length / height;
    const Vec3 middle = {0, 0.5f * (model.begin + model.end), 0};
    // Copies of a vertex: of the front and the back of a planar map, or at the ends of the
    // unrolled.
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> made;
    const auto vertex_at = [&](std::uint32_t v, int copy) {
        const auto [found, added] =
            made.try_emplace({v, copy}, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added) {
            const Vec3 p = surface.positions[v] - middle;
            const float turn = 0.5f + std::atan2(p.x, p.z) / (2 * kPi);  // 0 and 1 behind
            const float across = model.unrolled ? turn + static_cast<float>(copy)
                                                : 0.5f + (copy == 0 ? p.x : -p.x) / height;
            mesh.positions.push_back(scale * p);
            mesh.normals.push_back(surface.normals[v]);
            mesh.uvs.emplace_back(across, 0.5f - p.y / height);
        }
        return found->second;
    };
    for (std::size_t t = 0; t + 3 <= surface.indices.size(); t += 3) {
        const std::uint32_t* const v = &surface.indices[t];
        const auto at = [&](int k) { return surface.positions[v[k]]; };
        const bool back = glm::cross(at(1) - at(0), at(2) - at(0)).z < 0;
        const bool behind =
            at(0).z < 0 && at(1).z < 0 && at(2).z < 0 && std::max({at(0).x, at(1).x, at(2).x}) > 0;
        for (int k = 0; k < 3; ++k) {
            const int copy = model.unrolled ? (behind && at(k).x < 0 ? 1 : 0) : (back ? 1 : 0);
            mesh.indices.push_back(vertex_at(v[k], copy));
        }
    }
    generate_tangents(mesh);
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
