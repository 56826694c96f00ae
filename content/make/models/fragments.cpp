#include "content/make/models/fragments.h"

#include "ecs/base/rng.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <queue>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr std::uint32_t kNoFragment = 0xffffffffu;
constexpr int kGroupRounds = 4;  // of moving the middles of the groups

/// A triangle with an area.
struct FragmentFace {
    std::array<std::uint32_t, 3> corner;  ///< vertices
    std::array<std::uint32_t, 3> point;   ///< the same, but one for each position
    std::array<std::uint32_t, 3> beside = {
        kNoFragment, kNoFragment, kNoFragment};  ///< faces across the edges
    Vec3 middle;
    float area;
};

struct Shell {
    std::vector<FragmentFace> faces;
    std::vector<Vec3> normals;  ///< of points, mean of the faces around by area
};

Shell find_faces(const MeshData& mesh) {
    Shell shell;
    std::map<std::tuple<float, float, float>, std::uint32_t> points;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, int>> edges;
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        FragmentFace face{};
        Vec3 p[3];
        for (std::size_t k = 0; k < 3; ++k) {
            face.corner[k] = mesh.indices[i + k];
            p[k] = mesh.positions[face.corner[k]];
        }
        const Vec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        face.area = 0.5f * glm::length(normal);
        face.middle = (p[0] + p[1] + p[2]) / 3.0f;
        if (!(face.area > 0) || !is_finite(face.middle)) {
            continue;
        }
        const auto index = static_cast<std::uint32_t>(shell.faces.size());
        for (std::size_t k = 0; k < 3; ++k) {
            const auto next = static_cast<std::uint32_t>(points.size());
            face.point[k] = points.try_emplace({p[k].x, p[k].y, p[k].z}, next).first->second;
            shell.normals.resize(points.size(), Vec3(0));
            shell.normals[face.point[k]] += normal;
        }
        shell.faces.push_back(face);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = face.point[static_cast<std::size_t>(k)];
            const std::uint32_t b = face.point[static_cast<std::size_t>((k + 1) % 3)];
            edges[{a, b}] = {index, k};
            const auto other = edges.find({b, a});
            if (other != edges.end()) {
                const auto [neighbor, side] = other->second;
                shell.faces[index].beside[static_cast<std::size_t>(k)] = neighbor;
                shell.faces[neighbor].beside[static_cast<std::size_t>(side)] = index;
            }
        }
    }
    for (Vec3& normal : shell.normals) {
        normal = normalize_or(normal, Vec3(0, 1, 0));
    }
    return shell;
}

/// Which of `seeds` each face belongs to: groups grow from face to face, those nearest to their
/// seeds first, so that they are compact and connected. Of a part of the mesh without a seed, the
/// nearest.
std::vector<std::uint32_t> group_faces(
    const std::vector<FragmentFace>& faces, std::span<const std::uint32_t> seeds, float roughness,
    std::uint32_t seed) {
    std::vector<std::uint32_t> group(faces.size(), kNoFragment);
    using Stop = std::tuple<float, std::uint32_t, std::uint32_t>;  // distance, face, group
    std::priority_queue<Stop, std::vector<Stop>, std::greater<>> open;
    for (std::uint32_t k = 0; k < seeds.size(); ++k) {
        open.emplace(0.0f, seeds[k], k);
    }
    while (!open.empty()) {
        const auto [distance, f, k] = open.top();
        open.pop();
        if (group[f] != kNoFragment) {
            continue;
        }
        group[f] = k;
        for (const std::uint32_t next : faces[f].beside) {
            if (next == kNoFragment || group[next] != kNoFragment) {
                continue;
            }
            Random random(seed, next, name_hash("fragment edges"), k);
            const float factor = 1 + roughness * random.uniform(-0.5f, 0.5f);
            open.emplace(
                factor * glm::distance(faces[seeds[k]].middle, faces[next].middle), next, k);
        }
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (group[f] == kNoFragment) {
            const auto nearest =
                std::min_element(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
                    return glm::distance(faces[a].middle, faces[f].middle)
                           < glm::distance(faces[b].middle, faces[f].middle);
                });
            group[f] = static_cast<std::uint32_t>(nearest - seeds.begin());
        }
    }
    return group;
}

/// Mean of the middles in each group, by area.
std::vector<Vec3> find_centers(
    const std::vector<FragmentFace>& faces, const std::vector<std::uint32_t>& group,
    std::size_t count) {
    std::vector<Vec4> sums(count, Vec4(0));
    for (std::size_t f = 0; f < faces.size(); ++f) {
        sums[group[f]] += Vec4(faces[f].middle, 1) * faces[f].area;
    }
    std::vector<Vec3> centers(count, Vec3(0));
    for (std::size_t k = 0; k < count; ++k) {
        centers[k] = sums[k].w > 0 ? Vec3(sums[k]) / sums[k].w : Vec3(0);
    }
    return centers;
}

/// Evenly spread by area: Lloyd's algorithm from faces by chance.
std::vector<std::uint32_t>
spread_seeds(const std::vector<FragmentFace>& faces, const FragmentsShape& shape) {
    const std::size_t count =
        std::min(static_cast<std::size_t>(std::max(shape.count, 1)), faces.size());
    std::vector<std::pair<float, std::uint32_t>> order;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        Random random(shape.seed, f, name_hash("fragment seeds"), 0);
        const float u = static_cast<float>(random.word() >> 8) * 0x1p-24f + 0x1p-25f;
        order.emplace_back(-std::log(u) / faces[f].area, f);  // Efraimidis and Spirakis 2006
    }
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> seeds;
    for (std::size_t k = 0; k < count; ++k) {
        seeds.push_back(order[k].second);
    }
    for (int round = 0; round < kGroupRounds; ++round) {
        const std::vector<std::uint32_t> group = group_faces(faces, seeds, 0, shape.seed);
        const std::vector<Vec3> centers = find_centers(faces, group, count);
        std::vector<float> least(count, std::numeric_limits<float>::max());
        for (std::uint32_t f = 0; f < faces.size(); ++f) {
            const float away = glm::distance(faces[f].middle, centers[group[f]]);
            if (away < least[group[f]]) {
                least[group[f]] = away;
                seeds[group[f]] = f;
            }
        }
    }
    return seeds;
}

/// Appends to `mesh` what is needed of `whole`.
class PieceBuilder {
  public:
    PieceBuilder(const MeshData& whole, const Shell& shell, float thickness, MeshData& mesh)
        : whole_(whole), shell_(shell), thickness_(thickness), mesh_(mesh) {}

    /// Its outside, its inside and, where its neighbors are not in `group`, walls.
    void add(std::span<const std::uint32_t> members, const std::vector<std::uint32_t>& group) {
        for (const bool inside : {false, true}) {
            corners_.clear();
            for (const std::uint32_t f : members) {
                const FragmentFace& face = shell_.faces[f];
                const std::uint32_t a = corner(face, 0, inside);
                const std::uint32_t b = corner(face, inside ? 2 : 1, inside);
                const std::uint32_t c = corner(face, inside ? 1 : 2, inside);
                mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
            }
            if (!(thickness_ > 0)) {
                return;
            }
        }
        for (const std::uint32_t f : members) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t beside = shell_.faces[f].beside[k];
                if (beside == kNoFragment || group[beside] != group[f]) {
                    add_wall(shell_.faces[f], k);
                }
            }
        }
    }

  private:
    [[nodiscard]] Vec3 below(const FragmentFace& face, std::size_t k) const {
        return whole_.positions[face.corner[k]] - shell_.normals[face.point[k]] * thickness_;
    }
    std::uint32_t
    push(const Vec3& position, const Vec3& normal, const Vec4& tangent, const Vec2& uv) {
        mesh_.positions.push_back(position);
        mesh_.normals.push_back(normal);
        mesh_.tangents.push_back(tangent);
        mesh_.uvs.push_back(uv);
        grow(mesh_.bounds, position);
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }
    std::uint32_t corner(const FragmentFace& face, std::size_t k, bool inside) {
        const std::uint32_t vertex = face.corner[k];
        const auto [found, is_new] = corners_.try_emplace(vertex, 0);
        if (is_new) {
            const Vec3 normal = whole_.normals[vertex];
            Vec4 tangent = whole_.tangents[vertex];
            tangent.w = inside ? -tangent.w : tangent.w;
            found->second = push(
                inside ? below(face, k) : whole_.positions[vertex], inside ? -normal : normal,
                tangent, whole_.uvs[vertex]);
        }
        return found->second;
    }
    void add_wall(const FragmentFace& face, std::size_t k) {
        const std::size_t next = (k + 1) % 3;
        const Vec3 a = whole_.positions[face.corner[k]];
        const Vec3 b = whole_.positions[face.corner[next]];
        const Vec3 ahead = normalize_or(b - a, Vec3(1, 0, 0));
        const Vec3 normal =
            normalize_or(glm::cross(below(face, k) - a, b - a), any_perpendicular(ahead));
        const Vec4 tangent(ahead, 1);
        const Vec2 uv_a = whole_.uvs[face.corner[k]];
        const Vec2 uv_b = whole_.uvs[face.corner[next]];
        const std::uint32_t first = push(a, normal, tangent, uv_a);
        push(below(face, k), normal, tangent, uv_a);
        push(below(face, next), normal, tangent, uv_b);
        push(b, normal, tangent, uv_b);
        mesh_.indices.insert(
            mesh_.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }

    const MeshData& whole_;
    const Shell& shell_;
    float thickness_;
    MeshData& mesh_;
    std::map<std::uint32_t, std::uint32_t> corners_;  ///< vertices of the whole that it has
};

}  // namespace

MeshData make_fragments(const FragmentsShape& shape, const Assets& assets) {
    MeshData mesh;
    if (shape.mesh.index >= assets.meshes.size()) {
        return mesh;
    }
    const MeshData& whole = assets.meshes[shape.mesh.index];
    const Shell shell = find_faces(whole);
    if (shell.faces.empty()) {
        return mesh;
    }
    const std::vector<std::uint32_t> seeds = spread_seeds(shell.faces, shape);
    const std::vector<std::uint32_t> group =
        group_faces(shell.faces, seeds, shape.roughness, shape.seed);
    const std::vector<Vec3> centers = find_centers(shell.faces, group, seeds.size());
    std::vector<std::vector<std::uint32_t>> members(seeds.size());
    for (std::uint32_t f = 0; f < group.size(); ++f) {
        members[group[f]].push_back(f);
    }
    PieceBuilder builder(whole, shell, shape.thickness, mesh);
    for (std::size_t k = 0; k < members.size(); ++k) {
        if (members[k].empty()) {
            continue;
        }
        MeshPiece piece{.center = centers[k]};
        piece.first = static_cast<std::uint32_t>(mesh.indices.size());
        builder.add(members[k], group);
        piece.count = static_cast<std::uint32_t>(mesh.indices.size()) - piece.first;
        mesh.pieces.push_back(piece);
    }
    return mesh;
}

void add_piece_meshes(Assets& assets, MeshId mesh) {
    const std::size_t count = assets.meshes[mesh.index].pieces.size();
    for (std::size_t k = 0; k < count; ++k) {
        const MeshData& whole = assets.meshes[mesh.index];
        const MeshPiece& piece = whole.pieces[k];
        MeshData own;
        own.name = whole.name + "." + std::to_string(k);
        std::map<std::uint32_t, std::uint32_t> vertices;
        for (std::uint32_t i = 0; i < piece.count; ++i) {
            const std::uint32_t from = whole.indices[piece.first + i];
            const auto next = static_cast<std::uint32_t>(own.positions.size());
            const auto [found, is_new] = vertices.try_emplace(from, next);
            if (is_new) {
                own.positions.push_back(whole.positions[from] - piece.center);
                own.normals.push_back(whole.normals[from]);
                own.tangents.push_back(whole.tangents[from]);
                own.uvs.push_back(whole.uvs[from]);
                grow(own.bounds, own.positions.back());
            }
            own.indices.push_back(found->second);
        }
        assets.meshes[mesh.index].pieces[k].mesh = {
            static_cast<std::uint32_t>(assets.meshes.size())};
        assets.meshes.push_back(std::move(own));
    }
}

}  // namespace limn
