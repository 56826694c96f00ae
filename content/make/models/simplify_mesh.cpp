#include "content/make/models/simplify_mesh.h"

#include "content/bake/tangents.h"
#include "content/make/models/keep_triangles.h"
#include "content/make/models/merge_joints.h"
#include "ecs/base/log.h"

#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

// Techniques: engine.lod-mesh

namespace limn {

namespace {

constexpr float kLargestError = 0.05f;  ///< relative to the size of the mesh

/// Size of the box of the triangles; 0 without any.
Vec3 extent_of(const MeshData& mesh, const std::vector<std::uint32_t>& indices) {
    if (indices.empty()) {
        return Vec3(0);
    }
    Vec3 low = mesh.positions[indices[0]];
    Vec3 high = low;
    for (const std::uint32_t index : indices) {
        low = glm::min(low, mesh.positions[index]);
        high = glm::max(high, mesh.positions[index]);
    }
    return high - low;
}

/// The joint with the largest weight at a vertex.
std::uint32_t main_joint(const SkinWeights& skin, std::size_t vertex) {
    const auto first = skin.weights.begin() + skin.first[vertex];
    const auto last = skin.weights.begin() + skin.first[vertex + 1];
    return first == last ? 0
                         : skin.joints[static_cast<std::size_t>(
                             std::max_element(first, last) - skin.weights.begin())];
}

/// Positions with what moves with each joint `spread` times as far again from the middle: legs and
/// arms that hang side by side then lie in different cells, and are not joined by webs.
std::vector<Vec3> spread_limbs(const MeshData& mesh, float spread) {
    std::vector<Vec3> positions = mesh.positions;
    if (mesh.skin.empty() || spread == 0) {
        return positions;
    }
    struct Part {
        Vec3 sum = {0, 0, 0};
        float count = 0;
    };
    std::vector<Part> parts;
    Part whole;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const std::uint32_t joint = main_joint(mesh.skin, v);
        parts.resize(std::max<std::size_t>(parts.size(), joint + 1));
        parts[joint].sum += positions[v];
        parts[joint].count += 1;
        whole.sum += positions[v];
        whole.count += 1;
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Part& part = parts[main_joint(mesh.skin, v)];
        positions[v] += spread * (part.sum / part.count - whole.sum / whole.count);
    }
    return positions;
}

/// Which parts of a body, by their main joints, are near each other: they share a triangle, or both
/// share one with the same third part. A triangle of two others would be a web between limbs.
class PartsNearby {
  public:
    explicit PartsNearby(const MeshData& mesh) : mesh_(mesh) {
        if (mesh.skin.empty()) {
            return;
        }
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            count_ = std::max<std::size_t>(count_, main_joint(mesh.skin, v) + 1);
        }
        std::vector<bool> touch(count_ * count_, false);
        for_pairs(mesh.indices, [&](std::size_t pair) { touch[pair] = true; });
        near_ = touch;
        for (std::size_t a = 0; a < count_; ++a) {
            for (std::size_t b = 0; b < count_; ++b) {
                for (std::size_t c = 0; touch[a * count_ + b] && c < count_; ++c) {
                    near_[a * count_ + c] = near_[a * count_ + c] || touch[b * count_ + c];
                }
            }
        }
    }
    [[nodiscard]] std::size_t count_webs(const std::vector<std::uint32_t>& indices) const {
        std::size_t webs = 0;
        for_pairs(indices, [&](std::size_t pair) { webs += near_[pair] ? 0 : 1; });
        return webs;
    }

  private:
    /// Of each triangle, the joints of all pairs of corners.
    template <typename Visit>
    void for_pairs(const std::vector<std::uint32_t>& indices, Visit&& visit) const {
        for (std::size_t i = 0; count_ > 0 && i < indices.size(); ++i) {
            const std::size_t a = main_joint(mesh_.skin, indices[i]);
            const std::size_t b = main_joint(mesh_.skin, indices[i % 3 == 2 ? i - 2 : i + 1]);
            visit(a * count_ + b);
            visit(b * count_ + a);
        }
    }

    const MeshData& mesh_;
    std::size_t count_ = 0;
    std::vector<bool> near_;
};

/// Positions of which those of dark vertices are closer to the center.
std::vector<Vec3> sunk_by_color(const MeshData& mesh, float depth) {
    std::vector<Vec3> positions = mesh.positions;
    if (depth <= 0 || mesh.colors.size() != positions.size()) {
        return positions;
    }
    const Vec3 size = extent_of(mesh, mesh.indices);
    const float deepest = depth * std::max({size.x, size.y, size.z});
    Vec3 center(0);
    for (const Vec3& p : positions) {
        center += p / static_cast<float>(positions.size());
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3 color = mesh.colors[v];
        const float dark = 1 - (color.x + color.y + color.z) / 3;
        const Vec3 inwards = center - positions[v];
        const float distance = glm::length(inwards);
        if (distance > 0) {
            positions[v] += inwards / distance * (deepest * dark);
        }
    }
    return positions;
}

}  // namespace

void simplify_mesh(MeshData& mesh, std::size_t triangles, float colors) {
    if (3 * triangles >= mesh.indices.size()) {
        return;
    }
    const std::vector<Vec3> positions = sunk_by_color(mesh, colors);
    std::vector<std::uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplify(
        indices.data(), mesh.indices.data(), mesh.indices.size(), &positions[0].x, positions.size(),
        sizeof(Vec3), 3 * triangles, kLargestError));
    keep_triangles(mesh, std::move(indices));
}

void merge_mesh(MeshData& mesh, std::size_t triangles) {
    if (3 * triangles >= mesh.indices.size()) {
        return;
    }
    constexpr float kAnyError = 1.0f;
    constexpr float kSmallLoss = 0.1f;  // of the size
    constexpr float kSpreads[] = {4.0f, 3.0f, 2.0f, 6.0f, 1.0f, 0.0f};
    const Vec3 size = extent_of(mesh, mesh.indices);
    const PartsNearby parts(mesh);
    std::vector<std::uint32_t> best;
    std::pair<std::size_t, float> least = {
        std::numeric_limits<std::size_t>::max(), 0.0f};  // webs, extent lost
    for (const float spread : kSpreads) {
        const std::vector<Vec3> positions = spread_limbs(mesh, spread);
        std::vector<std::uint32_t> indices(mesh.indices.size());
        indices.resize(meshopt_simplifySloppy(
            indices.data(), mesh.indices.data(), mesh.indices.size(), &positions[0].x,
            positions.size(), sizeof(Vec3), 3 * triangles, kAnyError));
        const Vec3 lost = size - extent_of(mesh, indices);
        const float loss = std::max({lost.x, lost.y, lost.z});
        const bool is_whole = loss < kSmallLoss * std::max({size.x, size.y, size.z});
        const std::pair<std::size_t, float> faults = {
            parts.count_webs(indices), is_whole ? 0.0f : loss};
        if (faults < least) {
            least = faults;
            best = std::move(indices);
        }
        if (faults.first == 0 && is_whole) {
            break;  // limbs far apart have the best shapes
        }
    }
    keep_triangles(mesh, std::move(best));
}

MeshData make_simplified(const SimplifiedShape& shape, const Assets& assets) {
    if (shape.mesh.index >= assets.meshes.size()) {
        return {};
    }
    MeshData mesh = assets.meshes[shape.mesh.index];
    mesh.pieces.clear();
    const auto triangles = static_cast<std::size_t>(std::max(shape.triangles, 4));
    shape.merge ? merge_mesh(mesh, triangles) : simplify_mesh(mesh, triangles, shape.colors);
    const auto skeleton = std::ranges::find(assets.skeletons, mesh.name, &SkeletonData::name);
    const auto skin = std::ranges::find(assets.skins, mesh.name, &SkinData::name);
    if (shape.joints > 0 && !mesh.skin.empty()) {
        if (skeleton != assets.skeletons.end() && skin != assets.skins.end()) {
            merge_joints(mesh.skin, *skin, *skeleton, static_cast<std::size_t>(shape.joints));
        } else {
            log_warn(
                "simplified: joints has no effect on {}, which has no skeleton of its name",
                mesh.name);
        }
    }
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
