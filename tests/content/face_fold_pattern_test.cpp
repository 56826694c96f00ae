#include "content/make/head/face_fold_pattern.h"
#include "content/make/head/head.h"
#include "content/make/head/head_layout.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::face_fold_pattern_test {
namespace {

/// The slope of the map at a texture coordinate, decoded as by wrinkle_slopes.
Vec2 slope_at(const ImageData& map, const Vec2& uv) {
    const auto texel = [](float at, int size) {
        return std::clamp(static_cast<int>(at * static_cast<float>(size)), 0, size - 1);
    };
    const auto i = static_cast<std::size_t>(
        4 * (texel(uv.y, map.height) * map.width + texel(uv.x, map.width)));
    const auto component = [&](std::size_t k) {
        return (static_cast<float>(map.pixels[i + k]) - 128.0f) / 127.0f;
    };
    return Vec2(component(0), component(1)) / -std::max(component(2), 0.05f);
}

/// Mean squares of slopes where a region has weight: across its folds, and in all directions.
struct Steepness {
    double across = 0;
    double all = 0;
};

Steepness measure(const MeshData& head, const VertexRegion& region, const ImageData& map) {
    Steepness sum;
    for (std::size_t v = 0; v < head.positions.size(); ++v) {
        if (region.weights[v] < 0.5f) {
            continue;
        }
        const Vec3 tangent = head.tangents[v];
        const Vec3 bitangent = head.tangents[v].w * glm::cross(head.normals[v], tangent);
        const Vec2 across = {
            glm::dot(region.across[v], tangent), glm::dot(region.across[v], bitangent)};
        const Vec2 slope = slope_at(map, head.uvs[v]);
        sum.across += static_cast<double>(glm::dot(slope, across) * glm::dot(slope, across));
        sum.all += static_cast<double>(glm::dot(slope, slope));
    }
    return sum;
}

}  // namespace

TEST_CASE("face folds: lines of a region lie across the direction whose shortening raises them") {
    const MeshData head = make_head({});
    FaceFoldsPattern pattern;
    pattern.image.size = 512;
    const PatternMaps maps = make_face_folds(pattern);
    std::size_t regions = 0;
    for (const VertexRegion& region : head.regions) {
        const bool has_lines = region.name != "upper_lid" && region.name != "cheek";
        if (region.across.empty() || !has_lines) {
            continue;
        }
        const Steepness steepness = measure(head, region, maps.normal);
        CAPTURE(region.name);
        CAPTURE(steepness.across / steepness.all);
        CHECK(steepness.all > 1e-3);
        CHECK(steepness.across >= 0.5 * steepness.all);
        ++regions;
    }
    CHECK(regions == 12);
}

TEST_CASE("face folds: lines that cross the midline of the face are smooth there") {
    FaceFoldsPattern pattern;
    pattern.image.size = 1024;
    pattern.wander = 0;
    const PatternMaps maps = make_face_folds(pattern);
    float along = 0;
    float aside = 0;
    const int chin = 1024 * (52 + 13) / (kHeadRows + 13);  // its dimples are not mirrored
    for (int row = 0; row < chin; ++row) {
        for (const float column : {511.5f, 512.5f}) {
            const Vec2 slope =
                slope_at(maps.normal, Vec2(column, static_cast<float>(row) + 0.5f) / 1024.0f);
            along = std::max(along, std::abs(slope.y));
            aside = std::max(aside, std::abs(slope.x));
        }
    }
    CHECK(along > 0.3f);
    CHECK(aside < 0.05f * along);
}

namespace {

/// The largest difference of a slope and the mean of its four neighbors.
float roughness_of(const ImageData& map) {
    const auto slope = [&](int x, int y) {
        return slope_at(map, (Vec2(x, y) + 0.5f) / Vec2(map.width, map.height));
    };
    float largest = 0;
    const int chin = map.height * (55 + 13) / (kHeadRows + 13);  // above its dimples
    for (int y = 1; y < chin; ++y) {
        for (int x = 1; x + 1 < map.width; ++x) {
            const Vec2 mean =
                0.25f * (slope(x + 1, y) + slope(x - 1, y) + slope(x, y + 1) + slope(x, y - 1));
            largest = std::max(largest, glm::length(slope(x, y) - mean));
        }
    }
    return largest;
}

/// Valleys along a row between two columns, at least a fifth as deep from both sides as the
/// deepest.
int count_valleys(const ImageData& map, float row, float from, float to) {
    constexpr float kStep = 0.05f;  // columns
    std::vector<float> heights = {0};
    for (float column = from; column < to; column += kStep) {
        const Vec2 uv = {0.5f + column / kHeadColumns, (row + 13) / (kHeadRows + 13)};
        heights.push_back(heights.back() + kStep * slope_at(map, uv).x);
    }
    const auto [low, high] = std::ranges::minmax(heights);
    const float deep = 0.2f * (high - low);
    int valleys = 0;
    float top = heights[0];
    float bottom = heights[0];
    for (const float height : heights) {
        bottom = std::min(bottom, height);
        if (top - bottom > deep && height - bottom > deep) {
            ++valleys;
            top = height;
            bottom = height;
        }
        top = std::max(top, height);
        bottom = height >= top ? height : bottom;
    }
    return valleys;
}

}  // namespace

TEST_CASE("face folds: on a map of twice the size neighbors differ half as much") {
    FaceFoldsPattern pattern;
    pattern.image.size = 1024;
    const float coarse = roughness_of(make_face_folds(pattern).normal);
    pattern.image.size = 2048;
    const float fine = roughness_of(make_face_folds(pattern).normal);
    CAPTURE(coarse);
    CAPTURE(fine);
    CHECK(fine < 0.65f * coarse);
}

TEST_CASE("face folds: no second fold appears beside the nasolabial fold") {
    FaceFoldsPattern pattern;
    pattern.image.size = 1024;
    for (const int seed : {1, 2, 3}) {
        pattern.image.seed = seed;
        const PatternMaps maps = make_face_folds(pattern);
        for (float row = 42; row <= 50; row += 2) {
            CAPTURE(seed);
            CAPTURE(row);
            CHECK(count_valleys(maps.normal, row, 6.9f, 13.5f) == 1);
            CHECK(count_valleys(maps.normal, row, -13.5f, -6.9f) == 1);
        }
    }
}

}  // namespace limn::face_fold_pattern_test
