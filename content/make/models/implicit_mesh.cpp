#include "content/make/models/implicit_mesh.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace limn {

namespace {

constexpr std::uint32_t kNoVertex = 0xffffffffu;
constexpr int kBlock = 6;  ///< samples along the side of a block that may be skipped

/// Samples of the function at the corners of the cells.
class Samples {
  public:
    Samples(const SignedDistance& distance, const ImplicitGrid& grid) : grid_(grid) {
        const Vec3 size = (grid.box.max - grid.box.min) / grid.cell;
        for (int axis = 0; axis < 3; ++axis) {
            count_[axis] = static_cast<int>(std::ceil(size[axis])) + 1;
        }
        values_.resize(
            static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y)
            * static_cast<std::size_t>(count_.z));
        const IVec3 blocks = (count_ + (kBlock - 1)) / kBlock;
        parallel_for(static_cast<std::size_t>(blocks.z), 1, [&](std::size_t begin, std::size_t) {
            const int z = static_cast<int>(begin);
            for (int y = 0; y < blocks.y; ++y) {
                for (int x = 0; x < blocks.x; ++x) {
                    fill_block(distance, kBlock * IVec3(x, y, z));
                }
            }
        });
    }

    [[nodiscard]] IVec3 count() const { return count_; }
    [[nodiscard]] std::size_t index(const IVec3& at) const {
        return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(count_.y)
                + static_cast<std::size_t>(at.y))
                   * static_cast<std::size_t>(count_.x)
               + static_cast<std::size_t>(at.x);
    }
    [[nodiscard]] float value(const IVec3& at) const { return values_[index(at)]; }
    [[nodiscard]] Vec3 position(const IVec3& at) const {
        return grid_.box.min + grid_.cell * Vec3(at);
    }

  private:
    void fill_block(const SignedDistance& distance, const IVec3& first) {
        const IVec3 end = glm::min(first + kBlock, count_);
        const Vec3 center = 0.5f * (position(first) + position(end - 1));
        const float radius = 0.5f * glm::length(position(end - 1) - position(first)) + grid_.cell;
        const float around = distance(center);
        // The block does not contain the surface. Only blocks outside are skipped, since inside the
        // distance may be too large.
        const bool is_far = around > 1.05f * radius;
        for (int z = first.z; z < end.z; ++z) {
            for (int y = first.y; y < end.y; ++y) {
                for (int x = first.x; x < end.x; ++x) {
                    const IVec3 at(x, y, z);
                    values_[index(at)] = is_far ? around : distance(position(at));
                }
            }
        }
    }

    ImplicitGrid grid_;
    IVec3 count_ = {0, 0, 0};
    std::vector<float> values_;
};

/// Mean of the points where the surface crosses the edges of a cell; false if it does not.
bool find_vertex(const Samples& samples, const IVec3& cell, Vec3& vertex) {
    std::array<float, 8> values{};
    int inside = 0;
    for (int i = 0; i < 8; ++i) {
        values[i] = samples.value(cell + IVec3(i & 1, (i >> 1) & 1, i >> 2));
        inside += values[i] < 0.0f ? 1 : 0;
    }
    if (inside == 0 || inside == 8) {
        return false;
    }
    Vec3 sum(0);
    float crossings = 0;
    for (int i = 0; i < 8; ++i) {
        for (const int bit : {1, 2, 4}) {
            const int j = i | bit;
            if (j == i || (values[i] < 0.0f) == (values[j] < 0.0f)) {
                continue;
            }
            const float fraction = values[i] / (values[i] - values[j]);
            const Vec3 a(i & 1, (i >> 1) & 1, i >> 2);
            const Vec3 b(j & 1, (j >> 1) & 1, j >> 2);
            sum += glm::mix(a, b, fraction);
            crossings += 1.0f;
        }
    }
    const Vec3 low = samples.position(cell);
    const Vec3 high = samples.position(cell + 1);
    vertex = glm::mix(low, high, sum / crossings);
    return true;
}

/// A quad around every edge of the grid that the surface crosses.
void add_faces(
    const Samples& samples, const std::vector<std::uint32_t>& vertex_of, ImplicitMesh& mesh) {
    const IVec3 count = samples.count();
    for (int z = 1; z + 1 < count.z; ++z) {
        for (int y = 1; y + 1 < count.y; ++y) {
            for (int x = 1; x + 1 < count.x; ++x) {
                const IVec3 at(x, y, z);
                const bool inside = samples.value(at) < 0.0f;
                for (int axis = 0; axis < 3; ++axis) {
                    IVec3 next = at;
                    ++next[axis];
                    if (inside == (samples.value(next) < 0.0f)) {
                        continue;
                    }
                    IVec3 u(0);
                    IVec3 v(0);
                    u[(axis + 1) % 3] = 1;
                    v[(axis + 2) % 3] = 1;
                    std::array<std::uint32_t, 4> quad = {
                        vertex_of[samples.index(at - u - v)], vertex_of[samples.index(at - v)],
                        vertex_of[samples.index(at)], vertex_of[samples.index(at - u)]};
                    if (!inside) {
                        std::swap(quad[1], quad[3]);
                    }
                    const auto& p = mesh.positions;
                    const bool other = glm::distance(p[quad[1]], p[quad[3]])
                                       < glm::distance(p[quad[0]], p[quad[2]]);
                    const int s = other ? 1 : 0;
                    for (const int k : {0, 1, 2, 0, 2, 3}) {
                        mesh.indices.push_back(quad[(k + s) % 4]);
                    }
                }
            }
        }
    }
}

/// Projects `p` onto the surface along the gradient.
Vec3 project_to_surface(const SignedDistance& distance, Vec3 p, float cell) {
    for (int i = 0; i < 2; ++i) {
        const float step = 0.1f * cell;
        const Vec3 slope(
            distance(p + Vec3(step, 0, 0)) - distance(p - Vec3(step, 0, 0)),
            distance(p + Vec3(0, step, 0)) - distance(p - Vec3(0, step, 0)),
            distance(p + Vec3(0, 0, step)) - distance(p - Vec3(0, 0, step)));
        const Vec3 gradient = slope / (2.0f * step);
        const float length2 = glm::dot(gradient, gradient);
        if (length2 < 1e-3f) {
            break;
        }
        const Vec3 move = gradient * (distance(p) / length2);
        p -= move * std::min(1.0f, 0.5f * cell / std::max(glm::length(move), 1e-12f));
    }
    return p;
}

}  // namespace

void relax_on_surface(ImplicitMesh& mesh, const SignedDistance& distance, float cell, int rounds) {
    const std::size_t count = mesh.positions.size();
    for (int round = 0; round < rounds; ++round) {
        std::vector<Vec3> sums(count, Vec3(0));
        std::vector<float> neighbors(count, 0.0f);
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            const std::uint32_t a = mesh.indices[i];
            const std::uint32_t b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
            sums[a] += mesh.positions[b];
            neighbors[a] += 1.0f;
        }
        parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                const Vec3 centroid =
                    neighbors[v] > 0.0f ? sums[v] / neighbors[v] : mesh.positions[v];
                mesh.positions[v] =
                    project_to_surface(distance, glm::mix(mesh.positions[v], centroid, 0.5f), cell);
            }
        });
    }
}

Vec3 surface_normal(const SignedDistance& distance, const Vec3& p, float step) {
    const Vec3 slope(
        distance(p + Vec3(step, 0, 0)) - distance(p - Vec3(step, 0, 0)),
        distance(p + Vec3(0, step, 0)) - distance(p - Vec3(0, step, 0)),
        distance(p + Vec3(0, 0, step)) - distance(p - Vec3(0, 0, step)));
    return normalize_or(slope, Vec3(0, 1, 0));
}

ImplicitMesh mesh_surface(const SignedDistance& distance, const ImplicitGrid& grid) {
    LIMN_CHECK(grid.cell > 0.0f && !is_empty(grid.box));
    const Samples samples(distance, grid);
    const IVec3 count = samples.count();
    ImplicitMesh mesh;
    std::vector<std::uint32_t> vertex_of(
        static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y)
            * static_cast<std::size_t>(count.z),
        kNoVertex);
    for (int z = 0; z + 1 < count.z; ++z) {
        for (int y = 0; y + 1 < count.y; ++y) {
            for (int x = 0; x + 1 < count.x; ++x) {
                Vec3 vertex;
                if (find_vertex(samples, {x, y, z}, vertex)) {
                    vertex_of[samples.index({x, y, z})] =
                        static_cast<std::uint32_t>(mesh.positions.size());
                    mesh.positions.push_back(vertex);
                }
            }
        }
    }
    add_faces(samples, vertex_of, mesh);
    relax_on_surface(mesh, distance, grid.cell, grid.relaxations);
    mesh.normals.resize(mesh.positions.size());
    parallel_for(mesh.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            mesh.normals[v] = surface_normal(distance, mesh.positions[v], 0.25f * grid.cell);
        }
    });
    return mesh;
}

}  // namespace limn
