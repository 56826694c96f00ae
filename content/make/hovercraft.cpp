#include "content/make/hovercraft.h"

#include "content/bake/tangents.h"
#include "content/make/implicit_mesh.h"
#include "content/make/shapes.h"
#include "content/make/simplify_mesh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

// All lengths are those of a craft of 5 m, its left side (+x) alone: it is its own mirror image.

constexpr float kLength = 5.0f;

float smooth_union(float a, float b, float width) {
    const float h = std::max(width - std::abs(a - b), 0.0f) / width;
    return std::min(a, b) - h * h * width * 0.25f;
}
float smooth_cut(float a, float b, float width) {
    return -smooth_union(-a, b, width);
}

/// Somewhat less than the distance to an ellipsoid (I. Quilez).
float ellipsoid(const Vec3& p, const Vec3& middle, const Vec3& radii) {
    const Vec3 q = p - middle;
    const float k0 = glm::length(q / radii);
    const float k1 = glm::length(q / (radii * radii));
    const float least = std::min({radii.x, radii.y, radii.z});
    return k1 > 0.0f ? k0 * (k0 - 1.0f) / k1 : -least;
}

float rounded_box(const Vec3& p, const Vec3& middle, const Vec3& half, float radius) {
    const Vec3 q = glm::abs(p - middle) - half + radius;
    return glm::length(glm::max(q, Vec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0f) - radius;
}

/// A cone with rounded ends about the line from `a` to `b`.
float rounded_cone(const Vec3& p, const Vec3& a, const Vec3& b, float radius_a, float radius_b) {
    const Vec3 way = b - a;
    const float along = std::clamp(glm::dot(p - a, way) / glm::dot(way, way), 0.0f, 1.0f);
    return glm::length(p - (a + along * way)) - glm::mix(radius_a, radius_b, along);
}

/// A plate that leans and sweeps back: its outline in (height, length), its thickness across.
float fin(const Vec3& p) {
    const Vec3 foot = {0.86f, 0.28f, -1.7f};
    const Vec3 q = p - foot;
    const float height = q.y * 0.94f + q.x * 0.34f;  // leans outwards
    const float across = q.x * 0.94f - q.y * 0.34f;
    const float along = q.z + 0.75f * height;  // swept back
    const float outline = std::max(
        std::max(-height - 0.2f, height - 0.62f),
        std::abs(along) - glm::mix(0.5f, 0.2f, std::clamp(height / 0.62f, 0.0f, 1.0f)));
    const Vec2 edge = {outline + 0.05f, std::abs(across) - 0.02f};
    return glm::length(glm::max(edge, Vec2(0))) + std::min(std::max(edge.x, edge.y), 0.0f) - 0.035f;
}

float hull(const Vec3& p) {
    // A wedge: flat below, round above, from the needle of a nose to a broad tail.
    const float nose = rounded_cone(p, {0, 0.0f, 2.38f}, {0, 0.06f, -0.4f}, 0.09f, 0.42f);
    float d = ellipsoid(p, {0, 0.05f, -0.5f}, {0.66f, 0.27f, 1.8f});
    d = smooth_union(d, nose, 0.3f);
    // front wings
    const float wing_x = std::clamp((p.x - 0.1f) / 0.95f, 0.0f, 1.0f);
    d = smooth_union(
        d,
        rounded_box(
            p + Vec3(0, 0.04f + 0.06f * wing_x, 0.55f * wing_x - 1.3f), {0.45f, 0, 0},
            {0.6f, 0.045f, glm::mix(0.42f, 0.16f, wing_x)}, 0.04f),
        0.16f);
    // flat bottom
    return smooth_cut(d, p.y + 0.2f, 0.12f);
}

float intake(const Vec3& p) {
    return rounded_box(p, {0.86f, 0.06f, 0.5f}, {0.21f, 0.16f, 0.45f}, 0.1f);
}

float nozzle(const Vec3& p) {
    return rounded_cone(p, {0.86f, 0.05f, -2.1f}, {0.86f, 0.05f, -2.9f}, 0.17f, 0.25f);
}

float engine(const Vec3& p) {
    float d = rounded_box(p, {0.86f, 0.05f, -0.55f}, {0.36f, 0.3f, 1.0f}, 0.15f);
    d = smooth_union(
        d, rounded_cone(p, {0.86f, 0.05f, -1.2f}, {0.86f, 0.05f, -2.2f}, 0.33f, 0.29f), 0.2f);
    d = std::max(d, -2.32f - p.z);  // cut off flat
    d = smooth_cut(d, intake(p), 0.14f);
    return smooth_cut(d, nozzle(p), 0.03f);
}

float craft(const Vec3& point) {
    const Vec3 p = {std::abs(point.x), point.y, point.z};
    float d = hull(p);
    // struts to the engines
    d = smooth_union(d, rounded_box(p, {0.5f, 0.02f, -0.75f}, {0.35f, 0.06f, 0.75f}, 0.05f), 0.18f);
    d = smooth_union(d, engine(p), 0.06f);
    d = smooth_union(d, fin(p), 0.06f);
    // Blends and bent axes make it steeper than a distance; the mesher must not skip a surface.
    return 0.55f * d;
}

/// White where the material's color shows.
Vec4 paint(const Vec3& point) {
    const Vec3 p = {std::abs(point.x), point.y, point.z};
    const Vec4 dark = {0.015f, 0.017f, 0.02f, 1};
    if (intake(p) < 0.03f || nozzle(p) < 0.03f || p.y < -0.13f) {
        return dark;
    }
    // the edges of the fins and of the front wings
    const float tip = std::max(
        glm::smoothstep(0.66f, 0.74f, p.y),
        glm::smoothstep(0.84f, 0.92f, p.x) * glm::smoothstep(0.55f, 0.65f, p.z));
    return glm::mix(Vec4(1), Vec4(0.06f, 0.065f, 0.07f, 1), tip);
}

/// A surface of its own, so that its edge is sharp: an ellipsoid, half sunk into the hull.
void add_canopy(MeshData& mesh) {
    constexpr Vec3 kMiddle = {0, 0.25f, 0.05f};
    constexpr Vec3 kRadii = {0.26f, 0.24f, 0.85f};
    const MeshData ball = make_sphere({.radius = 1, .segments = 32, .rings = 16});
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        mesh.positions.push_back(kMiddle + kRadii * ball.positions[i]);
        mesh.normals.push_back(glm::normalize(ball.normals[i] / kRadii));
        mesh.colors.emplace_back(0.008f, 0.010f, 0.016f, 1.0f);
        mesh.uvs.push_back(ball.uvs[i]);
    }
    for (const std::uint32_t index : ball.indices) {
        mesh.indices.push_back(first + index);
    }
}

}  // namespace

MeshData make_hovercraft(const HovercraftShape& shape) {
    const float cell = shape.detail;
    const float half = std::ceil(1.5f / cell) * cell;  // the same grid on both sides
    ImplicitMesh surface = mesh_surface(craft, {{{-half, -0.4f, -2.5f}, {half, 1.1f, 2.6f}}, cell});
    MeshData mesh;
    mesh.positions = std::move(surface.positions);
    mesh.normals = std::move(surface.normals);
    mesh.indices = std::move(surface.indices);
    for (const Vec3& p : mesh.positions) {
        mesh.colors.push_back(paint(p));
        mesh.uvs.emplace_back(0.5f + p.x / kLength, 0.5f - p.z / kLength);
    }
    if (shape.triangles > 0) {
        simplify_mesh(mesh, static_cast<std::size_t>(shape.triangles));
    }
    add_canopy(mesh);
    for (Vec3& p : mesh.positions) {
        p *= shape.length / kLength;
        grow(mesh.bounds, p);
    }
    generate_tangents(mesh);
    return mesh;
}

}  // namespace limn
