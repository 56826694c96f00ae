#include "content/make/models/hovercraft.h"

#include "content/bake/tangents.h"
#include "content/make/models/implicit_mesh.h"
#include "content/make/models/shapes.h"
#include "content/make/models/simplify_mesh.h"
#include "content/models/hovercraft_model.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

float craft(const Vec3& point) {
    // Blends and skewed axes make the gradient larger than 1; the mesher must not skip a surface.
    return 0.55f * model_distance(hovercraft::kGroups, {std::abs(point.x), point.y, point.z});
}

/// White where the material's color shows.
Vec4 paint(const Vec3& point) {
    const Vec3 p = {std::abs(point.x), point.y, point.z};
    if (part_distance(hovercraft::kIntake, p) < 0.03f
        || part_distance(hovercraft::kNozzle, p) < 0.03f || p.y < -0.13f) {
        return hovercraft::kDark;
    }
    // the edges of the fins and of the front wings
    const float tip = std::max(
        glm::smoothstep(0.66f, 0.74f, p.y),
        glm::smoothstep(0.84f, 0.92f, p.x) * glm::smoothstep(0.55f, 0.65f, p.z));
    return glm::mix(hovercraft::kPaint, hovercraft::kTips, tip);
}

/// A separate surface, so that its edge is sharp: an ellipsoid half sunk into the hull.
void add_canopy(MeshData& mesh) {
    const MeshData ball = make_sphere({.radius = 1, .segments = 32, .rings = 16});
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        mesh.positions.push_back(
            hovercraft::kCanopyMiddle + hovercraft::kCanopyRadii * ball.positions[i]);
        mesh.normals.push_back(glm::normalize(ball.normals[i] / hovercraft::kCanopyRadii));
        mesh.colors.push_back(hovercraft::kCanopy);
        mesh.uvs.push_back(ball.uvs[i]);
    }
    for (const std::uint32_t index : ball.indices) {
        mesh.indices.push_back(first + index);
    }
}

}  // namespace

MeshData make_hovercraft(const HovercraftShape& shape) {
    const float cell = shape.detail;
    const float half = std::ceil(1.5f / cell) * cell;  // a symmetric grid
    ImplicitMesh surface = mesh_surface(craft, {{{-half, -0.4f, -2.5f}, {half, 1.1f, 2.6f}}, cell});
    MeshData mesh;
    mesh.positions = std::move(surface.positions);
    mesh.normals = std::move(surface.normals);
    mesh.indices = std::move(surface.indices);
    for (const Vec3& p : mesh.positions) {
        mesh.colors.push_back(paint(p));
        mesh.uvs.emplace_back(0.5f + p.x / hovercraft::kLength, 0.5f - p.z / hovercraft::kLength);
    }
    if (shape.triangles > 0) {
        simplify_mesh(mesh, static_cast<std::size_t>(shape.triangles));
    }
    add_canopy(mesh);
    for (Vec3& p : mesh.positions) {
        p *= shape.length / hovercraft::kLength;
        grow(mesh.bounds, p);
    }
    generate_tangents(mesh);
    return mesh;
}

}  // namespace limn
