#include "content/make/head/face_chart.h"

#include "content/make/head/head.h"
#include "ecs/base/jobs.h"
#include "ecs/base/triangle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace limn {

namespace {

constexpr float kCentimeters = 100;  ///< per meter
constexpr std::size_t kGrain = 64;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Triangles at each vertex.
std::vector<std::vector<std::uint32_t>> triangles_around(const MeshData& mesh) {
    std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());
    for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner) {
        around[mesh.indices[corner]].push_back(corner / 3);
    }
    return around;
}

/// The skin at rest [cm].
class Chart {
  public:
    Chart() : head_(make_head({})), around_(triangles_around(head_)) {
        for (Vec3& p : head_.positions) {
            p *= kCentimeters;
        }
    }

    /// The texture coordinates on the nearest triangle at the nearest vertex.
    [[nodiscard]] Vec2 at(const Vec3& p) const {
        Vec2 uv = {0, 0};
        float nearest = kInfinite;
        for (const std::uint32_t triangle : around_[nearest_vertex(p)]) {
            const std::uint32_t* const v = &head_.indices[std::size_t{3} * triangle];
            const Vec3& a = head_.positions[v[0]];
            const Vec3& b = head_.positions[v[1]];
            const Vec3& c = head_.positions[v[2]];
            const Vec3 q = nearest_on_triangle(p, a, b, c);
            const float area = glm::length(glm::cross(b - a, c - a));
            if (area > 0 && glm::distance(p, q) < nearest) {
                nearest = glm::distance(p, q);
                const float of_b = glm::length(glm::cross(q - a, c - a)) / area;
                const float of_c = glm::length(glm::cross(b - a, q - a)) / area;
                uv = head_.uvs[v[0]] + of_b * (head_.uvs[v[1]] - head_.uvs[v[0]])
                     + of_c * (head_.uvs[v[2]] - head_.uvs[v[0]]);
            }
        }
        return uv;
    }

  private:
    [[nodiscard]] std::size_t nearest_vertex(const Vec3& p) const {
        std::size_t nearest = 0;
        float least_distance2 = kInfinite;
        for (std::size_t v = 0; v < head_.positions.size(); ++v) {
            const Vec3 offset = head_.positions[v] - p;
            if (glm::dot(offset, offset) < least_distance2) {
                least_distance2 = glm::dot(offset, offset);
                nearest = v;
            }
        }
        return nearest;
    }

    MeshData head_;
    std::vector<std::vector<std::uint32_t>> around_;
};

}  // namespace

std::vector<Vec2> make_face_chart(std::span<const Vec3> reference) {
    const Chart chart;
    std::vector<Vec2> uvs(reference.size(), Vec2{0, 0});
    parallel_for(uvs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (is_finite(reference[i])) {
                uvs[i] = chart.at(reference[i]);
            }
        }
    });
    return uvs;
}

}  // namespace limn
