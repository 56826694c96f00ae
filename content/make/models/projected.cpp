#include "content/make/models/projected.h"

#include "content/bake/tangents.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>

namespace limn {
namespace {

/// Of the range, 0 if it has no length.
float fraction_of(float x, float low, float high) {
    return high > low ? std::clamp((x - low) / (high - low), 0.0f, 1.0f) : 0.0f;
}

/// Around +y, counter-clockwise from above, 0.5 toward +z: u runs to the right from outside.
float around_axis(const Vec3& d) {
    if (d.x == 0 && d.z == 0) {
        return 0.5f;
    }
    const float u = std::atan2(d.x, d.z) / (2 * kPi) + 0.5f;
    return u < 1.0f ? u : 0.0f;
}

Vec2 uv_on_box(const Bounds& box, const Vec3& p, const Vec3& facing) {
    const Vec3 a = glm::abs(facing);
    const float x = fraction_of(p.x, box.min.x, box.max.x);
    const float y = fraction_of(p.y, box.min.y, box.max.y);
    const float z = fraction_of(p.z, box.min.z, box.max.z);
    if (a.y >= a.x && a.y >= a.z) {
        return {x, facing.y < 0 ? 1 - z : z};
    }
    if (a.x >= a.z) {
        return {facing.x < 0 ? z : 1 - z, 1 - y};
    }
    return {facing.z < 0 ? 1 - x : x, 1 - y};
}

bool is_around(Wrapping wrapping) {
    return wrapping == Wrapping::Cylinder || wrapping == Wrapping::Sphere;
}

bool on_axis(const Vec3& d) {
    return d.x == 0 && d.z == 0;
}

}  // namespace

Vec2 wrapped_uv(
    Wrapping wrapping, WrapDirection direction, const Bounds& box, const Vec3& position,
    const Vec3& normal, const Vec3& facing) {
    const Vec3 d =
        direction == WrapDirection::Normal ? normal : position - 0.5f * (box.min + box.max);
    switch (wrapping) {
    case Wrapping::Plane:
        return {
            fraction_of(position.x, box.min.x, box.max.x),
            fraction_of(position.z, box.min.z, box.max.z)};
    case Wrapping::Box:
        return uv_on_box(box, position, facing);
    case Wrapping::Cylinder:
        return {around_axis(d), 1 - fraction_of(position.y, box.min.y, box.max.y)};
    case Wrapping::Sphere:
        break;
    }
    const float length = glm::length(d);
    const float cosine = length > 0 ? std::clamp(d.y / length, -1.0f, 1.0f) : 0.0f;
    return {around_axis(d), std::acos(cosine) / kPi};
}

MeshData make_projected(const ProjectedShape& shape, const Assets& assets) {
    MeshData mesh;
    if (shape.mesh.index >= assets.meshes.size()) {
        return mesh;
    }
    const MeshData& source = assets.meshes[shape.mesh.index];
    const Vec3 middle = 0.5f * (source.bounds.min + source.bounds.max);
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> made;
    for (std::size_t i = 0; i + 2 < source.indices.size(); i += 3) {
        std::array<std::uint32_t, 3> corners = {
            source.indices[i], source.indices[i + 1], source.indices[i + 2]};
        const Vec3& p0 = source.positions[corners[0]];
        const Vec3 facing =
            glm::cross(source.positions[corners[1]] - p0, source.positions[corners[2]] - p0);
        std::array<Vec2, 3> uvs;
        for (std::size_t k = 0; k < 3; ++k) {
            uvs[k] = wrapped_uv(
                shape.wrapping, shape.direction, source.bounds, source.positions[corners[k]],
                source.normals[corners[k]], facing);
        }
        if (is_around(shape.wrapping)) {
            // Unwrapped across the seam; a pole has the mean u of the other corners.
            const float highest = std::max({uvs[0].x, uvs[1].x, uvs[2].x});
            for (Vec2& uv : uvs) {
                uv.x += highest - uv.x > 0.5f ? 1.0f : 0.0f;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 d = shape.direction == WrapDirection::Normal
                                   ? source.normals[corners[k]]
                                   : source.positions[corners[k]] - middle;
                if (on_axis(d)) {
                    uvs[k].x = 0.5f * (uvs[(k + 1) % 3].x + uvs[(k + 2) % 3].x);
                }
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = corners[k];
            const auto next = static_cast<std::uint32_t>(mesh.positions.size());
            const auto [at, is_new] = made.try_emplace({v, uvs[k].x, uvs[k].y}, next);
            if (is_new) {
                mesh.positions.push_back(source.positions[v]);
                mesh.normals.push_back(source.normals[v]);
                mesh.uvs.push_back(uvs[k]);
                if (v < source.colors.size()) {
                    mesh.colors.push_back(source.colors[v]);
                }
            }
            mesh.indices.push_back(at->second);
        }
    }
    generate_tangents(mesh);
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
