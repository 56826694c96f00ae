#include "content/make/models/refine_mesh.h"

#include "content/bake/tangents.h"
#include "ecs/components/weld.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

// Techniques: wrinkle.displacement

namespace limn {

namespace {

constexpr std::size_t kMaxRefinedVertices = 1000000;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr float kMaxBulge = 0.2f;  ///< offset of a midpoint, relative to the edge's length

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Data shared by vertices at one position, indexed by the first of them.
struct Points {
    std::vector<std::uint32_t> welded;  ///< per vertex the first at its position
    std::vector<Vec3> normals;          ///< means
};

Points find_points(const MeshData& mesh) {
    const std::size_t vertices = mesh.positions.size();
    Points points = {weld_positions(mesh.positions), std::vector<Vec3>(vertices, Vec3(0))};
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        points.normals[points.welded[v]] += mesh.normals[v];
    }
    for (Vec3& normal : points.normals) {
        normal = normalize_or(normal, Vec3(0));
    }
    return points;
}

/// Vertices whose edges may be halved: those of regions that fold, and their neighbors; all if the
/// mesh has no regions.
std::vector<char> find_foldable(const MeshData& mesh) {
    if (mesh.regions.empty()) {
        return std::vector<char>(mesh.positions.size(), 1);
    }
    const std::vector<std::uint32_t> welded = weld_positions(mesh.positions);
    std::vector<char> folds(mesh.positions.size(), 0);  // by the first vertex at a position
    for (const VertexRegion& region : mesh.regions) {
        for (std::size_t v = 0; v < region.weights.size() && !region.across.empty(); ++v) {
            if (region.weights[v] > 0) {
                folds[welded[v]] = 1;
            }
        }
    }
    std::vector<char> near = folds;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::uint32_t* const v = &mesh.indices[t];
        const bool any =
            std::any_of(v, v + 3, [&](std::uint32_t i) { return folds[welded[i]] != 0; });
        for (std::size_t k = 0; any && k < 3; ++k) {
            near[welded[v[k]]] = 1;
        }
    }
    for (std::size_t v = 0; v < near.size(); ++v) {
        folds[v] = near[welded[v]];
    }
    return folds;
}

/// The same for both directions of an edge, and for all its copies.
Vec3 edge_midpoint(const MeshData& mesh, const Points& points, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t low = std::min(points.welded[a], points.welded[b]);
    const std::uint32_t high = std::max(points.welded[a], points.welded[b]);
    const Vec3 p = mesh.positions[low];
    const Vec3 q = mesh.positions[high];
    const Vec3 bulge = -0.125f
                       * (glm::dot(q - p, points.normals[low]) * points.normals[low]
                          + glm::dot(p - q, points.normals[high]) * points.normals[high]);
    const float length = glm::length(bulge);
    const float most = kMaxBulge * glm::distance(p, q);
    return 0.5f * (p + q) + (length > most ? bulge * (most / length) : bulge);
}

/// The ends of the edge that a new vertex halves.
using Ends = std::pair<std::uint32_t, std::uint32_t>;

/// Appends f(end, end) for each new vertex to values that all vertices have.
template <typename T, typename F>
void append_midpoints(std::vector<T>& values, std::size_t old, const std::vector<Ends>& made, F f) {
    if (values.size() == old) {
        values.reserve(old + made.size());
        for (const auto& [a, b] : made) {
            values.push_back(f(values[a], values[b]));
        }
    }
}

void append_refined_influences(SkinWeights& skin, const std::vector<Ends>& made) {
    if (skin.empty()) {
        return;
    }
    for (const Ends& ends : made) {
        const std::size_t begin = skin.joints.size();
        for (const std::uint32_t v : {ends.first, ends.second}) {
            for (std::uint32_t i = skin.first[v]; i < skin.first[v + 1]; ++i) {
                const std::uint16_t joint = skin.joints[i];
                const float weight = 0.5f * skin.weights[i];
                const auto same = std::find(
                    skin.joints.begin() + static_cast<std::ptrdiff_t>(begin), skin.joints.end(),
                    joint);
                if (same != skin.joints.end()) {
                    skin.weights[static_cast<std::size_t>(same - skin.joints.begin())] += weight;
                } else {
                    skin.joints.push_back(joint);
                    skin.weights.push_back(weight);
                }
            }
        }
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    }
}

void append_offsets(MorphTarget& morph, std::size_t old, const std::vector<Ends>& made) {
    std::vector<std::uint32_t> index_of(old, kNone);
    for (std::uint32_t i = 0; i < morph.vertices.size(); ++i) {
        index_of[morph.vertices[i]] = i;
    }
    for (std::size_t m = 0; m < made.size(); ++m) {
        const std::uint32_t a = index_of[made[m].first];
        const std::uint32_t b = index_of[made[m].second];
        if (a == kNone && b == kNone) {
            continue;
        }
        const auto mean = [&](std::vector<Vec3>& values) {
            if (!values.empty()) {
                const Vec3 from = a != kNone ? values[a] : Vec3(0);
                const Vec3 to = b != kNone ? values[b] : Vec3(0);
                values.push_back(0.5f * (from + to));
            }
        };
        mean(morph.positions);
        mean(morph.normals);
        mean(morph.tangents);
        morph.vertices.push_back(static_cast<std::uint32_t>(old + m));
    }
}

/// All vertex attributes except positions.
void append_attributes(MeshData& mesh, std::size_t old, const std::vector<Ends>& made) {
    const auto mean = [](const auto& a, const auto& b) { return 0.5f * (a + b); };
    const auto unit = [](const Vec3& a, const Vec3& b) { return normalize_or(a + b, a); };
    append_midpoints(mesh.normals, old, made, unit);
    append_midpoints(mesh.tangents, old, made, [&](const Vec4& a, const Vec4& b) {
        return Vec4(unit(Vec3(a), Vec3(b)), a.w);
    });
    append_midpoints(mesh.uvs, old, made, mean);
    append_midpoints(mesh.uvs1, old, made, mean);
    append_midpoints(mesh.colors, old, made, mean);
    append_refined_influences(mesh.skin, made);
    for (MorphTarget& morph : mesh.morphs) {
        append_offsets(morph, old, made);
    }
    for (VertexRegion& region : mesh.regions) {
        append_midpoints(region.weights, old, made, mean);
        append_midpoints(region.across, old, made, [](const Vec3& a, const Vec3& b) {
            return normalize_or(glm::dot(a, b) < 0 ? a - b : a + b, a);  // of either sign
        });
    }
}

/// Appends the parts of a triangle with these midpoints, kNone for unsplit edges.
void append_parts(
    const MeshData& mesh, std::array<std::uint32_t, 3> v, std::array<std::uint32_t, 3> midpoint,
    std::vector<std::uint32_t>& indices) {
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        indices.insert(indices.end(), {a, b, c});
    };
    const auto halved = 3 - std::ranges::count(midpoint, kNone);
    // Turned so that, of one or two halved edges, the last one is whole and the first one halved.
    while ((halved == 1 || halved == 2) && (midpoint[0] == kNone || midpoint[2] != kNone)) {
        std::rotate(v.begin(), v.begin() + 1, v.end());
        std::rotate(midpoint.begin(), midpoint.begin() + 1, midpoint.end());
    }
    if (halved == 0) {
        add(v[0], v[1], v[2]);
    } else if (halved == 1) {
        add(v[0], midpoint[0], v[2]);
        add(midpoint[0], v[1], v[2]);
    } else if (halved == 2) {
        add(midpoint[0], v[1], midpoint[1]);
        const auto distance = [&](std::uint32_t a, std::uint32_t b) {
            return glm::distance(mesh.positions[a], mesh.positions[b]);
        };
        if (distance(v[0], midpoint[1]) <= distance(midpoint[0], v[2])) {
            add(v[0], midpoint[0], midpoint[1]);
            add(v[0], midpoint[1], v[2]);
        } else {
            add(v[0], midpoint[0], v[2]);
            add(midpoint[0], midpoint[1], v[2]);
        }
    } else {
        add(v[0], midpoint[0], midpoint[2]);
        add(midpoint[0], v[1], midpoint[1]);
        add(midpoint[2], midpoint[1], v[2]);
        add(midpoint[0], midpoint[1], midpoint[2]);
    }
}

/// Halves all edges that are too long, once; false if there are none.
bool halve_edges(MeshData& mesh, float edge, std::vector<char>& foldable) {
    const Points points = find_points(mesh);
    const std::size_t old = mesh.positions.size();
    std::unordered_map<std::uint64_t, std::uint32_t> midpoints;  // by vertices, without welding
    std::vector<Ends> made;
    const auto midpoint_vertex = [&](std::uint32_t a, std::uint32_t b) {
        const bool folds = foldable[a] != 0 && foldable[b] != 0;
        if (!folds || !(glm::distance(mesh.positions[a], mesh.positions[b]) > edge)) {
            return kNone;
        }
        const auto [found, added] =
            midpoints.try_emplace(edge_key(a, b), static_cast<std::uint32_t>(old + made.size()));
        if (added) {
            made.emplace_back(a, b);
        }
        return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> halved;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::uint32_t* const v = &mesh.indices[t];
        std::array<std::uint32_t, 3>& corners = halved.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = midpoint_vertex(v[k], v[(k + 1) % 3]);
        }
    }
    if (made.empty() || old + made.size() > kMaxRefinedVertices) {
        return false;
    }
    append_attributes(mesh, old, made);
    foldable.resize(old + made.size(), 1);
    mesh.positions.reserve(old + made.size());
    for (const auto& [a, b] : made) {
        mesh.positions.push_back(edge_midpoint(mesh, points, a, b));
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(4 * mesh.indices.size());
    for (std::size_t t = 0; t < halved.size(); ++t) {
        const std::uint32_t* const v = &mesh.indices[3 * t];
        append_parts(mesh, {v[0], v[1], v[2]}, halved[t], indices);
    }
    mesh.indices = std::move(indices);
    return true;
}

}  // namespace

void refine_mesh(MeshData& mesh, float edge, int times) {
    const bool whole =
        std::ranges::all_of(mesh.positions, [](const Vec3& p) { return is_finite(p); });
    std::vector<char> foldable = whole ? find_foldable(mesh) : std::vector<char>{};
    for (int i = 0; whole && i < times && halve_edges(mesh, edge, foldable); ++i) {
    }
}

MeshData make_refined(const RefinedShape& shape, const Assets& assets) {
    if (shape.mesh.index >= assets.meshes.size()) {
        return {};
    }
    MeshData mesh = assets.meshes[shape.mesh.index];
    mesh.pieces.clear();
    refine_mesh(mesh, shape.edge, shape.times);
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
