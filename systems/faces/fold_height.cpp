#include "systems/faces/fold_height.h"

#include "ecs/components/weld.h"
#include "systems/faces/wrinkle_fold.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

// Techniques: wrinkle.displacement
// Source of wrinkle.displacement: Cerda and Mahadevan 2003

namespace limn {

namespace {

constexpr double kAnchor = 1e-4;         ///< pull of all heights to 0, relative to one edge
constexpr int kMaxSamples = 64;          ///< of the map along an edge
constexpr int kMaxIterations = 2000;     ///< of conjugate gradients
constexpr double kPrecision = 1e-6;      ///< of the residual
constexpr float kSameNormal = 0.9f;      ///< cosine
constexpr float kMinFoldHeight = 1e-6f;  ///< [m]; less counts as none
constexpr float kNoneCarried = 0.45f;    ///< slope energy kept by edges of half a wavelength
constexpr float kAllCarried = 0.8f;      ///< and of a quarter wavelength
constexpr float kFarthest = 1e8f;        ///< position on the map [texels]
constexpr int kCarryRings = 2;           ///< of neighbors over which the energy is summed

/// Slopes of both layers, sampled as a texture unit does.
class SlopeMap {
  public:
    SlopeMap(const ImageData& map, const TextureSlot& slot, bool layers)
        : width_(map.width), height_(map.height), slot_(slot), layers_(layers ? 2 : 1),
          slopes_(layers ? layered_slopes(map) : wrinkle_slopes(map)) {
        // Counter-clockwise, as material_maps.cpp has it.
        const float c = std::cos(slot.rotation);
        const float s = std::sin(slot.rotation);
        u_row_ = {c * slot.scale.x, s * slot.scale.y};
        v_row_ = {-s * slot.scale.x, c * slot.scale.y};
        const auto texels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
        if (slopes_.size() < layers_ * texels) {
            slopes_.clear();
        }
    }

    [[nodiscard]] bool empty() const { return slopes_.empty(); }

    /// In texels, from the center of the first one.
    [[nodiscard]] Vec2 texel_position(const Vec2& uv) const {
        const Vec2 moved = Vec2(glm::dot(u_row_, uv), glm::dot(v_row_, uv)) + slot_.offset;
        return moved * Vec2(width_, height_) - 0.5f;
    }

    /// The slopes of the first and the second layer, bilinearly filtered.
    [[nodiscard]] Vec4 at(const Vec2& position) const {
        const Vec2 low = glm::floor(position);
        const Vec2 t = position - low;
        const auto x = static_cast<int>(low.x);
        const auto y = static_cast<int>(low.y);
        return glm::mix(
            glm::mix(texel(x, y), texel(x + 1, y), t.x),
            glm::mix(texel(x, y + 1), texel(x + 1, y + 1), t.x), t.y);
    }

  private:
    static int wrap(int i, int count, Wrap wrap) {
        if (wrap == Wrap::Clamp) {
            return std::clamp(i, 0, count - 1);
        }
        const int period = wrap == Wrap::Mirror ? 2 * count : count;
        const int at = (i % period + period) % period;
        return at < count ? at : period - 1 - at;
    }

    [[nodiscard]] Vec4 texel(int x, int y) const {
        const auto column = static_cast<std::size_t>(wrap(x, width_, slot_.wrap_u));
        const auto row = static_cast<std::size_t>(wrap(y, height_, slot_.wrap_v));
        const std::size_t i = layers_ * (row * static_cast<std::size_t>(width_) + column);
        return {slopes_[i], layers_ == 2 ? slopes_[i + 1] : Vec2(0)};
    }

    int width_;
    int height_;
    TextureSlot slot_;
    std::size_t layers_;
    std::vector<Vec2> slopes_;
    Vec2 u_row_ = {1, 0};
    Vec2 v_row_ = {0, 1};
};

/// An edge between two positions, each given by its first vertex; a < b.
struct FoldEdge {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    glm::dvec2 rise = {0, 0};    ///< height difference from a to b, of both layers [m]
    glm::dvec2 energy = {0, 0};  ///< mean square of the local slope times its length [m^2]
    int count = 1;               ///< number of triangle edges that are averaged
};

/// The height by which the map rises along an edge of a triangle, from vertex `a` to `b`.
FoldEdge rise_along(
    const MeshData& mesh, std::span<const Vec2> uvs, const SlopeMap& map, std::uint32_t a,
    std::uint32_t b) {
    const Vec3 edge_vector = mesh.positions[b] - mesh.positions[a];
    const Vec2 from = map.texel_position(uvs[a]);
    const Vec2 to = map.texel_position(uvs[b]);
    const float texels = glm::length(to - from);
    FoldEdge edge;
    if (!(texels < kFarthest && glm::length(from) < kFarthest) || !is_finite(edge_vector)) {
        return edge;
    }
    const int samples = std::clamp(static_cast<int>(std::ceil(texels)), 4, kMaxSamples);
    for (int i = 0; i < samples; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(samples);
        const Vec3 normal = glm::mix(mesh.normals[a], mesh.normals[b], t);
        const Vec3 tangent = glm::mix(Vec3(mesh.tangents[a]), Vec3(mesh.tangents[b]), t);
        const Vec3 bitangent = mesh.tangents[a].w * glm::cross(normal, tangent);
        const Vec2 along = {glm::dot(tangent, edge_vector), glm::dot(bitangent, edge_vector)};
        const Vec4 slopes = map.at(glm::mix(from, to, t));
        const glm::dvec2 rise = {
            glm::dot(Vec2(slopes), along), glm::dot(Vec2(slopes.z, slopes.w), along)};
        edge.rise += rise / static_cast<double>(samples);
        edge.energy += rise * rise / static_cast<double>(samples);
    }
    return edge;
}

/// One edge for each pair of positions that a triangle joins, sorted by them.
std::vector<FoldEdge> find_edges(
    const MeshData& mesh, std::span<const Vec2> uvs, const SlopeMap& map,
    std::span<const std::uint32_t> welded) {
    std::vector<FoldEdge> all;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::uint32_t* const v = &mesh.indices[t];
        for (std::size_t k = 0; k < 3 && std::max({v[0], v[1], v[2]}) < welded.size(); ++k) {
            std::uint32_t a = v[k];
            std::uint32_t b = v[(k + 1) % 3];
            if (welded[a] == welded[b]) {
                continue;
            }
            if (welded[a] > welded[b]) {
                std::swap(a, b);
            }
            FoldEdge edge = rise_along(mesh, uvs, map, a, b);
            edge.a = welded[a];
            edge.b = welded[b];
            all.push_back(edge);
        }
    }
    std::ranges::stable_sort(all, {}, [](const FoldEdge& e) { return std::pair(e.a, e.b); });
    std::vector<FoldEdge> edges;
    for (const FoldEdge& edge : all) {
        if (!edges.empty() && edges.back().a == edge.a && edges.back().b == edge.b) {
            edges.back().rise += edge.rise;
            edges.back().energy += edge.energy;
            ++edges.back().count;
        } else {
            edges.push_back(edge);
        }
    }
    for (FoldEdge& edge : edges) {
        edge.rise /= edge.count;
        edge.energy /= edge.count;
    }
    return edges;
}

/// The heights of a layer that fit its edges best, in the least-squares sense.
std::vector<double> solve(std::span<const FoldEdge> edges, int layer, std::size_t vertices) {
    // Conjugate gradients on (D^T D + anchor) h = D^T g, with D the differences along edges.
    const auto apply = [&](const std::vector<double>& h, std::vector<double>& out) {
        for (std::size_t v = 0; v < vertices; ++v) {
            out[v] = kAnchor * h[v];
        }
        for (const FoldEdge& edge : edges) {
            const double difference = h[edge.b] - h[edge.a];
            out[edge.a] -= difference;
            out[edge.b] += difference;
        }
    };
    std::vector<double> diagonal(vertices, kAnchor);
    std::vector<double> residual(vertices, 0.0);
    for (const FoldEdge& edge : edges) {
        diagonal[edge.a] += 1;
        diagonal[edge.b] += 1;
        residual[edge.a] -= edge.rise[layer];
        residual[edge.b] += edge.rise[layer];
    }
    std::vector<double> heights(vertices, 0.0);
    std::vector<double> step(vertices);
    std::vector<double> image(vertices);
    const auto precondition = [&] {
        double product = 0;
        for (std::size_t v = 0; v < vertices; ++v) {
            product += residual[v] * residual[v] / diagonal[v];
        }
        return product;
    };
    double now = precondition();
    const double enough = now * kPrecision * kPrecision;
    double ratio = 0;
    for (int i = 0; i < kMaxIterations && now > enough; ++i) {
        double curvature = 0;
        for (std::size_t v = 0; v < vertices; ++v) {
            step[v] = residual[v] / diagonal[v] + ratio * step[v];
        }
        apply(step, image);
        for (std::size_t v = 0; v < vertices; ++v) {
            curvature += step[v] * image[v];
        }
        const double length = now / curvature;
        for (std::size_t v = 0; v < vertices; ++v) {
            heights[v] += length * step[v];
            residual[v] -= length * image[v];
        }
        const double next = precondition();
        ratio = next / now;
        now = next;
    }
    return heights;
}

/// 0 .. 1 at each vertex: how much of the folds the mesh can represent, by the slope energy that
/// remains when each edge has its mean slope.
std::vector<float> find_carried(std::span<const FoldEdge> edges, int layer, std::size_t vertices) {
    std::vector<glm::dvec2> energy(vertices, glm::dvec2(0));  // remaining, total
    for (const FoldEdge& edge : edges) {
        const glm::dvec2 terms = {edge.rise[layer] * edge.rise[layer], edge.energy[layer]};
        energy[edge.a] += terms;
        energy[edge.b] += terms;
    }
    for (int ring = 0; ring < kCarryRings; ++ring) {
        const std::vector<glm::dvec2> before = energy;
        for (const FoldEdge& edge : edges) {
            energy[edge.a] += before[edge.b];
            energy[edge.b] += before[edge.a];
        }
    }
    std::vector<float> carried;
    carried.reserve(vertices);
    for (const glm::dvec2& terms : energy) {
        const float kept = terms.y > 0 ? static_cast<float>(terms.x / terms.y) : 0.0f;
        carried.push_back(glm::smoothstep(kNoneCarried, kAllCarried, kept));
    }
    return carried;
}

}  // namespace

std::vector<Vec2>
fold_heights(const MeshData& mesh, const ImageData& map, const TextureSlot& slot, bool layers) {
    const std::size_t vertices = mesh.positions.size();
    const std::vector<Vec2>& uvs =
        slot.uv_set == 1 && mesh.uvs1.size() == vertices ? mesh.uvs1 : mesh.uvs;
    const SlopeMap slopes(map, slot, layers);
    if (slopes.empty() || vertices == 0 || uvs.size() != vertices || mesh.normals.size() != vertices
        || mesh.tangents.size() != vertices) {
        return {};
    }
    const std::vector<std::uint32_t> welded = weld_positions(mesh.positions);
    const std::vector<FoldEdge> edges = find_edges(mesh, uvs, slopes, welded);

    std::vector<Vec2> heights(vertices, Vec2(0));
    for (int layer = 0; layer < (layers ? 2 : 1); ++layer) {
        const std::vector<double> fitted = solve(edges, layer, vertices);
        const std::vector<float> carried = find_carried(edges, layer, vertices);
        for (std::size_t v = 0; v < vertices; ++v) {
            const std::uint32_t first = welded[v];
            heights[v][layer] = finite_or(static_cast<float>(fitted[first]) * carried[first], 0.0f);
        }
    }
    float highest = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        if (!(glm::dot(mesh.normals[v], mesh.normals[welded[v]]) > kSameNormal)) {
            heights[welded[v]] = Vec2(0);
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        heights[v] = heights[welded[v]];
        highest = std::max({highest, std::abs(heights[v].x), std::abs(heights[v].y)});
    }
    return highest > kMinFoldHeight ? heights : std::vector<Vec2>{};
}

}  // namespace limn
