#include "content/make/models/fur_strands.h"

#include "content/bake/tangents.h"
#include "ecs/base/rng.h"
#include "ecs/components/weld.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

// Techniques: shade.fur

namespace limn {
namespace {

/// A point of a triangle: weights of its corners.
struct StrandRoot {
    std::array<std::uint32_t, 3> corners;
    std::array<float, 3> weights;

    template <typename T>
    [[nodiscard]] T mean(const std::vector<T>& values, const T& none) const {
        if (values.empty()) {
            return none;
        }
        return weights[0] * values[corners[0]] + weights[1] * values[corners[1]]
               + weights[2] * values[corners[2]];
    }
};

/// Areas of triangles, summed up to and including each.
std::vector<double> sum_areas(const MeshData& mesh) {
    std::vector<double> sums;
    double sum = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3 a = mesh.positions[mesh.indices[i]];
        const Vec3 cross = glm::cross(
            mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a);
        const double area = static_cast<double>(glm::length(cross));
        sum += std::isfinite(area) ? area : 0.0;
        sums.push_back(sum);
    }
    return sums;
}

/// The `fraction` of the area falls to triangles before this point.
StrandRoot
find_root(const MeshData& mesh, const std::vector<double>& areas, double fraction, Random& random) {
    const auto found = std::upper_bound(areas.begin(), areas.end(), fraction * areas.back());
    const auto last = static_cast<std::ptrdiff_t>(areas.size()) - 1;
    const std::size_t i = 3 * static_cast<std::size_t>(std::min(found - areas.begin(), last));
    const float u = std::sqrt(random.uniform());
    const float v = random.uniform();
    return {
        {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}, {1 - u, u * (1 - v), u * v}};
}

/// Appends the skin weights of a point for `count` vertices.
void append_root_weights(
    SkinWeights& to, const SkinWeights& from, const StrandRoot& root, int count) {
    std::map<std::uint16_t, float> sums;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = root.corners[k];
        for (std::uint32_t i = from.first[vertex]; i < from.first[vertex + 1]; ++i) {
            if (root.weights[k] > 0) {
                sums[from.joints[i]] += root.weights[k] * from.weights[i];
            }
        }
    }
    for (int i = 0; i < count; ++i) {
        for (const auto& [joint, weight] : sums) {
            to.joints.push_back(joint);
            to.weights.push_back(weight);
        }
        to.first.push_back(static_cast<std::uint32_t>(to.joints.size()));
    }
}

/// Positions of a morph target by vertex; 0 where it has none.
std::vector<Vec3> dense_offsets(const MorphTarget& morph, std::size_t vertices) {
    std::vector<Vec3> offsets(vertices, Vec3(0));
    for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
        offsets[morph.vertices[i]] = morph.positions[i];
    }
    return offsets;
}

/// A parabola that leaves the surface along its normal.
struct StrandCurve {
    Vec3 root;
    Vec3 normal;
    Vec3 lean;  ///< of the tip, in lengths
    float length;

    [[nodiscard]] Vec3 at(float t) const { return root + length * (t * normal + t * t * lean); }
    [[nodiscard]] Vec3 along(float t) const {
        return normalize_or(normal + 2 * t * lean, Vec3(0, 1, 0));
    }
};

/// Combed and drooping, along a surface.
Vec3 lean_along(const Vec3& comb, float droop, const Vec3& normal) {
    const Vec3 all = comb - Vec3(0, droop, 0);
    return all - normal * glm::dot(normal, all);
}

/// Some unit vector across a unit vector.
Vec3 any_across(const Vec3& along) {
    const Vec3 axis = std::abs(along.y) < 0.9f ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    return glm::normalize(glm::cross(along, axis));
}

/// Position, normal and tangent of a strand that lies along `along`: hair is shaded as opposite to
/// the bitangent, cross(normal, tangent) times its sign.
void append_hair_vertex(
    MeshData& mesh, const Vec3& position, const Vec3& along, const Vec3& across,
    const Vec3& skin_normal) {
    const Vec3 normal = glm::cross(across, along);
    const float side = glm::dot(normal, skin_normal) < 0 ? -1.0f : 1.0f;
    mesh.positions.push_back(position);
    mesh.normals.push_back(side * normal);
    mesh.tangents.emplace_back(across, -side);
}

/// Quads between rows of two vertices.
void append_rows(MeshData& mesh, std::uint32_t first, int rows) {
    for (int row = 0; row + 1 < rows; ++row) {
        const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(row);
        mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + 2, a + 1, a + 3, a + 2});
    }
}

void append_ribbon(
    MeshData& mesh, const StrandsShape& shape, const StrandCurve& curve, const Vec3& sideways,
    const Vec3& color, const Vec2& uv) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int row = 0; row < shape.rows; ++row) {
        const float t = static_cast<float>(row) / static_cast<float>(shape.rows - 1);
        const Vec3 along = curve.along(t);
        const Vec3 across = normalize_or(glm::cross(along, sideways), any_across(along));
        const float half = 0.5f * shape.width * (1 - 0.9f * t * t);
        for (const float edge : {-1.0f, 1.0f}) {
            append_hair_vertex(
                mesh, curve.at(t) + edge * half * across, along, across, curve.normal);
            mesh.uvs.push_back(uv);
            mesh.colors.emplace_back(color * glm::mix(Vec3(shape.root), shape.tip, t), 1.0f);
        }
    }
    append_rows(mesh, first, shape.rows);
}

using FinEdge = std::pair<std::uint32_t, std::uint32_t>;

/// The edges of triangles, each once: vertices at one position count as one.
std::vector<FinEdge> distinct_edges(const MeshData& mesh) {
    const std::vector<std::uint32_t> welded = weld_positions(mesh.positions);
    std::set<FinEdge> known;
    std::vector<FinEdge> edges;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.indices[i + k];
            const std::uint32_t b = mesh.indices[i + (k + 1) % 3];
            const FinEdge ends = std::minmax(welded[a], welded[b]);
            if (ends.first != ends.second && known.insert(ends).second) {
                edges.emplace_back(a, b);
            }
        }
    }
    return edges;
}

/// Gives vertices of a mesh the skin weights and morph targets of points of another one.
class RootedMesh {
  public:
    RootedMesh(MeshData& mesh, const MeshData& skin) : mesh_(mesh), skin_(skin) {
        if (!skin.skin.empty()) {
            mesh.skin.first.push_back(0);
        }
        for (const MorphTarget& morph : skin.morphs) {
            offsets_.push_back(dense_offsets(morph, skin.positions.size()));
            MorphTarget& moved = mesh.morphs.emplace_back();
            moved.name = morph.name;
            moved.action_unit = morph.action_unit;
            moved.drivers = morph.drivers;
        }
    }
    /// For the last `count` vertices.
    void append(const StrandRoot& root, int count) {
        if (!skin_.skin.empty()) {
            append_root_weights(mesh_.skin, skin_.skin, root, count);
        }
        const auto end = static_cast<std::uint32_t>(mesh_.positions.size());
        for (std::size_t m = 0; m < offsets_.size(); ++m) {
            const Vec3 offset = root.mean(offsets_[m], Vec3(0));
            for (std::uint32_t v = end - static_cast<std::uint32_t>(count);
                 v < end && offset != Vec3(0); ++v) {
                mesh_.morphs[m].vertices.push_back(v);
                mesh_.morphs[m].positions.push_back(offset);
            }
        }
    }

  private:
    MeshData& mesh_;
    const MeshData& skin_;
    std::vector<std::vector<Vec3>> offsets_;  ///< by morph target and vertex
};

void append_fin(
    MeshData& mesh, RootedMesh& rooted, int rows, const MeshData& skin, const FinEdge& edge,
    float first_u) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const float width = glm::distance(skin.positions[edge.first], skin.positions[edge.second]);
    for (int row = 0; row < rows; ++row) {
        const float t = static_cast<float>(row) / static_cast<float>(rows - 1);
        for (const std::uint32_t v : {edge.first, edge.second}) {
            mesh.positions.push_back(skin.positions[v]);
            mesh.normals.push_back(skin.normals[v]);
            mesh.tangents.push_back(v < skin.tangents.size() ? skin.tangents[v] : Vec4(1, 0, 0, 1));
            mesh.uvs.push_back(v < skin.uvs.size() ? skin.uvs[v] : Vec2(0));
            mesh.uvs1.emplace_back(first_u + (v == edge.first ? 0.0f : width), t);
            mesh.colors.push_back(v < skin.colors.size() ? skin.colors[v] : Vec4(1));
            rooted.append({{v, v, v}, {1, 0, 0}}, 1);
        }
    }
    append_rows(mesh, first, rows);
}

}  // namespace

MeshData make_strands(const StrandsShape& shape, const Assets& assets) {
    MeshData mesh;
    if (shape.mesh.index >= assets.meshes.size()) {
        return mesh;
    }
    const MeshData& skin = assets.meshes[shape.mesh.index];
    const std::vector<double> areas = sum_areas(skin);
    if (areas.empty() || areas.back() <= 0 || skin.normals.size() != skin.positions.size()) {
        return mesh;
    }
    RootedMesh rooted(mesh, skin);
    Random random(shape.seed, 0, name_hash("fur_strands"), 0);
    for (int i = 0; i < shape.count; ++i) {
        const double fraction = (i + static_cast<double>(random.uniform())) / shape.count;
        const StrandRoot root = find_root(skin, areas, fraction, random);
        const Vec3 sideways = {
            random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f};
        const Vec3 stray = {
            random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f};
        const float rank = random.uniform();
        const float brightness = 1 + shape.variation * (2 * random.uniform() - 1);
        const Vec4 color = root.mean(skin.colors, Vec4(1));
        const Vec3 normal = normalize_or(root.mean(skin.normals, Vec3(0)), Vec3(0));
        if (color.w <= 0 || normal == Vec3(0)) {
            continue;
        }
        const Vec3 lean = lean_along(shape.comb + shape.unruly * stray, shape.droop, normal);
        const float length = shape.length * color.w * glm::mix(shape.shortest, 1.0f, rank);
        append_ribbon(
            mesh, shape, {root.mean(skin.positions, Vec3(0)), normal, lean, length}, sideways,
            brightness * Vec3(color), root.mean(skin.uvs, Vec2(0)));
        rooted.append(root, 2 * shape.rows);
    }
    update_bounds(mesh);
    return mesh;
}

MeshData make_fins(const FinsShape& shape, const Assets& assets) {
    MeshData mesh;
    if (shape.mesh.index >= assets.meshes.size()) {
        return mesh;
    }
    const MeshData& skin = assets.meshes[shape.mesh.index];
    if (skin.normals.size() != skin.positions.size()) {
        return mesh;
    }
    RootedMesh rooted(mesh, skin);
    float u = 0;
    for (const FinEdge& edge : distinct_edges(skin)) {
        append_fin(mesh, rooted, shape.rows, skin, edge, u);
        u = std::fmod(u + 0.377f, 10.0f);
    }
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
