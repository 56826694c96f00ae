#include "content/bake/skin_texels.h"

#include "ecs/base/check.h"
#include "ecs/components/surface.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>

// Techniques: face.wrinkle-model

namespace limn {

namespace {

constexpr float kMinTexelArea = 1e-14f;  ///< square of twice the area of a triangle [m^4]

float cross_of(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}

void cover(const MeshData& mesh, int triangle, int size, std::vector<SkinTexel>& texels) {
    Vec2 p[3];
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.indices[static_cast<std::size_t>(3 * triangle + k)];
        p[k] = mesh.uvs[v] * static_cast<float>(size);
    }
    const float area = cross_of(p[1] - p[0], p[2] - p[0]);
    const Vec2 low = glm::min(p[0], glm::min(p[1], p[2]));
    const Vec2 high = glm::max(p[0], glm::max(p[1], p[2]));
    if (!(std::abs(area) > 1e-12f) || !std::isfinite(low.x + low.y + high.x + high.y)) {
        return;
    }
    const auto first = [size](float x) {
        return static_cast<int>(std::clamp(std::ceil(x - 0.5f), 0.0f, static_cast<float>(size)));
    };
    const auto end = [size](float x) {
        return static_cast<int>(
            std::clamp(std::floor(x - 0.5f) + 1, 0.0f, static_cast<float>(size)));
    };
    for (int y = first(low.y); y < end(high.y); ++y) {
        for (int x = first(low.x); x < end(high.x); ++x) {
            const Vec2 at = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
            const Vec3 weights = {
                cross_of(p[1] - at, p[2] - at) / area, cross_of(p[2] - at, p[0] - at) / area,
                cross_of(p[0] - at, p[1] - at) / area};
            SkinTexel& texel = texels[static_cast<std::size_t>(y * size + x)];
            if (texel.triangle < 0 && std::min({weights.x, weights.y, weights.z}) >= 0) {
                texel = {triangle, weights};
            }
        }
    }
}

/// Adds a ring of texels around those that are covered.
void grow_texels(int size, std::vector<SkinTexel>& texels) {
    const std::vector<SkinTexel> old = texels;
    constexpr int kNear[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            SkinTexel& texel = texels[static_cast<std::size_t>(y * size + x)];
            for (const auto& offset : kNear) {
                const int nx = x + offset[0];
                const int ny = y + offset[1];
                if (texel.triangle < 0 && nx >= 0 && ny >= 0 && nx < size && ny < size) {
                    texel = old[static_cast<std::size_t>(ny * size + nx)];
                }
            }
        }
    }
}

/// Per vertex the number of its position: vertices that a seam duplicates count as one.
std::vector<std::uint32_t> number_positions(std::span<const Vec3> positions) {
    std::map<std::tuple<float, float, float>, std::uint32_t> numbers;
    std::vector<std::uint32_t> number(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3& p = positions[v];
        const auto next = static_cast<std::uint32_t>(numbers.size());
        number[v] = is_finite(p) ? numbers.try_emplace({p.x, p.y, p.z}, next).first->second : 0;
    }
    return number;
}

/// The rotation from unit `from` to unit `to`.
glm::mat3 turn_between(const Vec3& from, const Vec3& to) {
    const float c = glm::dot(from, to);
    const Vec3 v = glm::cross(from, to);
    if (c < -0.999f) {
        return glm::mat3(1);
    }
    const glm::mat3 k = {{0, v.z, -v.y}, {-v.z, 0, v.x}, {v.y, -v.x, 0}};
    return glm::mat3(1) + k + k * k * (1 / (1 + c));
}

/// C = F^T F of a triangle as a tensor in its plane.
glm::mat3
cauchy_green(const Vec3 (&rest)[3], const Vec3 (&now)[3], const Vec3& normal, float area2) {
    const Vec3 e[2] = {rest[1] - rest[0], rest[2] - rest[0]};
    const Vec3 f[2] = {now[1] - now[0], now[2] - now[0]};
    const Vec3 dual[2] = {
        glm::cross(e[1], normal) / area2, glm::cross(normal, e[0]) / area2};  // e[i] . dual[j] = ij
    glm::mat3 c(0);
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            c += glm::dot(f[i], f[j]) * glm::outerProduct(dual[i], dual[j]);
        }
    }
    return c;
}

/// sqrt(C) - I in the axes t and b.
Vec3 strain_of(const glm::mat3& c, const Vec3& t, const Vec3& b) {
    const float tt = glm::dot(t, c * t);
    const float bb = glm::dot(b, c * b);
    const float tb = glm::dot(t, c * b);
    const float root = std::sqrt(std::max(tt * bb - tb * tb, 0.0f));
    const float sum = std::sqrt(std::max(tt + bb + 2 * root, 1e-20f));
    return Vec3{tt + root, bb + root, tb} / sum - Vec3{1, 1, 0};
}

}  // namespace

std::vector<SkinTexel> find_skin_texels(const MeshData& mesh, int size, int gutter) {
    LIMN_CHECK(size > 0);
    std::vector<SkinTexel> texels(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    if (mesh.uvs.size() != mesh.positions.size()) {
        return texels;
    }
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        cover(mesh, static_cast<int>(t / 3), size, texels);
    }
    for (int ring = 0; ring < gutter; ++ring) {
        grow_texels(size, texels);
    }
    return texels;
}

std::vector<Vec3> find_tangent_strain(const MeshData& mesh, std::span<const Vec3> deformed) {
    LIMN_CHECK(deformed.size() == mesh.positions.size());
    LIMN_CHECK(mesh.tangents.size() == mesh.positions.size());
    const std::vector<std::uint32_t> number = number_positions(mesh.positions);
    std::vector<Vec3> normals(mesh.positions.size(), Vec3(0));  // by number, the rest unused
    for (std::size_t v = 0; v < number.size(); ++v) {
        normals[number[v]] += mesh.normals[v];
    }
    std::vector<glm::mat3> tensors(mesh.positions.size(), glm::mat3(0));
    std::vector<float> weights(mesh.positions.size(), 0.0f);
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        Vec3 rest[3];
        Vec3 now[3];
        for (std::size_t k = 0; k < 3; ++k) {
            rest[k] = mesh.positions[mesh.indices[t + k]];
            now[k] = deformed[mesh.indices[t + k]];
        }
        const Vec3 cross = glm::cross(rest[1] - rest[0], rest[2] - rest[0]);
        const float area2 = glm::length(cross);
        if (!(area2 * area2 > kMinTexelArea) || !is_finite(now[0] + now[1] + now[2])) {
            continue;
        }
        const Vec3 normal = cross / area2;
        const glm::mat3 c = cauchy_green(rest, now, normal, area2);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t at = number[mesh.indices[t + k]];
            const Vec3 a = rest[(k + 1) % 3] - rest[k];
            const Vec3 b = rest[(k + 2) % 3] - rest[k];
            const float angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            const glm::mat3 turn = turn_between(normal, normalize_or(normals[at], normal));
            tensors[at] += angle * (turn * c * glm::transpose(turn));
            weights[at] += angle;
        }
    }
    std::vector<Vec3> strain(mesh.positions.size(), Vec3(0));
    for (std::size_t v = 0; v < strain.size(); ++v) {
        const std::uint32_t at = number[v];
        if (weights[at] > 0) {
            const Vec3 n = normalize_or(normals[at], Vec3(0, 0, 1));
            const Vec3 tangent = mesh.tangents[v];
            const Vec3 t = normalize_or(tangent - n * glm::dot(n, tangent), any_perpendicular(n));
            const Vec3 b = glm::cross(n, t) * (mesh.tangents[v].w < 0 ? -1.0f : 1.0f);
            strain[v] = strain_of(tensors[at] / weights[at], t, b);
        }
    }
    return strain;
}

}  // namespace limn
