#include "systems/light/light_map_charts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

// Techniques: light.lightmap

namespace limn {
namespace {

constexpr int kChartBorder = 1;  ///< around the texels of a chart

std::uint32_t chart_root(std::vector<std::uint32_t>& parents, std::uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/// Of six: +x -x +y -y +z -z; -1: of a triangle without area.
int facing_axis(const MeshData& mesh, std::size_t triangle) {
    const auto at = [&](std::size_t k) { return mesh.positions[mesh.indices[3 * triangle + k]]; };
    const Vec3 n = glm::cross(at(1) - at(0), at(2) - at(0));
    const Vec3 size = glm::abs(n);
    if (!(size.x + size.y + size.z > 0)) {
        return -1;
    }
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * axis + (n[axis] < 0 ? 1 : 0);
}

Vec2 seen_along(int axis, const Vec3& p) {
    return axis < 2 ? Vec2(p.z, p.y) : axis < 4 ? Vec2(p.x, p.z) : Vec2(p.x, p.y);
}

/// The chart of each triangle: the lowest triangle in it.
std::vector<std::uint32_t> connect_triangles(const MeshData& mesh, const std::vector<int>& axes) {
    const std::size_t count = axes.size();
    std::map<std::tuple<float, float, float>, std::uint32_t> number_of_position;
    std::vector<std::uint32_t> welded(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3& p = mesh.positions[i];
        welded[i] = number_of_position.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(i))
                        .first->second;
    }
    std::vector<std::uint32_t> parents(count);
    std::iota(parents.begin(), parents.end(), 0u);
    std::map<std::tuple<std::uint32_t, std::uint32_t, int>, std::uint32_t> at_edge;
    for (std::uint32_t t = 0; t < count; ++t) {
        for (std::size_t k = 0; axes[t] >= 0 && k < 3; ++k) {
            const std::uint32_t a = welded[mesh.indices[3 * t + k]];
            const std::uint32_t b = welded[mesh.indices[3 * t + (k + 1) % 3]];
            const auto [found, is_new] =
                at_edge.try_emplace({std::min(a, b), std::max(a, b), axes[t]}, t);
            if (!is_new) {
                const std::uint32_t i = chart_root(parents, t);
                const std::uint32_t j = chart_root(parents, found->second);
                parents[std::max(i, j)] = std::min(i, j);
            }
        }
    }
    for (std::uint32_t t = 0; t < count; ++t) {
        parents[t] = chart_root(parents, t);
    }
    return parents;
}

struct MapChart {
    std::uint32_t root = 0;
    Vec2 low = Vec2(INFINITY);  ///< of what is seen along its axis
    Vec2 high = Vec2(-INFINITY);
    IVec2 corner = {0, 0};  ///< in the image
    IVec2 size = {0, 0};    ///< with borders [texels]
};

/// Rows of charts, the highest first, in an image of this width; returns its height.
int place_charts(std::vector<MapChart>& charts, const std::vector<std::size_t>& order, int width) {
    IVec2 at = {0, 0};
    int row_height = 0;
    for (const std::size_t i : order) {
        MapChart& chart = charts[i];
        if (at.x + chart.size.x > width) {
            at = {0, at.y + row_height};
            row_height = 0;
        }
        chart.corner = at;
        at.x += chart.size.x;
        row_height = std::max(row_height, chart.size.y);
    }
    return at.y + row_height;
}

IVec2 pack_charts(std::vector<MapChart>& charts, float density) {
    std::int64_t area = 0;
    int widest = 1;
    for (MapChart& chart : charts) {
        const Vec2 texels = (chart.high - chart.low) * density;
        for (int c = 0; c < 2; ++c) {
            const float whole = std::min(std::ceil(texels[c]), 1e6f);
            chart.size[c] = std::max(static_cast<int>(whole), 1) + 2 * kChartBorder;
        }
        area += std::int64_t{chart.size.x} * chart.size.y;
        widest = std::max(widest, chart.size.x);
    }
    std::vector<std::size_t> order(charts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return charts[a].size.y > charts[b].size.y;
    });
    const int square = static_cast<int>(std::sqrt(static_cast<double>(area)) * 1.05) + 1;
    const int width = std::max(widest, square);
    return {width, place_charts(charts, order, width)};
}

std::vector<MapChart> find_charts(
    const MeshData& mesh, const std::vector<int>& axes, std::vector<std::uint32_t>& chart_of) {
    std::vector<MapChart> charts;
    std::map<std::uint32_t, std::uint32_t> number_of_root;
    for (std::size_t t = 0; t < axes.size(); ++t) {
        if (axes[t] < 0) {
            continue;
        }
        const auto [found, is_new] =
            number_of_root.try_emplace(chart_of[t], static_cast<std::uint32_t>(charts.size()));
        if (is_new) {
            charts.push_back({.root = chart_of[t]});
        }
        chart_of[t] = found->second;
        MapChart& chart = charts[found->second];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 p = seen_along(axes[t], mesh.positions[mesh.indices[3 * t + k]]);
            chart.low = glm::min(chart.low, p);
            chart.high = glm::max(chart.high, p);
        }
    }
    return charts;
}

template <typename T>
void append_copy(std::vector<T>& values, std::uint32_t of) {
    if (of < values.size()) {
        values.push_back(T(values[of]));
    }
}

/// Gives each chart its own vertices.
void write_chart_uvs(
    MeshData& mesh, const std::vector<int>& axes, const std::vector<std::uint32_t>& chart_of,
    const std::vector<MapChart>& charts, float density, const Vec2& size) {
    const std::size_t old_count = mesh.positions.size();
    std::vector<std::uint32_t> owner(old_count, kNoAsset);  // chart that has the vertex itself
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
    mesh.uvs1.assign(old_count, Vec2(0));
    for (std::size_t t = 0; t < axes.size(); ++t) {
        for (std::size_t k = 0; axes[t] >= 0 && k < 3; ++k) {
            std::uint32_t& index = mesh.indices[3 * t + k];
            const std::uint32_t vertex = index;
            const std::uint32_t number = chart_of[t];
            if (owner[vertex] == kNoAsset) {
                owner[vertex] = number;
            } else if (owner[vertex] != number) {
                const auto [found, is_new] = copies.try_emplace(
                    {number, vertex}, static_cast<std::uint32_t>(mesh.positions.size()));
                if (is_new) {
                    append_copy(mesh.positions, vertex);
                    append_copy(mesh.normals, vertex);
                    append_copy(mesh.tangents, vertex);
                    append_copy(mesh.uvs, vertex);
                    append_copy(mesh.colors, vertex);
                    mesh.uvs1.emplace_back(0);
                }
                index = found->second;
            }
            const MapChart& chart = charts[number];
            const Vec2 inside = (seen_along(axes[t], mesh.positions[index]) - chart.low) * density;
            mesh.uvs1[index] = (Vec2(chart.corner + kChartBorder) + inside) / size;
        }
    }
}

}  // namespace

std::optional<ChartedMesh> cut_into_charts(const MeshData& mesh, float density) {
    const std::size_t count = mesh.indices.size() / 3;
    std::vector<int> axes;
    for (std::size_t t = 0; t < count; ++t) {
        axes.push_back(facing_axis(mesh, t));
    }
    std::vector<std::uint32_t> chart_of = connect_triangles(mesh, axes);
    std::vector<MapChart> charts = find_charts(mesh, axes, chart_of);
    if (charts.empty() || !is_finite(mesh.bounds.max - mesh.bounds.min)) {
        return std::nullopt;
    }
    IVec2 size = pack_charts(charts, density);
    for (int halved = 0; std::max(size.x, size.y) > kMaxLightMapSize; ++halved) {
        if (halved == 32) {
            return std::nullopt;  // too many charts
        }
        density *= 0.5f;
        size = pack_charts(charts, density);
    }
    ChartedMesh charted = {.mesh = mesh, .width = size.x, .height = size.y};
    charted.mesh.name += " with charts";
    charted.mesh.version = 0;
    charted.mesh.regions.clear();  // values per vertex that nothing at rest needs
    charted.mesh.pieces.clear();
    write_chart_uvs(charted.mesh, axes, chart_of, charts, density, Vec2(size));
    return charted;
}

namespace {

/// The point of a triangle that is nearest to `p`, as weights of its corners.
Vec3 nearest_weights(const std::array<glm::dvec2, 3>& corner, const glm::dvec2& p) {
    const glm::dvec2 a = corner[1] - corner[0];
    const glm::dvec2 b = corner[2] - corner[0];
    const double area = a.x * b.y - a.y * b.x;
    const glm::dvec2 d = p - corner[0];
    const glm::dvec2 inside = glm::dvec2(d.x * b.y - d.y * b.x, a.x * d.y - a.y * d.x) / area;
    if (inside.x >= 0 && inside.y >= 0 && inside.x + inside.y <= 1) {
        return {
            static_cast<float>(1 - inside.x - inside.y), static_cast<float>(inside.x),
            static_cast<float>(inside.y)};
    }
    Vec3 best(0);
    double least = INFINITY;
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const auto& from = corner[static_cast<std::size_t>(k)];
        const glm::dvec2 edge = corner[static_cast<std::size_t>(next)] - from;
        const double length2 = std::max(glm::dot(edge, edge), 1e-30);
        const double t = std::clamp(glm::dot(p - from, edge) / length2, 0.0, 1.0);
        const glm::dvec2 away = p - from - t * edge;
        if (glm::dot(away, away) < least) {
            least = glm::dot(away, away);
            best = Vec3(0);
            best[k] = static_cast<float>(1 - t);
            best[next] = static_cast<float>(t);
        }
    }
    return best;
}

/// The nearest triangle to each texel, up to a texel away from it.
class TexelRaster {
  public:
    TexelRaster(const MeshData& mesh, int width, int height)
        : mesh_(mesh), width_(width), height_(height),
          distances_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), INFINITY),
          texels_(distances_.size()) {}

    void add(std::size_t triangle) {
        std::array<glm::dvec2, 3> corner;
        glm::dvec2 low(INFINITY);
        glm::dvec2 high(-INFINITY);
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = glm::dvec2(mesh_.uvs1[mesh_.indices[3 * triangle + k]])
                        * glm::dvec2(width_, height_);
            low = glm::min(low, corner[k]);
            high = glm::max(high, corner[k]);
        }
        const glm::dvec2 a = corner[1] - corner[0];
        const glm::dvec2 b = corner[2] - corner[0];
        if (!(std::abs(a.x * b.y - a.y * b.x) > 1e-12)) {
            return;  // also NaN
        }
        // Texels whose centers are up to a texel away.
        const auto first = [](double x, int size) {
            return static_cast<int>(std::clamp(std::floor(x - 1.5), 0.0, size - 1.0));
        };
        const auto last = [](double x, int size) {
            return static_cast<int>(std::clamp(std::ceil(x + 0.5), 0.0, size - 1.0));
        };
        for (int y = first(low.y, height_); y <= last(high.y, height_); ++y) {
            for (int x = first(low.x, width_); x <= last(high.x, width_); ++x) {
                visit(triangle, corner, x, y);
            }
        }
    }

    [[nodiscard]] std::vector<LightMapTexel> found() const {
        std::vector<LightMapTexel> all;
        for (std::size_t i = 0; i < texels_.size(); ++i) {
            if (distances_[i] < INFINITY) {
                all.push_back(texels_[i]);
            }
        }
        return all;
    }

  private:
    void visit(std::size_t triangle, const std::array<glm::dvec2, 3>& corner, int x, int y) {
        const glm::dvec2 center = {x + 0.5, y + 0.5};
        const Vec3 weights = nearest_weights(corner, center);
        glm::dvec2 at(0);
        LightMapTexel texel{.normal = Vec3(0)};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh_.indices[3 * triangle + k];
            const float weight = weights[static_cast<int>(k)];
            at += static_cast<double>(weight) * corner[k];
            texel.position += weight * mesh_.positions[vertex];
            texel.normal += weight * mesh_.normals[vertex];
        }
        const glm::dvec2 away = glm::abs(center - at);
        const double distance = std::max(away.x, away.y);
        const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_)
                                  + static_cast<std::size_t>(x);
        if (distance <= 1.0 && distance < distances_[pixel] - 1e-6) {
            distances_[pixel] = distance;
            texel.pixel = static_cast<std::uint32_t>(pixel);
            texels_[pixel] = texel;
        }
    }

    const MeshData& mesh_;
    int width_;
    int height_;
    std::vector<double> distances_;  ///< by pixel [texels]
    std::vector<LightMapTexel> texels_;
};

}  // namespace

std::vector<LightMapTexel> light_map_texels(const MeshData& mesh, int width, int height) {
    LIMN_CHECK(mesh.uvs1.size() == mesh.positions.size());
    LIMN_CHECK(mesh.normals.size() == mesh.positions.size());
    TexelRaster raster(mesh, width, height);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        raster.add(t);
    }
    return raster.found();
}

std::vector<LightMapPatch> make_light_map_patches(std::vector<LightMapTexel>& texels, int width) {
    const auto block_of = [width](const LightMapTexel& texel) {
        const auto row = texel.pixel / static_cast<std::uint32_t>(width);
        const auto column = texel.pixel % static_cast<std::uint32_t>(width);
        return std::pair(row / 8, column / 8);
    };
    std::stable_sort(
        texels.begin(), texels.end(),
        [&](const LightMapTexel& a, const LightMapTexel& b) { return block_of(a) < block_of(b); });
    std::vector<LightMapPatch> patches;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        if (i == 0 || block_of(texels[i]) != block_of(texels[i - 1])) {
            patches.push_back({.first = static_cast<std::uint32_t>(i), .count = 0, .box = {}});
        }
        ++patches.back().count;
        grow(patches.back().box, texels[i].position);
    }
    return patches;
}

}  // namespace limn
