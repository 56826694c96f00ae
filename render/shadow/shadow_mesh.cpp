#include "render/shadow/shadow_mesh.h"

#include "ecs/components/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <unordered_map>

// Techniques: shadow.closed-mesh, shadow.silhouette, shadow.vol-per-edge, shadow.vol-per-triangle

namespace limn {
namespace {

using DVec3 = glm::dvec3;

constexpr std::uint32_t kNowhere = ~0u;

/// Maps every position to the index of the first one within the tolerance.
class Welder {
  public:
    explicit Welder(const Bounds& bounds)
        : origin_(bounds.min),
          tolerance_(kWeldTolerance * std::max(glm::length(bounds.max - bounds.min), 1e-30f)) {}

    std::uint32_t weld(const Vec3& p, std::vector<Vec3>& positions) {
        // Cells are two tolerances wide, so a neighbor lies in this cell or in one of the seven on
        // the nearer sides.
        const DVec3 scaled = DVec3(p - origin_) / (2.0 * static_cast<double>(tolerance_));
        const DVec3 cell = glm::floor(scaled);
        const DVec3 side = {
            scaled.x - cell.x < 0.5 ? -1.0 : 1.0, scaled.y - cell.y < 0.5 ? -1.0 : 1.0,
            scaled.z - cell.z < 0.5 ? -1.0 : 1.0};
        for (int i = 0; i < 8; ++i) {
            const DVec3 at = {
                cell.x + ((i & 1) != 0 ? side.x : 0), cell.y + ((i & 2) != 0 ? side.y : 0),
                cell.z + ((i & 4) != 0 ? side.z : 0)};
            const auto [begin, end] = cells_.equal_range(key_of(at));
            for (auto found = begin; found != end; ++found) {
                if (glm::distance(positions[found->second], p) <= tolerance_) {
                    return found->second;
                }
            }
        }
        const auto index = static_cast<std::uint32_t>(positions.size());
        positions.push_back(p);
        cells_.emplace(key_of(cell), index);
        return index;
    }

  private:
    /// Cell coordinates are -1 .. 2^20 - 1.
    static std::uint64_t key_of(const DVec3& cell) {
        const auto part = [](double x) { return static_cast<std::uint64_t>(x + 1.0) & 0x1fffff; };
        return part(cell.x) | part(cell.y) << 21 | part(cell.z) << 42;
    }

    Vec3 origin_;
    float tolerance_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> cells_;
};

Vec4 plane_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    const DVec3 origin = a;
    const DVec3 normal = glm::cross(DVec3(b) - origin, DVec3(c) - origin);
    const double length = glm::length(normal);
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a), 1e-30f});
    if (!(length > 1e-9 * longest * longest)) {
        return Vec4(0);  // collinear: faces no light
    }
    const DVec3 n = normal / length;
    return {n, -glm::dot(n, origin)};
}

void weld_triangles(const MeshData& mesh, ShadowMesh& made) {
    Bounds bounds;
    for (const Vec3& p : mesh.positions) {
        if (is_finite(p)) {
            grow(bounds, p);
        }
    }
    Welder welder(bounds);
    std::vector<std::uint32_t> welded(mesh.positions.size(), kNowhere);
    for (std::size_t i = 0; i < welded.size(); ++i) {
        if (is_finite(mesh.positions[i])) {
            welded[i] = welder.weld(mesh.positions[i], made.positions);
        }
    }
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t* corner = &mesh.indices[i];
        if (std::max({corner[0], corner[1], corner[2]}) >= welded.size()) {
            continue;
        }
        const std::array<std::uint32_t, 3> t = {
            welded[corner[0]], welded[corner[1]], welded[corner[2]]};
        if (std::max({t[0], t[1], t[2]}) == kNowhere) {
            continue;
        }
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
            ++made.report.removed;
            continue;
        }
        made.triangles.push_back(t);
        made.planes.push_back(
            plane_of(made.positions[t[0]], made.positions[t[1]], made.positions[t[2]]));
    }
    made.report.triangles = static_cast<int>(made.triangles.size());
}

int count_duplicates(const ShadowMesh& mesh) {
    std::vector<std::array<std::uint32_t, 3>> sorted = mesh.triangles;
    for (std::array<std::uint32_t, 3>& t : sorted) {
        std::sort(t.begin(), t.end());
    }
    std::sort(sorted.begin(), sorted.end());
    int count = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        count += sorted[i] == sorted[i - 1] ? 1 : 0;
    }
    return count;
}

/// One side of a triangle; sorting groups the sides of each edge.
struct Side {
    std::uint64_t edge;  // the smaller vertex in the high bits, the larger in the low bits
    std::uint32_t triangle;
    bool rising;  // runs from the smaller vertex to the larger
};

void find_edges(ShadowMesh& mesh) {
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t from = mesh.triangles[t][k];
            const std::uint64_t to = mesh.triangles[t][(k + 1) % 3];
            sides.push_back(
                {std::min(from, to) << 32 | std::max(from, to), static_cast<std::uint32_t>(t),
                 from < to});
        }
    }
    std::stable_sort(
        sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].edge == sides[i].edge) {
            ++end;
        }
        if (end - i == 1) {
            ++mesh.report.open_edges;
        } else if (end - i > 2) {
            ++mesh.report.crowded_edges;
        } else if (sides[i].rising == sides[i + 1].rising) {
            ++mesh.report.inconsistent_edges;
        } else {
            const Side& up = sides[i].rising ? sides[i] : sides[i + 1];
            const Side& down = sides[i].rising ? sides[i + 1] : sides[i];
            mesh.edges.push_back(
                {static_cast<std::uint32_t>(sides[i].edge >> 32),
                 static_cast<std::uint32_t>(sides[i].edge), up.triangle, down.triangle});
        }
        i = end;
    }
}

/// Corner of the triangle at the position.
std::uint32_t corner_of(const ShadowMesh& mesh, std::uint32_t triangle, std::uint32_t position) {
    const std::array<std::uint32_t, 3>& t = mesh.triangles[triangle];
    const auto k = static_cast<std::uint32_t>(t[0] == position ? 0 : t[1] == position ? 1 : 2);
    return 3 * triangle + k;
}

void append_count(std::string& text, int count, const char* one, const char* many) {
    if (count > 0) {
        text += text.empty() ? "" : ", ";
        text += std::to_string(count) + " " + (count == 1 ? one : many);
    }
}

}  // namespace

bool is_closed(const ManifoldReport& report) {
    return report.triangles > 0 && report.open_edges == 0 && report.crowded_edges == 0
           && report.inconsistent_edges == 0;
}

std::string describe(const ManifoldReport& report) {
    std::string text;
    append_count(text, report.open_edges, "open edge", "open edges");
    append_count(
        text, report.crowded_edges, "edge with more than two triangles",
        "edges with more than two triangles");
    append_count(
        text, report.inconsistent_edges, "edge between triangles that face opposite ways",
        "edges between triangles that face opposite ways");
    append_count(text, report.duplicated, "duplicate triangle", "duplicate triangles");
    if (text.empty()) {
        text = report.triangles > 0 ? "closed" : "no triangles";
    }
    return text;
}

ShadowMesh make_shadow_mesh(const MeshData& mesh) {
    ShadowMesh made;
    weld_triangles(mesh, made);
    made.report.duplicated = count_duplicates(made);
    find_edges(made);
    if (!is_closed(made.report)) {
        made.edges.clear();
    }
    return made;
}

std::vector<SilhouetteEdge> find_silhouette(const ShadowMesh& mesh, const Vec4& light) {
    std::vector<SilhouetteEdge> silhouette;
    for (const ShadowEdge& edge : mesh.edges) {
        const bool along = faces_light(mesh.planes[edge.along], light);
        const bool against = faces_light(mesh.planes[edge.against], light);
        if (along != against) {
            silhouette.push_back(
                along ? SilhouetteEdge{edge.begin, edge.end}
                      : SilhouetteEdge{edge.end, edge.begin});
        }
    }
    return silhouette;
}

VolumeGeometry make_edge_volume(const ShadowMesh& mesh) {
    VolumeGeometry volume;
    volume.vertices.reserve(3 * mesh.triangles.size());
    volume.indices.reserve(3 * mesh.triangles.size() + 6 * mesh.edges.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t position : mesh.triangles[t]) {
            volume.indices.push_back(static_cast<std::uint32_t>(volume.vertices.size()));
            volume.vertices.push_back({Vec4(mesh.positions[position], 0), mesh.planes[t]});
        }
    }
    volume.cap_indices = static_cast<std::uint32_t>(volume.indices.size());
    for (const ShadowEdge& edge : mesh.edges) {
        // Starting with the triangle that traverses it backward, the quad faces outward whichever
        // of the two is extruded.
        const std::uint32_t a = corner_of(mesh, edge.against, edge.begin);
        const std::uint32_t b = corner_of(mesh, edge.against, edge.end);
        const std::uint32_t c = corner_of(mesh, edge.along, edge.end);
        const std::uint32_t d = corner_of(mesh, edge.along, edge.begin);
        volume.indices.insert(volume.indices.end(), {a, b, c, a, c, d});
    }
    return volume;
}

VolumeGeometry make_triangle_volume(const ShadowMesh& mesh) {
    // Corners 0 1 2 of the near cap and 3 4 5 of the far cap.
    constexpr std::array<std::uint32_t, 6> kCaps = {0, 1, 2, 5, 4, 3};
    constexpr std::array<std::uint32_t, 18> kSides = {0, 3, 4, 0, 4, 1, 1, 4, 5,
                                                      1, 5, 2, 2, 5, 3, 2, 3, 0};
    VolumeGeometry volume;
    const std::size_t sides = is_closed(mesh.report) ? 1 : 2;
    volume.vertices.reserve(6 * sides * mesh.triangles.size());
    volume.indices.reserve(24 * sides * mesh.triangles.size());
    for (std::size_t i = 0; i < sides * mesh.triangles.size(); ++i) {
        const std::size_t t = i / sides;
        const bool back = i % sides == 1;
        const std::array<std::uint32_t, 3>& corners = mesh.triangles[t];
        for (int far = 0; far < 2; ++far) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t position = corners[back ? 2 - k : k];
                volume.vertices.push_back(
                    {Vec4(mesh.positions[position], far), back ? -mesh.planes[t] : mesh.planes[t]});
            }
        }
    }
    const auto append = [&](std::uint32_t first, const auto& pattern) {
        for (const std::uint32_t corner : pattern) {
            volume.indices.push_back(first + corner);
        }
    };
    const auto count = static_cast<std::uint32_t>(volume.vertices.size());
    for (std::uint32_t first = 0; first < count; first += 6) {
        append(first, kCaps);
    }
    volume.cap_indices = static_cast<std::uint32_t>(volume.indices.size());
    for (std::uint32_t first = 0; first < count; first += 6) {
        append(first, kSides);
    }
    return volume;
}

}  // namespace limn
