#include "systems/water/water_refraction.h"

#include "ecs/base/check.h"
#include "systems/water/water_dispersion.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: water.shallow-refraction

namespace limn {

namespace {

constexpr double kHalfPlaneTurn = 6.283185307179586;
constexpr float kMaxAlongRow = 0.999f;  ///< largest component of k along a row, relative to k
constexpr int kMaxSubsteps = 32;        ///< between rows

float number_of(float period, float depth) {
    const double deep = static_cast<double>(std::max(depth, kMinWaveDepth));
    return static_cast<float>(wave_number(kHalfPlaneTurn / static_cast<double>(period), deep));
}

/// The grid in marching order: rows starting at the side where the train enters.
struct Rows {
    int count = 0;
    int length = 0;
    bool along_x = false;   ///< the train travels mainly along x
    bool backward = false;  ///< toward smaller x or z
    int width = 0;          ///< of the grid

    [[nodiscard]] std::size_t at(int row, int i) const {
        const int far = backward ? count - 1 - row : row;
        return static_cast<std::size_t>(along_x ? i * width + far : far * width + i);
    }
};

/// d S / d row from the eikonal equation, with the largest upwind d S along the row (Godunov).
float rise(float number, float left, float right, float cell) {
    const float along = std::max(std::max(left, 0.0f), std::max(-right, 0.0f)) / cell;
    const float limit = kMaxAlongRow * number;
    return std::sqrt(square(number) - square(std::min(along, limit)));
}

/// Bilinear depth, clamped at the edges.
float depth_at(const DepthGrid& grid, const Vec2& at) {
    const Vec2 cell_position = glm::clamp(at / grid.cell, Vec2(0), Vec2(grid.points - 1));
    const IVec2 corner = glm::min(IVec2(cell_position), grid.points - 2);
    const Vec2 u = cell_position - Vec2(corner);
    const float* const first = grid.depth.data() + corner.y * grid.points.x + corner.x;
    return glm::mix(
        glm::mix(first[0], first[1], u.x),
        glm::mix(first[grid.points.x], first[grid.points.x + 1], u.x), u.y);
}

bool is_grid(const DepthGrid& grid) {
    return grid.points.x >= 2 && grid.points.y >= 2 && grid.cell > 0
           && grid.depth.size()
                  == static_cast<std::size_t>(grid.points.x)
                         * static_cast<std::size_t>(grid.points.y);
}

}  // namespace

WaveTrain refract_waves(const DepthGrid& grid, float period, float direction) {
    LIMN_CHECK(is_grid(grid));
    LIMN_CHECK(period > 0);
    WaveTrain train;
    std::vector<float> numbers;
    for (const float depth : grid.depth) {
        numbers.push_back(number_of(period, depth));
        train.number.push_back(depth > 0 ? numbers.back() : 0.0f);
        train.amplitude.push_back(depth > 0 ? 1.0f : 0.0f);
    }
    train.phase.resize(grid.depth.size());

    const Vec2 heading = {std::cos(direction), std::sin(direction)};
    Rows rows;
    rows.along_x = std::abs(heading.x) >= std::abs(heading.y);
    rows.backward = (rows.along_x ? heading.x : heading.y) < 0;
    rows.count = rows.along_x ? grid.points.x : grid.points.y;
    rows.length = rows.along_x ? grid.points.y : grid.points.x;
    rows.width = grid.points.x;
    float incoming = numbers[rows.at(0, 0)];
    for (int i = 0; i < rows.length; ++i) {
        incoming = std::min(incoming, numbers[rows.at(0, i)]);
    }
    // Phase difference between points of a row, also extrapolated beyond its ends.
    const float aside = incoming * (rows.along_x ? heading.y : heading.x) * grid.cell;
    const auto length = static_cast<std::size_t>(rows.length);
    std::vector<float> here(length + 2);
    std::vector<float> next(length + 2);
    for (std::size_t i = 0; i < here.size(); ++i) {
        here[i] = aside * (static_cast<float>(i) - 1);
    }
    for (int row = 0; row < rows.count; ++row) {
        float quickest = 0;  // largest ratio of ray motion along the row to that across it
        for (int i = 0; i < rows.length; ++i) {
            const std::size_t at = rows.at(row, i);
            train.phase[at] = here[static_cast<std::size_t>(i) + 1];
            const std::size_t p = static_cast<std::size_t>(i) + 1;
            const float up =
                rise(numbers[at], here[p] - here[p - 1], here[p + 1] - here[p], grid.cell);
            quickest = std::max(quickest, std::sqrt(square(numbers[at] / up) - 1));
        }
        if (row + 1 == rows.count) {
            break;
        }
        const int substeps = std::clamp(static_cast<int>(std::ceil(quickest)), 1, kMaxSubsteps);
        for (int substep = 0; substep < substeps; ++substep) {
            const float fraction =
                (static_cast<float>(substep) + 0.5f) / static_cast<float>(substeps);
            for (int i = 0; i < rows.length; ++i) {
                const std::size_t p = static_cast<std::size_t>(i) + 1;
                const float number =
                    glm::mix(numbers[rows.at(row, i)], numbers[rows.at(row + 1, i)], fraction);
                next[p] =
                    here[p]
                    + grid.cell / static_cast<float>(substeps)
                          * rise(number, here[p] - here[p - 1], here[p + 1] - here[p], grid.cell);
            }
            next.front() = next[1] - aside;
            next.back() = next[length] + aside;
            here.swap(next);
        }
    }
    const float origin = train.phase[0];
    for (float& phase : train.phase) {
        phase -= origin;
    }
    return train;
}

std::vector<Vec2> trace_wave_ray(
    const DepthGrid& grid, float period, const Vec2& from, float direction, float length,
    float step) {
    LIMN_CHECK(is_grid(grid));
    LIMN_CHECK(step > 0);
    const auto number = [&](const Vec2& at) { return number_of(period, depth_at(grid, at)); };
    const auto slope = [&](const Vec2& at) {
        const float h = 0.5f * grid.cell;
        return Vec2(
                   number(at + Vec2(h, 0)) - number(at - Vec2(h, 0)),
                   number(at + Vec2(0, h)) - number(at - Vec2(0, h)))
               / (2 * h);
    };
    const Vec2 extent = grid.cell * Vec2(grid.points - 1);
    std::vector<Vec2> ray;
    Vec2 at = from;
    Vec2 wave = number(at) * Vec2(std::cos(direction), std::sin(direction));
    for (float traveled = 0; traveled <= length; traveled += step) {
        const bool inside = at.x >= 0 && at.y >= 0 && at.x <= extent.x && at.y <= extent.y;
        if (!inside || !(depth_at(grid, at) > 0)) {
            break;
        }
        ray.push_back(at);
        // d x / d s = k / |k|, d k / d s = grad |k|, by the midpoint rule.
        const Vec2 midpoint = at + 0.5f * step * glm::normalize(wave);
        wave += step * slope(midpoint);
        const Vec2 turned = glm::normalize(wave);
        at = midpoint + 0.5f * step * turned;
        wave = number(at) * turned;
    }
    return ray;
}

float snell_angle(float angle, float from, float to, float period) {
    const float ratio = number_of(period, from) / number_of(period, to);
    return std::asin(std::clamp(std::sin(angle) * ratio, -1.0f, 1.0f));
}

}  // namespace limn
