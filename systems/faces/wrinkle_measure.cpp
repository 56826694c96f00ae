#include "systems/faces/wrinkle_measure.h"

#include "ecs/base/check.h"
#include "ecs/components/weld.h"
#include "systems/faces/skin_diffusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

// Techniques: face.strain, wrinkle.compression.direction, wrinkle.compression.factor,
//     wrinkle.compression.intensity, wrinkle.compression.prior-models,
//     wrinkle.compression.rest-measure, wrinkle.compression.square-length,
//     wrinkle.compression.vertex-weight, wrinkle.dimples, wrinkle.natural-width, wrinkle.smoothing
// Source of wrinkle.dimples: mean of the squared stretch over all directions, half the trace of C

namespace limn {

namespace {

/// Directions of either sign whose mean is shorter than this cancel.
constexpr float kMinDirection = 1e-6f;

/// A triangle at rest in the plane of its edges.
struct RestTriangle {
    Vec3 e1;
    Vec3 e2;
    Vec3 normal;       ///< unit
    float twice_area;  ///< [m^2]; 0 or NaN: degenerate
};

RestTriangle rest_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    RestTriangle triangle = {.e1 = b - a, .e2 = c - a, .normal = {}, .twice_area = 0};
    triangle.normal = glm::cross(triangle.e1, triangle.e2);
    triangle.twice_area = glm::length(triangle.normal);
    triangle.normal /= triangle.twice_area;
    return triangle;
}

/// Mean of three directions of either sign, in the plane of the triangle; 0 where they cancel.
Vec3 mean_direction(const std::array<Vec3, 3>& d, const Vec3& normal) {
    Vec3 sum = d[0];
    for (const int i : {1, 2}) {
        sum += glm::dot(d[i], d[0]) < 0 ? -d[i] : d[i];
    }
    sum -= normal * glm::dot(normal, sum);
    const float length = glm::length(sum);
    return length >= kMinDirection && std::isfinite(length) ? sum / length : Vec3{0, 0, 0};
}

/// `direction`, in the plane of the triangle, as x e1 + y e2.
Vec2 in_edges(const RestTriangle& triangle, const Vec3& direction) {
    return Vec2{
               glm::dot(triangle.normal, glm::cross(direction, triangle.e2)),
               glm::dot(triangle.normal, glm::cross(triangle.e1, direction))}
           / triangle.twice_area;
}

float angle_of_edges(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Weights at the three corners, not yet normalized.
std::array<float, 3> corner_weights(const RestTriangle& triangle, WrinkleWeight weight) {
    switch (weight) {
    case WrinkleWeight::Angle: {
        const Vec3 e3 = triangle.e2 - triangle.e1;
        return {
            angle_of_edges(triangle.e1, triangle.e2), angle_of_edges(-triangle.e1, e3),
            angle_of_edges(-triangle.e2, -e3)};
    }
    case WrinkleWeight::Area:
        return {triangle.twice_area, triangle.twice_area, triangle.twice_area};
    case WrinkleWeight::Uniform:
        break;
    }
    return {1, 1, 1};
}

struct VertexCorner {
    std::uint32_t vertex;  ///< the first one at its position
    WrinkleCorner at;      ///< weight not yet normalized
};

/// Fills `around` and `first` with the corners of all vertices.
void collect_corners(
    WrinkleRest& rest, std::vector<VertexCorner>& corners, std::span<const std::uint32_t> welded) {
    std::ranges::stable_sort(corners, {}, &VertexCorner::vertex);
    std::vector<std::size_t> begin(welded.size() + 1, 0);  // of each vertex's corners
    for (const VertexCorner& corner : corners) {
        ++begin[corner.vertex + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());

    // All vertices at a position get the triangles of the first one.
    for (const std::uint32_t vertex : welded) {
        rest.first.push_back(static_cast<std::uint32_t>(rest.around.size()));
        float sum = 0;
        for (std::size_t i = begin[vertex]; i < begin[vertex + 1]; ++i) {
            sum += corners[i].at.corner / 3 < rest.stretch_from ? corners[i].at.weight : 0.0f;
        }
        for (std::size_t i = begin[vertex]; i < begin[vertex + 1]; ++i) {
            rest.around.push_back({corners[i].at.corner, corners[i].at.weight / sum});
        }
    }
    rest.first.push_back(static_cast<std::uint32_t>(rest.around.size()));
}

/// Calls f(vertices, triangle, has_area) for each triangle.
template <typename F>
void each_triangle(std::span<const Vec3> positions, std::span<const std::uint32_t> indices, F&& f) {
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        const std::array<std::uint32_t, 3> v = {indices[i], indices[i + 1], indices[i + 2]};
        if (std::ranges::max(v) >= positions.size()) {
            continue;
        }
        const RestTriangle triangle =
            rest_triangle(positions[v[0]], positions[v[1]], positions[v[2]]);
        f(v, triangle, triangle.twice_area > 0 && std::isfinite(triangle.twice_area));
    }
}

/// `direction`, perpendicular to the unit vector `from`, turned by the rotation from there to `to`.
Vec3 turn_with(const Vec3& direction, const Vec3& from, const Vec3& to) {
    const Vec3 axis = glm::cross(from, to);
    const float cosine =
        std::max(glm::dot(from, to), -0.999f);  // opposite vectors: any axis will do
    return cosine * direction + glm::cross(axis, direction)
           + axis * (glm::dot(axis, direction) / (1 + cosine));
}

/// Builds a rest from all triangles. `visit(v, triangle, has_area, pass, rest, add)` appends its
/// corners to `rest`, and calls add(k, corner) with those that have a weight at its vertex v[k];
/// those of the second pass count by their stretch.
template <typename Visit>
WrinkleRest rest_of_triangles(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, int passes,
    const Visit& visit) {
    WrinkleRest rest;
    std::vector<VertexCorner> corners;
    const std::vector<std::uint32_t> welded = weld_positions(positions);
    for (int pass = 0; pass < passes; ++pass) {
        if (pass == 1) {
            rest.stretch_from = static_cast<std::uint32_t>(rest.across.size());
        }
        each_triangle(
            positions, indices,
            [&](const std::array<std::uint32_t, 3>& v, const RestTriangle& triangle,
                bool has_area) {
                const auto add = [&](std::uint32_t k, const WrinkleCorner& corner) {
                    corners.push_back({welded[v[k]], corner});
                };
                visit(v, triangle, has_area, pass, rest, add);
            });
    }
    collect_corners(rest, corners, welded);
    return rest;
}

/// Measures a triangle along u, v and (u + v) / sqrt(2) of a vertex, turned into its plane.
void append_axes(
    std::array<WrinkleRest, 3>& rests, const std::array<std::uint32_t, 3>& v,
    const RestTriangle& triangle, const Vec3& u, const Vec3& normal) {
    const Vec3 along_u = turn_with(u, normal, triangle.normal);
    const Vec3 along_v = glm::cross(triangle.normal, along_u);
    const Vec3 directions[] = {
        along_u, along_v, (along_u + along_v) * std::numbers::sqrt2_v<float> * 0.5f};
    for (std::size_t i = 0; i < 3; ++i) {
        rests[i].corners.insert(rests[i].corners.end(), v.begin(), v.end());
        rests[i].across.push_back(in_edges(triangle, directions[i]));
    }
}

/// Extends `rests`, which measure each triangle in the axes of its corners, to the axes of the
/// vertices that it diffuses to.
std::array<WrinkleRest, 3> diffuse_strain_rests(
    const std::array<WrinkleRest, 3>& rests, std::span<const Vec3> positions,
    std::span<const std::uint32_t> indices, std::span<const Vec3> u, std::span<const Vec3> normals,
    float smoothing) {
    const std::vector<char> used(positions.size(), 1);
    const SkinDiffusion diffusion = make_skin_diffusion(positions, indices, used, smoothing);
    const DiffusedCorners diffused = diffuse_corners(diffusion, rests[0], 9);
    const std::vector<std::uint32_t> welded = weld_positions(positions);
    std::array<WrinkleRest, 3> wide;
    for (std::uint32_t vertex = 0; vertex < positions.size(); ++vertex) {
        const std::uint32_t from = welded[vertex];
        for (WrinkleRest& rest : wide) {
            rest.wide = true;
            rest.first.push_back(static_cast<std::uint32_t>(rest.around.size()));
        }
        for (std::uint32_t i = diffused.first[vertex]; i < diffused.first[vertex + 1]; ++i) {
            const std::uint32_t* const at = &rests[0].corners[9 * diffused.around[i].corner];
            const std::array<std::uint32_t, 3> v = {at[0], at[1], at[2]};
            const auto first = static_cast<std::uint32_t>(wide[0].corners.size());
            append_axes(
                wide, v, rest_triangle(positions[v[0]], positions[v[1]], positions[v[2]]), u[from],
                normals[from]);
            for (WrinkleRest& rest : wide) {
                rest.around.push_back({first, diffused.around[i].weight});
            }
        }
    }
    for (WrinkleRest& rest : wide) {
        rest.first.push_back(static_cast<std::uint32_t>(rest.around.size()));
    }
    return wide;
}

float region_weight(const VertexRegion& region, std::size_t v) {
    return std::clamp(finite_or(region.weights[v], 0), 0.0f, 1.0f);
}

/// Mean over the vertices of a triangle that fold.
float mean_aside(
    const std::array<std::uint32_t, 3>& v, std::span<const Vec3> across,
    std::span<const float> aside) {
    float sum = 0;
    float count = 0;
    for (std::size_t k = 0; k < 3 && !aside.empty(); ++k) {
        sum += aside[v[k]];
        count += aside[v[k]] > 0 || across[v[k]] != Vec3(0) ? 1.0f : 0.0f;
    }
    return count > 0 ? sum / count : 0.0f;
}

/// Where several regions have weight: the major axis of their mean tensor, and its minor eigenvalue
/// as a fraction of the trace.
void blend_directions(
    std::span<const VertexRegion* const> regions, const Vec3& normal, std::size_t v,
    FoldField& field) {
    constexpr float kNone = 1e-4f;
    const Vec3 flat = field.across[v] - glm::dot(field.across[v], normal) * normal;
    const Vec3 first = normalize_or(flat, Vec3(0));
    const Vec3 second = glm::cross(normal, first);
    float sum = 0;
    Vec2 axis = {0, 0};  // of doubled angles
    for (const VertexRegion* const region : regions) {
        const float weight = region_weight(*region, v);
        sum += weight;
        if (region->across.empty() || weight == 0) {
            continue;
        }
        const float x = glm::dot(region->across[v], first);
        const float y = glm::dot(region->across[v], second);
        axis += weight / std::max(x * x + y * y, kNone) * Vec2(x * x - y * y, 2 * x * y);
    }
    const float aside = 0.5f - 0.5f * glm::length(axis) / sum;
    if (aside > kNone && first != Vec3(0)) {
        const float angle = 0.5f * std::atan2(axis.y, axis.x);
        field.across[v] = std::cos(angle) * first + std::sin(angle) * second;
        field.aside[v] = aside;
    }
}

}  // namespace

bool is_named(const VertexRegion& region, const std::vector<std::string>& names) {
    return names.empty() || std::ranges::find(names, region.name) != names.end();
}

FoldField
merge_regions(const MeshData& mesh, const std::vector<std::string>& names, bool directed) {
    const std::size_t vertices = mesh.positions.size();
    FoldField field = {
        .mask = std::vector<float>(vertices, 0.0f),
        .across = std::vector<Vec3>(vertices, Vec3(0)),
        .aside = std::vector<float>(vertices, 0.0f)};
    std::vector<float> strongest(vertices, 0.0f);
    std::vector<const VertexRegion*> used;
    for (const VertexRegion& region : mesh.regions) {
        const bool has_across = region.across.size() == vertices;
        if (!is_named(region, names) || region.weights.size() != vertices
            || (!has_across && (directed || !region.across.empty()))) {
            continue;
        }
        used.push_back(&region);
        for (std::size_t v = 0; v < vertices; ++v) {
            const float weight = region_weight(region, v);
            field.mask[v] = std::min(field.mask[v] + weight, 1.0f);
            if (weight > strongest[v] && has_across) {
                strongest[v] = weight;
                field.across[v] = region.across[v];
            }
            field.aside[v] = strongest[v] > 0 || weight == 0 ? field.aside[v] : 0.5f;
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        field.aside[v] = strongest[v] > 0 ? 0.0f : field.aside[v];
        if (strongest[v] > 0 && mesh.normals.size() == vertices) {
            blend_directions(used, mesh.normals[v], v, field);
        }
    }
    return field;
}

WrinkleRest make_wrinkle_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> across, WrinkleWeight weight, const AlongFolds& along) {
    LIMN_CHECK(across.size() == positions.size());
    LIMN_CHECK(along.aside.empty() || along.aside.size() == positions.size());
    return rest_of_triangles(
        positions, indices, along.narrowing > 0 ? 2 : 1,
        [&](const std::array<std::uint32_t, 3>& v, const RestTriangle& triangle, bool has_area,
            int pass, WrinkleRest& rest, const auto& add) {
            const auto append = [&](const Vec2& coefficients, float factor) {
                const auto first = static_cast<std::uint32_t>(rest.corners.size());
                rest.corners.insert(rest.corners.end(), v.begin(), v.end());
                rest.across.push_back(coefficients);
                const std::array<float, 3> weights = corner_weights(triangle, weight);
                for (std::uint32_t k = 0; k < 3 && factor > 0; ++k) {
                    add(k, {first + k, factor * weights[k]});
                }
            };
            Vec3 direction =
                mean_direction({across[v[0]], across[v[1]], across[v[2]]}, triangle.normal);
            const float aside = mean_aside(v, across, along.aside);
            if (has_area && direction == Vec3(0) && aside > 0) {
                direction = glm::normalize(triangle.e1);  // any
            }
            const Vec2 coefficients = in_edges(triangle, direction);
            const Vec2 others = in_edges(triangle, glm::cross(triangle.normal, direction));
            if (!has_area || coefficients == Vec2{0, 0} || !is_finite(coefficients)) {
                append({0, 0}, 0);
            } else if (pass == 1) {
                append(others, along.narrowing * (1 - 2 * aside));
            } else {
                append(coefficients, 1 - aside);
                if (aside > 0) {
                    append(others, aside);
                }
            }
        });
}

WrinkleRest make_edge_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, WrinkleWeight weight) {
    return rest_of_triangles(
        positions, indices, 1,
        [&](const std::array<std::uint32_t, 3>& v, const RestTriangle& triangle, bool has_area, int,
            WrinkleRest& rest, const auto& add) {
            if (!has_area) {
                return;
            }
            const std::array<float, 3> weights = corner_weights(triangle, weight);
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t next = (k + 1) % 3;
                const auto first = static_cast<std::uint32_t>(rest.corners.size());
                rest.corners.insert(rest.corners.end(), {v[k], v[next], v[next]});
                rest.across.emplace_back(1 / glm::distance(positions[v[k]], positions[v[next]]), 0);
                add(k, {first, weights[k]});
                add(next, {first + 1, weights[next]});
            }
        });
}

std::array<WrinkleRest, 3> make_strain_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> u, std::span<const Vec3> normals, WrinkleWeight weight, float smoothing) {
    LIMN_CHECK(u.size() == positions.size());
    LIMN_CHECK(normals.size() == positions.size());
    std::array<WrinkleRest, 3> rests;
    std::array<std::vector<VertexCorner>, 3> corners;
    const std::vector<std::uint32_t> welded = weld_positions(positions);
    each_triangle(
        positions, indices,
        [&](const std::array<std::uint32_t, 3>& v, const RestTriangle& triangle, bool has_area) {
            const std::array<float, 3> weights = corner_weights(triangle, weight);
            for (std::uint32_t k = 0; k < 3 && has_area; ++k) {
                const std::uint32_t vertex = welded[v[k]];
                const auto first = static_cast<std::uint32_t>(rests[0].corners.size());
                append_axes(rests, v, triangle, u[vertex], normals[vertex]);
                for (std::vector<VertexCorner>& of_rest : corners) {
                    of_rest.push_back({vertex, {first + k, weights[k]}});
                }
            }
        });
    for (std::size_t i = 0; i < 3; ++i) {
        collect_corners(rests[i], corners[i], welded);
    }
    return smoothing > 0 ? diffuse_strain_rests(rests, positions, indices, u, normals, smoothing)
                         : rests;
}

SkinStrain tensor_of_ratios(float along_u, float along_v, float between) {
    return {.uu = along_u, .vv = along_v, .uv = between - 0.5f * (along_u + along_v)};
}

SkinStrain strain_of_tensor(const SkinStrain& tensor, float angle, float side) {
    // sqrt(C) = (C + r I) / sqrt(trace C + 2 r) with r = sqrt(det C), as in find_strain().
    const float root = std::sqrt(std::max(tensor.uu * tensor.vv - tensor.uv * tensor.uv, 0.0f));
    const float sum = std::sqrt(std::max(tensor.uu + tensor.vv + 2 * root, 1e-20f));
    const float mean = 0.5f * (tensor.uu + tensor.vv);
    const float half = 0.5f * (tensor.uu - tensor.vv);
    const float c = std::cos(2 * angle);
    const float s = std::sin(2 * angle);
    const float turned = half * c + tensor.uv * s;
    return {
        .uu = (mean + turned + root) / sum - 1,
        .vv = (mean - turned + root) / sum - 1,
        .uv = side * (tensor.uv * c - half * s) / sum};
}

float shortest_ratio(float along_u, float along_v, float between) {
    return std::max(principal_strain(tensor_of_ratios(along_u, along_v, between)).lower, 0.0f);
}

void find_compression(
    const WrinkleRest& rest, std::span<const Vec3> deformed, std::span<float> ratio) {
    LIMN_CHECK(deformed.size() + 1 == rest.first.size());
    LIMN_CHECK(ratio.size() == rest.across.size());
    for (std::size_t t = 0; t < ratio.size(); ++t) {
        const Vec3& a = deformed[rest.corners[3 * t]];
        const Vec3& b = deformed[rest.corners[3 * t + 1]];
        const Vec3& c = deformed[rest.corners[3 * t + 2]];
        const Vec2& across = rest.across[t];
        const Vec3 chord = across.x * (b - a) + across.y * (c - a);
        const float found = glm::dot(chord, chord);
        ratio[t] = across == Vec2{0, 0} ? 1.0f : finite_or(found, 1.0f);
        ratio[t] = t < rest.stretch_from ? ratio[t] : std::max(ratio[t] - 1, 0.0f);
    }
}

void average_compression(
    const WrinkleRest& rest, std::span<const float> ratio, std::span<float> vertices) {
    LIMN_CHECK(ratio.size() == rest.across.size());
    LIMN_CHECK(vertices.size() + 1 == rest.first.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        float sum = 0;
        for (std::uint32_t i = rest.first[v]; i < rest.first[v + 1]; ++i) {
            const float of_triangle = ratio[rest.around[i].corner / 3];
            sum +=
                rest.around[i].weight * (rest.mean_length ? std::sqrt(of_triangle) : of_triangle);
        }
        const float mean = rest.mean_length ? sum * sum : sum;
        vertices[v] = rest.first[v] == rest.first[v + 1] ? 1.0f : mean;
    }
}

std::vector<float>
vertex_compression(std::span<const WrinkleRest> rests, std::span<const Vec3> deformed) {
    std::array<std::vector<float>, 3> found;
    for (std::size_t i = 0; i < rests.size(); ++i) {
        std::vector<float> triangles(rests[i].across.size());
        find_compression(rests[i], deformed, triangles);
        found[i].resize(deformed.size());
        average_compression(rests[i], triangles, found[i]);
    }
    if (rests.empty()) {
        return std::vector<float>(deformed.size(), 1.0f);
    }
    for (std::size_t v = 0; rests.size() == 3 && v < deformed.size(); ++v) {
        found[0][v] = shortest_ratio(found[0][v], found[1][v], found[2][v]);
    }
    return std::move(found[0]);
}

float wrinkle_intensity(float ratio, float lambda, float beta) {
    // A hyperbolic tangent does not overflow; log(0) = -infinity gives 1.
    return -std::tanh(0.5f * beta * std::log(lambda * std::max(ratio, 0.0f)));
}

}  // namespace limn
