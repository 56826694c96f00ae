#include "content/bake/tangents.h"

#include "ecs/base/check.h"
#include "ecs/components/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <unordered_map>
#include <vector>

// Techniques: bump.tangent-triangle, bump.tangent-vertex

namespace limn {

namespace {

using TangentDVec3 = glm::dvec3;

constexpr std::uint32_t kNoTangent = 0xffffffffu;

/// Beyond this number of corners at one point all are smoothed together, to avoid quadratic time.
constexpr std::size_t kMaxCreaseCorners = 256;

/// Floats as a key of a hash map, by their bits; -0 equals 0.
template <std::size_t N>
struct FloatKey {
    std::array<std::uint32_t, N> bits;

    explicit FloatKey(const std::array<float, N>& values) : bits{} {
        for (std::size_t i = 0; i < N; ++i) {
            bits[i] = std::bit_cast<std::uint32_t>(values[i] + 0.0f);
        }
    }
    bool operator==(const FloatKey&) const = default;
};

struct FloatKeyHash {
    template <std::size_t N>
    std::size_t operator()(const FloatKey<N>& key) const {
        std::uint64_t hash = 0x9e3779b97f4a7c15u;
        for (const std::uint32_t bits : key.bits) {
            hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
            hash ^= hash >> 32;
        }
        return hash;
    }
};

/// Equal keys get equal numbers, 0, 1, 2 ... in order of appearance.
template <std::size_t N>
class Welder {
  public:
    explicit Welder(std::size_t expected) { numbers_.reserve(expected); }
    std::uint32_t number(const std::array<float, N>& values) {
        const auto next = static_cast<std::uint32_t>(numbers_.size());
        return numbers_.try_emplace(FloatKey<N>(values), next).first->second;
    }
    [[nodiscard]] std::size_t size() const { return numbers_.size(); }

  private:
    std::unordered_map<FloatKey<N>, std::uint32_t, FloatKeyHash> numbers_;
};

/// Unit `v`, or zero.
TangentDVec3 direction(const TangentDVec3& v) {
    const double length = glm::length(v);
    return length > 1e-150 ? v / length : TangentDVec3(0);
}

/// Angle between the edges of a triangle that leave corner `k` [rad]; 0 where an edge has no
/// length.
double corner_angle(const TangentDVec3 (&p)[3], int k) {
    const TangentDVec3 a = direction(p[(k + 1) % 3] - p[k]);
    const TangentDVec3 b = direction(p[(k + 2) % 3] - p[k]);
    if (a == TangentDVec3(0) || b == TangentDVec3(0)) {
        return 0.0;
    }
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));  // exact near 0 and pi too
}

/// Appends a copy of vertex `v` and returns its index.
std::uint32_t duplicate_vertex(MeshData& mesh, std::uint32_t v) {
    const auto copy = static_cast<std::uint32_t>(mesh.positions.size());
    const auto append = [v, copy](auto& values) {
        if (values.size() == copy) {
            const auto value = values[v];
            values.push_back(value);
        }
    };
    append(mesh.normals);
    append(mesh.tangents);
    append(mesh.uvs);
    append(mesh.uvs1);
    append(mesh.colors);
    for (VertexRegion& region : mesh.regions) {
        append(region.weights);
        append(region.across);
    }
    append(mesh.positions);  // last, since the others compare with its size
    if (SkinWeights& skin = mesh.skin; !skin.empty()) {
        for (std::uint32_t i = skin.first[v], end = skin.first[v + 1]; i < end; ++i) {
            skin.joints.push_back(std::uint16_t{skin.joints[i]});
            skin.weights.push_back(float{skin.weights[i]});
        }
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    }
    for (MorphTarget& morph : mesh.morphs) {
        const auto found = std::lower_bound(morph.vertices.begin(), morph.vertices.end(), v);
        if (found != morph.vertices.end() && *found == v) {
            const auto index = static_cast<std::size_t>(found - morph.vertices.begin());
            for (std::vector<Vec3>* const values :
                 {&morph.positions, &morph.normals, &morph.tangents}) {
                if (!values->empty()) {
                    values->push_back(Vec3((*values)[index]));
                }
            }
            morph.vertices.push_back(copy);  // keeps the list sorted
        }
    }
    return copy;
}

void get_corners(const MeshData& mesh, std::size_t triangle, TangentDVec3 (&p)[3]) {
    for (int k = 0; k < 3; ++k) {
        p[k] = TangentDVec3(mesh.positions[mesh.indices[3 * triangle + k]]);
    }
}

/// The corners (3 * triangle + k) at each point: corners[first[point] .. first[point + 1]).
struct PointCorners {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> point_of;  ///< for each corner
};

PointCorners find_point_corners(const MeshData& mesh) {
    Welder<3> welder(mesh.positions.size());
    std::vector<std::uint32_t> point_of_vertex;
    point_of_vertex.reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) {
        point_of_vertex.push_back(welder.number({p.x, p.y, p.z}));
    }
    PointCorners result;
    result.point_of.reserve(mesh.indices.size());
    result.first.assign(welder.size() + 1, 0);
    for (const std::uint32_t vertex : mesh.indices) {
        result.point_of.push_back(point_of_vertex[vertex]);
        ++result.first[point_of_vertex[vertex] + 1];
    }
    for (std::size_t i = 1; i < result.first.size(); ++i) {
        result.first[i] += result.first[i - 1];
    }
    std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
    result.corners.resize(mesh.indices.size());
    for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner) {
        result.corners[next[result.point_of[corner]]++] = corner;
    }
    return result;
}

/// One normal for each corner of each triangle.
std::vector<Vec3> find_corner_normals(const MeshData& mesh, float crease_angle) {
    const std::size_t triangles = mesh.indices.size() / 3;
    std::vector<TangentDVec3> face_normals(triangles);
    std::vector<double> angles(3 * triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
        TangentDVec3 p[3];
        get_corners(mesh, t, p);
        face_normals[t] = direction(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (int k = 0; k < 3; ++k) {
            angles[3 * t + k] = corner_angle(p, k);
        }
    }

    const PointCorners around = find_point_corners(mesh);
    const double min_cosine = std::cos(static_cast<double>(crease_angle)) - 1e-6;
    std::vector<Vec3> normals(mesh.indices.size());
    for (std::size_t point = 0; point + 1 < around.first.size(); ++point) {
        const std::span corners(
            around.corners.data() + around.first[point],
            around.first[point + 1] - around.first[point]);
        const bool all = crease_angle >= kPi || corners.size() > kMaxCreaseCorners;
        for (const std::uint32_t corner : corners) {
            const TangentDVec3& own = face_normals[corner / 3];
            TangentDVec3 sum(0);
            for (const std::uint32_t other : corners) {
                const TangentDVec3& normal = face_normals[other / 3];
                if (all || own == TangentDVec3(0) || glm::dot(own, normal) >= min_cosine) {
                    sum += angles[other] * normal;
                }
            }
            const Vec3 fallback = own == TangentDVec3(0) ? Vec3(0, 1, 0) : Vec3(own);
            normals[corner] = normalize_or(Vec3(sum), fallback);
            if (all) {
                for (const std::uint32_t other : corners) {
                    normals[other] = normals[corner];
                }
                break;
            }
        }
    }
    return normals;
}

/// Splits vertices shared with mirrored triangles; returns the uv orientation sign of each vertex.
std::vector<std::int8_t> split_mirrored(MeshData& mesh, const std::vector<TriangleFrame>& frames) {
    std::vector<std::int8_t> side(mesh.positions.size(), 0);
    std::vector<std::uint32_t> twin(mesh.positions.size(), kNoTangent);
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
        const float determinant = frames[corner / 3].determinant;
        if (determinant == 0.0f) {
            continue;
        }
        const std::int8_t own = determinant > 0 ? 1 : -1;
        const std::uint32_t vertex = mesh.indices[corner];
        if (side[vertex] == 0) {
            side[vertex] = own;
        } else if (side[vertex] != own) {
            if (twin[vertex] == kNoTangent) {
                twin[vertex] = duplicate_vertex(mesh, vertex);
                side.push_back(own);
            }
            mesh.indices[corner] = twin[vertex];
        }
    }
    return side;
}

std::vector<TriangleFrame>
find_triangle_frames(const MeshData& mesh, const std::vector<Vec2>& uvs) {
    std::vector<TriangleFrame> frames(mesh.indices.size() / 3);
    for (std::size_t t = 0; t < frames.size(); ++t) {
        const std::uint32_t* v = &mesh.indices[3 * t];
        frames[t] = triangle_frame(
            {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]},
            {uvs[v[0]], uvs[v[1]], uvs[v[2]]});
    }
    return frames;
}

/// Adds the normal of the triangle with vertices `v`, weighted by the angle at each corner.
void add_face(
    const std::vector<Vec3>& positions, const std::uint32_t* v, TangentDVec3 (&weighted)[3],
    double sign) {
    const TangentDVec3 p[3] = {
        TangentDVec3(positions[v[0]]), TangentDVec3(positions[v[1]]),
        TangentDVec3(positions[v[2]])};
    const TangentDVec3 normal = direction(glm::cross(p[1] - p[0], p[2] - p[0]));
    for (int k = 0; k < 3; ++k) {
        weighted[k] += sign * corner_angle(p, k) * normal;
    }
}

/// Groups vertices of equal position and normal, whose faces are smoothed together.
struct SmoothGroups {
    std::vector<std::uint32_t> group_of;
    std::vector<TangentDVec3> sums;  ///< of the face normals around each group

    explicit SmoothGroups(const MeshData& mesh) {
        Welder<6> welder(mesh.positions.size());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3& p = mesh.positions[v];
            const Vec3& n = mesh.normals[v];
            group_of.push_back(welder.number({p.x, p.y, p.z, n.x, n.y, n.z}));
        }
        sums.assign(welder.size(), TangentDVec3(0));
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            TangentDVec3 weighted[3] = {TangentDVec3(0), TangentDVec3(0), TangentDVec3(0)};
            add_face(mesh.positions, &mesh.indices[i], weighted, 1.0);
            for (std::size_t k = 0; k < 3; ++k) {
                sums[group_of[mesh.indices[i + k]]] += weighted[k];
            }
        }
    }
};

void generate_normals_of(MorphTarget& morph, const MeshData& mesh, const SmoothGroups& groups) {
    std::vector<Vec3> moved = mesh.positions;
    std::vector<bool> moves(moved.size(), false);
    for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
        moved[morph.vertices[i]] += morph.positions[i];
        moves[morph.vertices[i]] = true;
    }
    std::vector<TangentDVec3> sums = groups.sums;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t* v = &mesh.indices[i];
        if (moves[v[0]] || moves[v[1]] || moves[v[2]]) {
            TangentDVec3 weighted[3] = {TangentDVec3(0), TangentDVec3(0), TangentDVec3(0)};
            add_face(moved, v, weighted, 1.0);
            add_face(mesh.positions, v, weighted, -1.0);
            for (std::size_t k = 0; k < 3; ++k) {
                sums[groups.group_of[v[k]]] += weighted[k];
            }
        }
    }
    constexpr float kMinTurn = 1e-6f;  // above the rounding of the sums
    MorphTarget result;
    result.name = std::move(morph.name);
    result.action_unit = std::move(morph.action_unit);
    result.drivers = std::move(morph.drivers);
    for (std::uint32_t v = 0; v < moved.size(); ++v) {
        const std::uint32_t group = groups.group_of[v];
        const Vec3 turn(direction(sums[group]) - direction(groups.sums[group]));
        if (moves[v] || glm::length(turn) > kMinTurn) {
            result.vertices.push_back(v);
            result.normals.push_back(turn);
            result.positions.emplace_back(0);
        }
    }
    for (std::size_t i = 0, at = 0; i < morph.vertices.size(); ++i) {
        while (result.vertices[at] != morph.vertices[i]) {
            ++at;
        }
        result.positions[at] = morph.positions[i];  // exactly as before
    }
    morph = std::move(result);
}

}  // namespace

TriangleFrame triangle_frame(const Vec3 (&p)[3], const Vec2 (&uv)[3]) {
    const TangentDVec3 e1 = TangentDVec3(p[1]) - TangentDVec3(p[0]);
    const TangentDVec3 e2 = TangentDVec3(p[2]) - TangentDVec3(p[0]);
    const glm::dvec2 d1 = glm::dvec2(uv[1]) - glm::dvec2(uv[0]);
    const glm::dvec2 d2 = glm::dvec2(uv[2]) - glm::dvec2(uv[0]);
    const double determinant = d1.x * d2.y - d2.x * d1.y;

    // Relative to the edge lengths: uvs may be arbitrarily small, but not degenerate.
    const double scale = glm::length(d1) * glm::length(d2);
    if (!(std::abs(determinant) > 1e-9 * scale) || !(std::abs(determinant) > 1e-30)) {
        return {};
    }
    return {
        Vec3((d2.y * e1 - d1.y * e2) / determinant), Vec3((d1.x * e2 - d2.x * e1) / determinant),
        static_cast<float>(determinant)};
}

void generate_normals(MeshData& mesh, float crease_angle) {
    LIMN_CHECK(mesh.indices.size() % 3 == 0);
    const std::vector<Vec3> corner_normals = find_corner_normals(mesh, crease_angle);

    // A vertex keeps the normal of its first corner; corners with other normals get copies of it.
    // The copies of a vertex form a linked list, so that equal normals share a copy.
    mesh.normals.assign(mesh.positions.size(), Vec3(0, 1, 0));
    std::vector<bool> taken(mesh.positions.size(), false);
    std::vector<std::uint32_t> next_copy(mesh.positions.size(), kNoTangent);
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
        std::uint32_t vertex = mesh.indices[corner];
        const Vec3& normal = corner_normals[corner];
        if (!taken[vertex]) {
            taken[vertex] = true;
            mesh.normals[vertex] = normal;
            continue;
        }
        while (mesh.normals[vertex] != normal && next_copy[vertex] != kNoTangent) {
            vertex = next_copy[vertex];
        }
        if (mesh.normals[vertex] != normal) {
            const std::uint32_t copy = duplicate_vertex(mesh, vertex);
            mesh.normals[copy] = normal;
            taken.push_back(true);
            next_copy.push_back(kNoTangent);
            next_copy[vertex] = copy;
            vertex = copy;
        }
        mesh.indices[corner] = vertex;
    }
}

void generate_tangents(MeshData& mesh, int uv_set) {
    LIMN_CHECK(mesh.indices.size() % 3 == 0);
    LIMN_CHECK(mesh.normals.size() == mesh.positions.size());
    LIMN_CHECK((uv_set == 1 ? mesh.uvs1 : mesh.uvs).size() == mesh.positions.size());

    mesh.tangents.clear();
    const std::vector<TriangleFrame> frames =
        find_triangle_frames(mesh, uv_set == 1 ? mesh.uvs1 : mesh.uvs);
    const std::vector<std::int8_t> side = split_mirrored(mesh, frames);
    const std::vector<Vec2>& uvs = uv_set == 1 ? mesh.uvs1 : mesh.uvs;

    Welder<9> welder(mesh.positions.size());
    std::vector<std::uint32_t> group_of;
    group_of.reserve(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        const Vec3& n = mesh.normals[v];
        group_of.push_back(welder.number(
            {p.x, p.y, p.z, n.x, n.y, n.z, uvs[v].x, uvs[v].y, static_cast<float>(side[v])}));
    }

    std::vector<TangentDVec3> tangent_sum(welder.size(), TangentDVec3(0));
    std::vector<TangentDVec3> bitangent_sum(welder.size(), TangentDVec3(0));
    for (std::size_t t = 0; t < frames.size(); ++t) {
        if (frames[t].determinant == 0.0f) {
            continue;
        }
        TangentDVec3 p[3];
        get_corners(mesh, t, p);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.indices[3 * t + k];
            const TangentDVec3 n(mesh.normals[vertex]);
            const TangentDVec3 tangent(frames[t].tangent);
            const double angle = corner_angle(p, k);
            tangent_sum[group_of[vertex]] += angle * direction(tangent - n * glm::dot(n, tangent));
            bitangent_sum[group_of[vertex]] -= angle * direction(TangentDVec3(frames[t].bitangent));
        }
    }

    mesh.tangents.reserve(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3 n = mesh.normals[v];
        const TangentDVec3 sum = tangent_sum[group_of[v]];
        const Vec3 tangent = normalize_or(
            Vec3(direction(sum - TangentDVec3(n) * glm::dot(TangentDVec3(n), sum))),
            any_perpendicular(n));
        const bool left =
            glm::dot(TangentDVec3(glm::cross(n, tangent)), bitangent_sum[group_of[v]]) < 0;
        mesh.tangents.emplace_back(tangent, left ? -1.0f : 1.0f);
    }
}

void generate_morph_normals(MeshData& mesh) {
    LIMN_CHECK(mesh.normals.size() == mesh.positions.size());
    if (mesh.morphs.empty()) {
        return;
    }
    const SmoothGroups groups(mesh);
    for (MorphTarget& morph : mesh.morphs) {
        if (morph.normals.empty()) {
            generate_normals_of(morph, mesh, groups);
        }
    }
}

void generate_morph_tangents(MeshData& mesh) {
    LIMN_CHECK(mesh.tangents.size() == mesh.positions.size());
    for (MorphTarget& morph : mesh.morphs) {
        if (morph.normals.empty() || !morph.tangents.empty()) {
            continue;
        }
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            const std::uint32_t v = morph.vertices[i];
            const Vec3 tangent(mesh.tangents[v]);
            const Vec3 normal = normalize_or(mesh.normals[v] + morph.normals[i], mesh.normals[v]);
            const Vec3 turned = normalize_or(
                tangent - normal * glm::dot(normal, tangent), any_perpendicular(normal));
            morph.tangents.push_back(turned - tangent);
        }
    }
}

void update_bounds(MeshData& mesh) {
    mesh.bounds = {};
    for (const Vec3& p : mesh.positions) {
        grow(mesh.bounds, p);
    }
}

}  // namespace limn
