#include "bench/oracles/shadow_oracle.h"

#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

// Techniques: shadow.penumbra

namespace limn::oracle {
namespace {

constexpr std::uint32_t kLeafSize = 4;

DVec3 to_world(const Affine& a, const Vec3& p) {
    DVec3 moved;
    for (int i = 0; i < 3; ++i) {
        const Vec4& r = a.row[i];
        moved[i] = double(r.x) * p.x + double(r.y) * p.y + double(r.z) * p.z + double(r.w);
    }
    return moved;
}

/// Distance at which the ray enters the box, within begin .. end.
bool crosses(
    const DVec3& min, const DVec3& max, const DVec3& from, const DVec3& inverse, double begin,
    double end) {
    for (int i = 0; i < 3; ++i) {
        const double a = (min[i] - from[i]) * inverse[i];
        const double b = (max[i] - from[i]) * inverse[i];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin <= end;
}

}  // namespace

ShadowScene::ShadowScene(const World& world) {
    const auto& assets = world.resource<Assets>();
    std::vector<std::int32_t> mask_of(assets.materials.size(), -1);
    for (std::size_t i = 0; i < assets.materials.size(); ++i) {
        const Material& material = assets.materials[i];
        if (material.alpha_mode != AlphaMode::Mask) {
            continue;
        }
        mask_of[i] = static_cast<std::int32_t>(masks_.size());
        Mask mask = {1, 1, {material.base_color.w}, material.alpha_cutoff};
        const std::uint32_t index = material.base_color_texture.image.index;
        if (index < assets.images.size()) {
            const ImageData& image = assets.images[index];
            mask.width = image.width;
            mask.height = image.height;
            mask.opacity.clear();
            for (std::size_t p = 3; p < image.pixels.size(); p += 4) {
                mask.opacity.push_back(material.base_color.w * (image.pixels[p] / 255.0));
            }
        }
        masks_.push_back(std::move(mask));
    }
    world.query<const MeshInstance, const WorldTransform, Without<NoShadow>>().each(
        [&](const MeshInstance& instance, const WorldTransform& transform) {
            const std::uint32_t material = instance.material.index;
            const bool known = material < assets.materials.size();
            if (known && assets.materials[material].alpha_mode == AlphaMode::Blend) {
                return;
            }
            const MeshData& mesh = assets.meshes[instance.mesh.index];
            for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
                const std::uint32_t* corner = &mesh.indices[i];
                Triangle t;
                t.corner = to_world(transform.world, mesh.positions[corner[0]]);
                t.edge_u = to_world(transform.world, mesh.positions[corner[1]]) - t.corner;
                t.edge_v = to_world(transform.world, mesh.positions[corner[2]]) - t.corner;
                t.mask = known ? mask_of[material] : -1;
                for (int k = 0; k < 3 && !mesh.uvs.empty(); ++k) {
                    t.uv[k] = glm::dvec2(mesh.uvs[corner[k]]);
                }
                triangles_.push_back(t);
            }
        });
    if (!triangles_.empty()) {
        build(0, static_cast<std::uint32_t>(triangles_.size()));
    }
}

/// Splits at the median along the longest side.
void ShadowScene::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = nodes_.size();
    Node node = {DVec3(INFINITY), DVec3(-INFINITY), begin, end - begin};
    for (std::uint32_t i = begin; i < end; ++i) {
        const Triangle& t = triangles_[i];
        for (const DVec3& p : {t.corner, t.corner + t.edge_u, t.corner + t.edge_v}) {
            node.min = glm::min(node.min, p);
            node.max = glm::max(node.max, p);
        }
    }
    nodes_.push_back(node);
    if (node.count <= kLeafSize) {
        return;
    }
    const DVec3 size = node.max - node.min;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t median = (begin + end) / 2;
    const auto along = [axis](const Triangle& t) {
        return t.corner[axis] + (t.edge_u[axis] + t.edge_v[axis]) / 3;
    };
    std::nth_element(
        triangles_.begin() + begin, triangles_.begin() + median, triangles_.begin() + end,
        [&](const Triangle& a, const Triangle& b) { return along(a) < along(b); });
    build(begin, median);
    nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].count = 0;
    build(median, end);
}

bool ShadowScene::has_hole(const Triangle& triangle, double u, double v) const {
    if (triangle.mask < 0) {
        return false;
    }
    const Mask& mask = masks_[static_cast<std::size_t>(triangle.mask)];
    const glm::dvec2 uv = triangle.uv[0] * (1 - u - v) + triangle.uv[1] * u + triangle.uv[2] * v;
    // Bilinear between texel centers, repeating.
    const double x = uv.x * mask.width - 0.5;
    const double y = uv.y * mask.height - 0.5;
    const auto texel = [&](double column, double row) {
        const auto wrap = [](double i, int n) {
            return static_cast<int>(i - n * std::floor(i / n));
        };
        return mask.opacity[static_cast<std::size_t>(
            wrap(row, mask.height) * mask.width + wrap(column, mask.width))];
    };
    const double x0 = std::floor(x);
    const double y0 = std::floor(y);
    const double top = std::lerp(texel(x0, y0), texel(x0 + 1, y0), x - x0);
    const double bottom = std::lerp(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), x - x0);
    return std::lerp(top, bottom, y - y0) < mask.cutoff;
}

/// Moeller and Trumbore 1997, both sides.
bool ShadowScene::hits(const DVec3& from, const DVec3& along, double begin, double end) const {
    if (nodes_.empty()) {
        return false;
    }
    const DVec3 inverse = 1.0 / along;
    std::array<std::uint32_t, 64> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
        const std::uint32_t index = stack[--size];
        const Node& node = nodes_[index];
        if (!crosses(node.min, node.max, from, inverse, begin, end)) {
            continue;
        }
        if (node.count == 0) {
            stack[size++] = node.first;
            stack[size++] = index + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = triangles_[i];
            const DVec3 p = glm::cross(along, t.edge_v);
            const double determinant = glm::dot(t.edge_u, p);
            if (determinant == 0) {
                continue;
            }
            const DVec3 s = from - t.corner;
            const DVec3 q = glm::cross(s, t.edge_u);
            const double u = glm::dot(s, p) / determinant;
            const double v = glm::dot(along, q) / determinant;
            const double at = glm::dot(t.edge_v, q) / determinant;
            if (u >= 0 && v >= 0 && u + v <= 1 && at > begin && at < end && !has_hole(t, u, v)) {
                return true;
            }
        }
    }
    return false;
}

bool ShadowScene::blocked(const DVec3& from, const DVec3& to, double skin) const {
    const double length = glm::distance(from, to);
    return length > 2 * skin && hits(from, (to - from) / length, skin, length - skin);
}

bool ShadowScene::blocked_toward(const DVec3& from, const DVec3& to_light) const {
    return hits(from, to_light, 1e-4, 1e9);
}

double ShadowScene::visible_fraction(
    const DVec3& from, const DVec3& center, double diameter, int side) const {
    const DVec3 axis = glm::normalize(from - center);
    const DVec3 other = std::abs(axis.y) < 0.9 ? DVec3(0, 1, 0) : DVec3(1, 0, 0);
    const DVec3 right = glm::normalize(glm::cross(other, axis));
    const DVec3 up = glm::cross(axis, right);
    int visible = 0;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            // Rings of equal area.
            const double radius = 0.5 * diameter * std::sqrt((i + 0.5) / side);
            const double angle = 2 * std::numbers::pi * (j + 0.5 * (i % 2)) / side;
            const DVec3 to = center + radius * (std::cos(angle) * right + std::sin(angle) * up);
            visible += blocked(from, to) ? 0 : 1;
        }
    }
    return static_cast<double>(visible) / (side * side);
}

double penumbra_width(double width, double blocker, double receiver) {
    return width * (receiver - blocker) / blocker;
}

}  // namespace limn::oracle
