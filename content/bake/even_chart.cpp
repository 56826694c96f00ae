#include "content/bake/even_chart.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

// Techniques: skin.detail

namespace limn {

namespace {

using Vec2d = glm::dvec2;

constexpr int kChartRounds = 8;
constexpr int kSolveSteps = 40;          ///< of conjugate gradients per round, from the last result
constexpr double kAnchor = 1e-7;         ///< regularization relative to the stiffest vertex
constexpr double kMinChartArea = 1e-12;  ///< of a triangle, relative to `size` squared

/// A triangle in its own plane.
struct FlatTriangle {
    std::array<std::uint32_t, 3> vertices;  ///< joined vertices count as one
    std::array<Vec2d, 3> steps;             ///< step of the joins, from corner k to the next
    std::array<Vec2d, 3> sides;             ///< from corner k to the next, in units of the chart
    std::array<double, 3> weights;          ///< of sides: cotangents of the opposite angles
};

/// For each vertex the join to another one, or to itself.
std::vector<ChartJoin> join_each(std::size_t vertices, std::span<const ChartJoin> joins) {
    std::vector<ChartJoin> each(vertices);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        each[v].from = v;
        each[v].to = v;
    }
    for (const ChartJoin& join : joins) {
        LIMN_CHECK(join.from < vertices && join.to < vertices && each[join.to].from == join.to);
        each[join.to] = join;
    }
    for (const ChartJoin& join : joins) {
        LIMN_CHECK(each[join.from].from == join.from);
    }
    return each;
}

std::vector<FlatTriangle> flatten(
    const MeshData& mesh, float size, std::span<const float> importance,
    std::span<const ChartJoin> each) {
    std::vector<FlatTriangle> triangles;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::uint32_t* const v = &mesh.indices[t];
        const glm::dvec3 a = glm::dvec3(mesh.positions[v[0]]) / double{size};
        const glm::dvec3 ab = glm::dvec3(mesh.positions[v[1]]) / double{size} - a;
        const glm::dvec3 ac = glm::dvec3(mesh.positions[v[2]]) / double{size} - a;
        const double area = glm::length(glm::cross(ab, ac));
        if (!(area > kMinChartArea)) {
            continue;
        }
        // v points down, as in textures: clockwise.
        const double length = glm::length(ab);
        const Vec2d b = {length, 0};
        const Vec2d c = {glm::dot(ac, ab) / length, -area / length};
        FlatTriangle& flat = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            flat.vertices[k] = each[v[k]].from;
            flat.steps[k] = Vec2d(each[v[(k + 1) % 3]].step) - Vec2d(each[v[k]].step);
        }
        flat.sides = {b, c - b, -c};
        // Between equal weights and weights by area, so that dense parts are not neglected.
        const double mean = double{importance[v[0]] + importance[v[1]] + importance[v[2]]} / 3;
        const double stiffness = -0.5 * mean / (area * std::sqrt(area));
        for (std::size_t k = 0; k < 3; ++k) {
            flat.weights[k] =
                stiffness * glm::dot(flat.sides[(k + 1) % 3], flat.sides[(k + 2) % 3]);
        }
    }
    return triangles;
}

/// The side in the chart from corner `k` to the next.
Vec2d side_in(const FlatTriangle& triangle, std::span<const Vec2d> chart, std::size_t k) {
    return chart[triangle.vertices[(k + 1) % 3]] - chart[triangle.vertices[k]] + triangle.steps[k];
}

/// The rotation (cos, sin) that fits its sides best to those in the chart.
Vec2d nearest_turn(const FlatTriangle& triangle, std::span<const Vec2d> chart) {
    Vec2d turn = {0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2d side = triangle.sides[k];
        const Vec2d now = side_in(triangle, chart, k);
        turn += triangle.weights[k] * Vec2d(glm::dot(side, now), side.x * now.y - side.y * now.x);
    }
    const double length = glm::length(turn);
    return length > 0 ? turn / length : Vec2d(1, 0);
}

/// Multiplies by the sparse matrix of weighted differences, triangle by triangle.
void apply(
    std::span<const FlatTriangle> triangles, double anchor, std::span<const Vec2d> x,
    std::vector<Vec2d>& out) {
    for (std::size_t v = 0; v < x.size(); ++v) {
        out[v] = anchor * x[v];
    }
    for (const FlatTriangle& triangle : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangle.vertices[k];
            const std::uint32_t b = triangle.vertices[(k + 1) % 3];
            const Vec2d pull = triangle.weights[k] * (x[b] - x[a]);
            out[a] -= pull;
            out[b] += pull;
        }
    }
}

/// Residual at the vertices of a chart: the rotated sides minus the current ones, weighted.
std::vector<Vec2d>
residual_of(std::span<const FlatTriangle> triangles, std::span<const Vec2d> chart) {
    std::vector<Vec2d> residual(chart.size(), Vec2d(0));
    for (const FlatTriangle& triangle : triangles) {
        const Vec2d turn = nearest_turn(triangle, chart);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2d s = triangle.sides[k];
            const std::uint32_t a = triangle.vertices[k];
            const std::uint32_t b = triangle.vertices[(k + 1) % 3];
            const Vec2d turned = {turn.x * s.x - turn.y * s.y, turn.y * s.x + turn.x * s.y};
            const Vec2d pull = triangle.weights[k] * (turned - side_in(triangle, chart, k));
            residual[a] -= pull;
            residual[b] += pull;
        }
    }
    return residual;
}

double product(std::span<const Vec2d> a, std::span<const Vec2d> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += glm::dot(a[i], b[i]);
    }
    return sum;
}

/// Moves the chart to the minimum for the current rotations of the triangles.
void relax_chart(
    std::span<const FlatTriangle> triangles, std::span<const double> diagonal, double anchor,
    std::vector<Vec2d>& chart) {
    std::vector<Vec2d> residual = residual_of(triangles, chart);
    std::vector<Vec2d> preconditioned(chart.size());
    const auto precondition = [&] {
        for (std::size_t v = 0; v < chart.size(); ++v) {
            preconditioned[v] = residual[v] / diagonal[v];
        }
        return product(residual, preconditioned);
    };
    double now = precondition();
    std::vector<Vec2d> step = preconditioned;
    std::vector<Vec2d> image(chart.size());
    for (int i = 0; i < kSolveSteps && now > 0; ++i) {
        apply(triangles, anchor, step, image);
        const double curvature = product(step, image);
        if (!(curvature > 0)) {
            return;
        }
        for (std::size_t v = 0; v < chart.size(); ++v) {
            chart[v] += now / curvature * step[v];
            residual[v] -= now / curvature * image[v];
        }
        const double next = precondition();
        for (std::size_t v = 0; v < chart.size(); ++v) {
            step[v] = preconditioned[v] + next / now * step[v];
        }
        now = next;
    }
}

}  // namespace

std::vector<Vec2> make_even_chart(
    const MeshData& mesh, float size, std::span<const float> importance,
    std::span<const ChartJoin> joins) {
    LIMN_CHECK(size > 0 && mesh.uvs.size() == mesh.positions.size());
    LIMN_CHECK(importance.size() == mesh.positions.size());
    const std::vector<ChartJoin> each = join_each(mesh.positions.size(), joins);
    const std::vector<FlatTriangle> triangles = flatten(mesh, size, importance, each);
    std::vector<double> diagonal(mesh.positions.size(), 0.0);
    for (const FlatTriangle& triangle : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            diagonal[triangle.vertices[k]] += triangle.weights[k];
            diagonal[triangle.vertices[(k + 1) % 3]] += triangle.weights[k];
        }
    }
    double stiffest = 0;
    for (const double d : diagonal) {
        stiffest = std::max(stiffest, d);
    }
    const double anchor = kAnchor * stiffest + 1e-300;
    for (double& d : diagonal) {
        d = std::max(d, 0.0) + anchor;
    }
    std::vector<Vec2d> chart(mesh.uvs.begin(), mesh.uvs.end());
    for (int round = 0; round < kChartRounds; ++round) {
        relax_chart(triangles, diagonal, anchor, chart);
    }
    for (const ChartJoin& join : joins) {
        chart[join.to] = chart[join.from] + Vec2d(join.step);
    }
    return {chart.begin(), chart.end()};
}

}  // namespace limn
