#include "content/make/models/patch_mesh.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

// Techniques: anim.biquadratic-patch

namespace limn {
namespace {

/// The four points of the cubic that is this quadratic curve.
std::array<Vec3, 4> elevate_curve(const Vec3& a, const Vec3& b, const Vec3& c) {
    return {a, (a + 2.0f * b) / 3.0f, (2.0f * b + c) / 3.0f, c};
}

/// The other side of each triangle, with normals to match.
void add_back(MeshData& mesh) {
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const std::size_t indices = mesh.indices.size();
    for (std::uint32_t i = 0; i < count; ++i) {
        mesh.positions.push_back(mesh.positions[i]);
        mesh.normals.push_back(-mesh.normals[i]);
        mesh.tangents.push_back(mesh.tangents[i] * Vec4(1, 1, 1, -1));
        mesh.uvs.push_back(mesh.uvs[i]);
    }
    for (std::size_t i = 0; i < indices; i += 3) {
        for (const std::size_t corner : {i, i + 2, i + 1}) {
            mesh.indices.push_back(mesh.indices[corner] + count);
        }
    }
}

}  // namespace

Vec3 quadratic_weights(float t) {
    const float s = 1 - t;
    return {s * s, 2 * s * t, t * t};
}

Vec3 patch_point(const QuadraticPatch& patch, float u, float v) {
    const Vec3 a = quadratic_weights(u);
    const Vec3 b = quadratic_weights(v);
    Vec3 point(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& row = patch.q[i];
        point += a[static_cast<int>(i)] * (b.x * row[0] + b.y * row[1] + b.z * row[2]);
    }
    return point;
}

BezierPatch elevate_patch(const QuadraticPatch& patch) {
    std::array<std::array<Vec3, 4>, 3> rows;
    for (std::size_t i = 0; i < 3; ++i) {
        rows[i] = elevate_curve(patch.q[i][0], patch.q[i][1], patch.q[i][2]);
    }
    BezierPatch cubic;
    for (std::size_t j = 0; j < 4; ++j) {
        const std::array<Vec3, 4> column = elevate_curve(rows[0][j], rows[1][j], rows[2][j]);
        for (std::size_t i = 0; i < 4; ++i) {
            cubic.p[i][j] = column[i];
        }
    }
    return cubic;
}

std::vector<QuadraticPatch> list_patches(const PatchMeshShape& shape) {
    const auto width = static_cast<std::size_t>(std::max(shape.width, 1));
    const std::size_t rows = shape.points.size() / width;
    std::vector<QuadraticPatch> patches;
    for (std::size_t row = 0; row + 2 < rows; row += 2) {
        for (std::size_t column = 0; column + 2 < width; column += 2) {
            QuadraticPatch& patch = patches.emplace_back();
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) {
                    patch.q[i][j] = shape.points[(row + j) * width + column + i];
                }
            }
        }
    }
    return patches;
}

MeshData make_patch_grid(const PatchMeshShape& shape) {
    LIMN_CHECK(shape.divisions >= 1 && shape.tolerance >= 0);
    std::vector<BezierPatch> surfaces;
    for (const QuadraticPatch& patch : list_patches(shape)) {
        surfaces.push_back(elevate_patch(patch));
    }
    MeshData mesh = make_patch_mesh(
        surfaces, shape.tolerance > 0 ? tessellate_adaptive(surfaces, shape.tolerance)
                                      : tessellate_uniform(surfaces.size(), shape.divisions));
    if (shape.double_sided) {
        add_back(mesh);
    }
    return mesh;
}

}  // namespace limn
