#include "content/bake/surface_fit.h"

#include "ecs/base/check.h"
#include "ecs/base/triangle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

// Techniques: face.retarget-fit, face.retarget-warp

namespace limn {
namespace {

using DVec3 = glm::dvec3;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr int kMaxSteps = 200;        ///< of conjugate gradients
constexpr double kTolerance = 1e-20;  ///< of the squared residual, relative to its start
constexpr double kSettled = 1e-9;     ///< relative change of the energy that ends the iteration

double length2(const std::vector<DVec3>& vectors) {
    double sum = 0;
    for (const DVec3& v : vectors) {
        sum += glm::dot(v, v);
    }
    return sum;
}

/// The edges and neighbors of a triangle mesh.
struct Net {
    std::vector<Edge> edges;
    std::vector<std::vector<std::uint32_t>> neighbors;  ///< of each vertex

    Net(std::size_t vertices, std::span<const std::uint32_t> indices) : neighbors(vertices) {
        std::set<Edge> found;
        for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = indices[i + k];
                const std::uint32_t b = indices[i + (k + 1) % 3];
                if (a != b) {
                    found.insert({std::min(a, b), std::max(a, b)});
                }
            }
        }
        edges.assign(found.begin(), found.end());
        for (const auto& [a, b] : edges) {
            neighbors[a].push_back(b);
            neighbors[b].push_back(a);
        }
    }

    /// Vertices minus the means of their neighbors.
    [[nodiscard]] std::vector<DVec3> laplacian(const std::vector<DVec3>& p) const {
        std::vector<DVec3> result(p.size(), DVec3(0));
        for (std::size_t v = 0; v < p.size(); ++v) {
            for (const std::uint32_t n : neighbors[v]) {
                result[v] += (p[v] - p[n]) / static_cast<double>(neighbors[v].size());
            }
        }
        return result;
    }
    [[nodiscard]] std::vector<DVec3> transposed_laplacian(const std::vector<DVec3>& p) const {
        std::vector<DVec3> result(p.size(), DVec3(0));
        for (std::size_t v = 0; v < p.size(); ++v) {
            for (const std::uint32_t n : neighbors[v]) {
                const DVec3 part = p[v] / static_cast<double>(neighbors[v].size());
                result[v] += part;
                result[n] -= part;
            }
        }
        return result;
    }
};

/// The energy of displacements `d` from the warped vertices, towards `goals`.
struct Energy {
    const Net& net;
    const FitWeights& weights;
    std::vector<DVec3> goals;  ///< displacements to the nearest points

    [[nodiscard]] double of(const std::vector<DVec3>& d) const {
        double strain = 0;
        for (const auto& [a, b] : net.edges) {
            strain += glm::dot(d[a] - d[b], d[a] - d[b]);
        }
        double distance = 0;
        for (std::size_t v = 0; v < d.size(); ++v) {
            distance += glm::dot(d[v] - goals[v], d[v] - goals[v]);
        }
        return static_cast<double>(weights.strain) * strain
               + static_cast<double>(weights.bending) * length2(net.laplacian(d))
               + static_cast<double>(weights.distance) * distance;
    }
    /// Half of its gradient, without the goals' term.
    [[nodiscard]] std::vector<DVec3> apply(const std::vector<DVec3>& d) const {
        std::vector<DVec3> result = net.transposed_laplacian(net.laplacian(d));
        for (std::size_t v = 0; v < d.size(); ++v) {
            result[v] = static_cast<double>(weights.bending) * result[v]
                        + static_cast<double>(weights.distance) * d[v];
        }
        for (const auto& [a, b] : net.edges) {
            const DVec3 pull = static_cast<double>(weights.strain) * (d[a] - d[b]);
            result[a] += pull;
            result[b] -= pull;
        }
        return result;
    }
    /// Moves `d` to the minimum.
    void minimize(std::vector<DVec3>& d) const {
        std::vector<DVec3> residual = apply(d);
        for (std::size_t v = 0; v < d.size(); ++v) {
            residual[v] = static_cast<double>(weights.distance) * goals[v] - residual[v];
        }
        std::vector<DVec3> direction = residual;
        double size = length2(residual);
        const double end = kTolerance * size;
        for (int i = 0; i < kMaxSteps && size > end; ++i) {
            const std::vector<DVec3> bent = apply(direction);
            double curvature = 0;
            for (std::size_t v = 0; v < d.size(); ++v) {
                curvature += glm::dot(direction[v], bent[v]);
            }
            if (!(curvature > 0)) {
                return;
            }
            const double step = size / curvature;
            for (std::size_t v = 0; v < d.size(); ++v) {
                d[v] += step * direction[v];
                residual[v] -= step * bent[v];
            }
            const double next = length2(residual);
            for (std::size_t v = 0; v < d.size(); ++v) {
                direction[v] = residual[v] + (next / size) * direction[v];
            }
            size = next;
        }
    }
};

class NearestPoints {
  public:
    NearestPoints(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
        for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
            Face face{
                {positions[indices[i]], positions[indices[i + 1]], positions[indices[i + 2]]},
                Vec3(0),
                0.0f};
            face.center = (face.corner[0] + face.corner[1] + face.corner[2]) / 3.0f;
            for (const Vec3& corner : face.corner) {
                face.radius = std::max(face.radius, glm::distance(face.center, corner));
            }
            faces_.push_back(face);
        }
    }
    [[nodiscard]] Vec3 find(const Vec3& p) const {
        Vec3 best = faces_[0].corner[0];
        float nearest = glm::distance(p, best);
        for (const Face& face : faces_) {
            if (glm::distance(p, face.center) - face.radius < nearest) {
                const Vec3 on =
                    nearest_on_triangle(p, face.corner[0], face.corner[1], face.corner[2]);
                const float distance = glm::distance(p, on);
                if (distance < nearest) {
                    nearest = distance;
                    best = on;
                }
            }
        }
        return best;
    }

  private:
    struct Face {
        Vec3 corner[3];
        Vec3 center;
        float radius;
    };
    std::vector<Face> faces_;
};

}  // namespace

SurfaceFit fit_surface(
    std::span<const Vec3> warped, std::span<const std::uint32_t> indices,
    std::span<const Vec3> target, std::span<const std::uint32_t> target_indices,
    const FitWeights& weights, int iterations) {
    LIMN_CHECK(target_indices.size() >= 3);
    const Net net(warped.size(), indices);
    const NearestPoints nearest(target, target_indices);
    Energy energy{net, weights, std::vector<DVec3>(warped.size())};
    std::vector<DVec3> moved(warped.size(), DVec3(0));
    const auto position = [&](std::size_t v) { return Vec3(DVec3(warped[v]) + moved[v]); };
    const auto find_goals = [&] {
        for (std::size_t v = 0; v < warped.size(); ++v) {
            energy.goals[v] = DVec3(nearest.find(position(v))) - DVec3(warped[v]);
        }
    };
    find_goals();
    SurfaceFit fit;
    fit.energies.push_back(energy.of(moved));
    for (int i = 0; i < iterations; ++i) {
        energy.minimize(moved);
        find_goals();
        const double last = fit.energies.back();
        fit.energies.push_back(energy.of(moved));
        if (last - fit.energies.back() <= kSettled * last) {
            break;
        }
    }
    for (std::size_t v = 0; v < warped.size(); ++v) {
        fit.positions.push_back(position(v));
    }
    return fit;
}

std::vector<std::uint32_t>
label_vertices(std::span<const Vec3> points, std::span<const Vec3> vertices) {
    LIMN_CHECK(!vertices.empty());
    std::vector<std::uint32_t> labels;
    for (const Vec3& p : points) {
        const auto nearest =
            std::min_element(vertices.begin(), vertices.end(), [&](const Vec3& a, const Vec3& b) {
                return glm::distance(a, p) < glm::distance(b, p);
            });
        labels.push_back(static_cast<std::uint32_t>(nearest - vertices.begin()));
    }
    return labels;
}

Vec3 warp_offset(const PointWarp& warp, const Vec3& rest, const Vec3& offset, float gain) {
    return gain * (warp_point(warp, rest + offset) - warp_point(warp, rest));
}

}  // namespace limn
