#include "systems/faces/skin_strain.h"

#include "ecs/base/check.h"
#include "ecs/components/weld.h"

#include <algorithm>
#include <cstddef>

// Techniques: face.strain

namespace limn {

namespace {

/// The axis u for a unit normal; any tangent where the normal is vertical.
Vec3 tangent_of(const Vec3& normal) {
    const Vec3 u = glm::cross(Vec3{0, 1, 0}, normal);
    return glm::dot(u, u) > 1e-8f ? glm::normalize(u) : any_perpendicular(normal);
}

void append_triangle(
    SkinTriangles& skin, std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::uint32_t source, float min_edge) {
    for (const std::uint32_t corner : corners) {
        if (corner >= positions.size()) {
            return;
        }
    }
    const Vec3 e1 = positions[corners[1]] - positions[corners[0]];
    const Vec3 e2 = positions[corners[2]] - positions[corners[0]];
    const Vec3 normal = glm::cross(e1, e2);
    const float twice_area = glm::length(normal);
    const float shortest = std::min({glm::length(e1), glm::length(e2), glm::length(e2 - e1)});
    if (!(shortest >= min_edge) || !(twice_area > 0) || !std::isfinite(twice_area)) {
        return;
    }
    const Vec3 n = normal / twice_area;
    const Vec3 u = tangent_of(n);
    const Vec3 v = glm::cross(n, u);
    const float a = glm::dot(u, e1);
    const float b = glm::dot(u, e2);
    const float c = glm::dot(v, e1);
    const float d = glm::dot(v, e2);
    const float determinant = a * d - b * c;
    if (!(determinant > 0)) {
        return;
    }
    skin.corners.insert(skin.corners.end(), corners.begin(), corners.end());
    skin.source.push_back(source);
    skin.rest_inverse.push_back(Vec4{d, -b, -c, a} / determinant);
    skin.area.push_back(0.5f * twice_area);
    skin.u.push_back(u);
    skin.v.push_back(v);
}

}  // namespace

SkinTriangles make_skin_triangles(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, float min_edge) {
    SkinTriangles skin;
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        append_triangle(
            skin, positions, indices.subspan(i, 3), static_cast<std::uint32_t>(i / 3), min_edge);
    }

    skin.welded = weld_positions(positions);
    std::vector<Vec3> normals(positions.size(), Vec3{0, 0, 0});
    for (std::size_t i = 0; i < skin.corners.size(); ++i) {
        const std::size_t t = i / 3;
        normals[skin.welded[skin.corners[i]]] += skin.area[t] * glm::cross(skin.u[t], skin.v[t]);
    }
    skin.vertex_u.resize(positions.size());
    skin.vertex_v.resize(positions.size());
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) {
        const Vec3 normal = normalize_or(normals[skin.welded[vertex]], {0, 0, 1});
        skin.vertex_u[vertex] = tangent_of(normal);
        skin.vertex_v[vertex] = glm::cross(normal, skin.vertex_u[vertex]);
    }
    return skin;
}

void find_strain(
    const SkinTriangles& skin, std::span<const Vec3> deformed, std::span<SkinStrain> strain) {
    LIMN_CHECK(deformed.size() == skin.welded.size());
    LIMN_CHECK(strain.size() == skin.area.size());
    for (std::size_t t = 0; t < strain.size(); ++t) {
        const Vec3& origin = deformed[skin.corners[3 * t]];
        const Vec3 e1 = deformed[skin.corners[3 * t + 1]] - origin;
        const Vec3 e2 = deformed[skin.corners[3 * t + 2]] - origin;
        const float g11 = glm::dot(e1, e1);
        const float g12 = glm::dot(e1, e2);
        const float g22 = glm::dot(e2, e2);

        // C = Dm^-T G Dm^-1, G the dot products of the deformed edges.
        const Vec4& m = skin.rest_inverse[t];
        const float cuu = m.x * m.x * g11 + 2.0f * m.x * m.z * g12 + m.z * m.z * g22;
        const float cvv = m.y * m.y * g11 + 2.0f * m.y * m.w * g12 + m.w * m.w * g22;
        const float cuv = m.x * m.y * g11 + (m.x * m.w + m.y * m.z) * g12 + m.z * m.w * g22;

        // sqrt(C) = (C + r I) / sqrt(trace C + 2 r) with r = sqrt(det C), by Cayley-Hamilton.
        const float root = std::sqrt(std::max(cuu * cvv - cuv * cuv, 0.0f));
        const float sum = std::sqrt(std::max(cuu + cvv + 2.0f * root, 1e-20f));
        const SkinStrain found = {
            .uu = (cuu + root) / sum - 1.0f, .vv = (cvv + root) / sum - 1.0f, .uv = cuv / sum};
        const bool finite =
            std::isfinite(found.uu) && std::isfinite(found.vv) && std::isfinite(found.uv);
        strain[t] = finite ? found : SkinStrain{};
    }
}

void average_strain(
    const SkinTriangles& skin, std::span<const SkinStrain> strain, std::span<SkinStrain> vertices) {
    LIMN_CHECK(strain.size() == skin.area.size());
    LIMN_CHECK(vertices.size() == skin.welded.size());
    std::ranges::fill(vertices, SkinStrain{});
    std::vector<float> area(vertices.size(), 0.0f);
    for (std::size_t i = 0; i < skin.corners.size(); ++i) {
        const std::size_t t = i / 3;
        const std::uint32_t vertex = skin.welded[skin.corners[i]];
        // The tensor of the triangle in the axes of the vertex.
        const Vec3& u = skin.vertex_u[vertex];
        const Vec3& v = skin.vertex_v[vertex];
        const Vec2 tu = {glm::dot(u, skin.u[t]), glm::dot(u, skin.v[t])};
        const Vec2 tv = {glm::dot(v, skin.u[t]), glm::dot(v, skin.v[t])};
        const SkinStrain& s = strain[t];
        const Vec2 su = {s.uu * tu.x + s.uv * tu.y, s.uv * tu.x + s.vv * tu.y};
        const Vec2 sv = {s.uu * tv.x + s.uv * tv.y, s.uv * tv.x + s.vv * tv.y};
        vertices[vertex].uu += skin.area[t] * glm::dot(tu, su);
        vertices[vertex].vv += skin.area[t] * glm::dot(tv, sv);
        vertices[vertex].uv += skin.area[t] * glm::dot(tu, sv);
        area[vertex] += skin.area[t];
    }
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        const std::uint32_t first = skin.welded[vertex];  // <= vertex: done already
        if (first != vertex) {
            vertices[vertex] = vertices[first];
        } else if (area[vertex] > 0) {
            SkinStrain& s = vertices[vertex];
            s = {.uu = s.uu / area[vertex], .vv = s.vv / area[vertex], .uv = s.uv / area[vertex]};
        }
    }
}

PrincipalStrain principal_strain(const SkinStrain& strain) {
    const float mean = 0.5f * (strain.uu + strain.vv);
    const float half = 0.5f * (strain.uu - strain.vv);
    const float radius = std::sqrt(half * half + strain.uv * strain.uv);
    return {
        .lower = mean - radius,
        .higher = mean + radius,
        .angle = 0.5f * std::atan2(-strain.uv, -half)};
}

}  // namespace limn
