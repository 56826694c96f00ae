#include "content/make/face_fold_pattern.h"
#include "content/make/head.h"
#include "content/make/head_layout.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

using namespace limn;

namespace {

/// The slope that the map stands for at a texture coordinate, as wrinkle_slopes has it.
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

TEST_CASE("face folds: lines that cross the middle of the face are smooth there") {
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
