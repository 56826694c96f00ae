#include "render/water/water_patches.h"

#include "render/shaders/water_gpu.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {

namespace {

constexpr auto kMaxPatches = static_cast<std::size_t>(kMaxWaterPatches);

float distance_to(const Bounds& box, const Vec3& point) {
    return glm::length(glm::max(glm::max(box.min - point, point - box.max), Vec3(0)));
}

/// Whether low .. high lies wholly outside -half .. half.
bool is_beyond(float half, float low, float high) {
    return half > 0 && (low >= half || high <= -half);
}

bool is_visible(const Frustum& frustum, const Bounds& box) {
    const Vec3 midpoint = center(box);
    const Vec3 half = half_extent(box);
    return std::all_of(
        std::begin(frustum.planes), std::end(frustum.planes), [&](const Vec4& plane) {
            const Vec3 normal(plane);
            return glm::dot(normal, midpoint) + glm::dot(glm::abs(normal), half) + plane.w >= 0;
        });
}

/// The nearest of four squares around `center`; the others from near to far are this index
/// xor 1, 2 and 3.
int nearest_square(const Vec2& center, const Vec3& camera) {
    return (camera.x > center.x ? 1 : 0) + (camera.z > center.y ? 2 : 0);
}

void walk(
    const PatchSource& source, const Vec2& corner, float size, std::vector<WaterPatch>& patches) {
    const Vec2 end = corner + size;
    const Bounds box = {
        Vec3(corner.x, 0, corner.y) - source.margin, Vec3(end.x, 0, end.y) + source.margin};
    if (is_beyond(source.half.x, corner.x, end.x) || is_beyond(source.half.y, corner.y, end.y)
        || !is_visible(source.frustum, box)) {
        return;
    }
    const bool near = distance_to(box, source.camera) < source.detail * size;
    if (near && size > source.finest && patches.size() + 4 < kMaxPatches) {
        const int nearest = nearest_square(corner + 0.5f * size, source.camera);
        for (int i = 0; i < 4; ++i) {
            const int square = nearest ^ i;
            walk(source, corner + 0.5f * size * Vec2(square % 2, square / 2), 0.5f * size, patches);
        }
    } else if (patches.size() < kMaxPatches) {
        patches.push_back(
            {.corner = corner,
             .size = size,
             .body = source.body,
             .morph_begin = 1.6f * source.detail * size,
             .morph_end = 2.0f * source.detail * size});
    }
}

}  // namespace

void resolve_lines(std::span<const WaveLine> lines, std::span<WaterPatch> patches) {
    for (WaterPatch& patch : patches) {
        const float spacing = patch.size / static_cast<float>(layout::kWaterGrid);
        const auto first =
            std::partition_point(lines.begin(), lines.end(), [&](const WaveLine& line) {
                return spacing * glm::length(line.k) < kPi;
            });
        patch.lines = static_cast<float>(first - lines.begin());
        patch.variance = 0;
        for (auto line = first; line != lines.end(); ++line) {
            patch.variance += slope_variance(*line);
        }
    }
}

void append_water_patches(const PatchSource& source, std::vector<WaterPatch>& patches) {
    if (source.half.x > 0 && source.half.y > 0) {
        const float half = std::max(source.half.x, source.half.y);
        walk(source, Vec2(-half), 2 * half, patches);
        return;
    }
    // Four squares of a fixed lattice around the camera.
    const Vec2 midpoint =
        glm::floor(Vec2(source.camera.x, source.camera.z) / kWaterRange + 0.5f) * kWaterRange;
    const int nearest = nearest_square(midpoint, source.camera);
    for (int i = 0; i < 4; ++i) {
        const int square = nearest ^ i;
        walk(
            source, midpoint - kWaterRange * Vec2(1 - square % 2, 1 - square / 2), kWaterRange,
            patches);
    }
}

}  // namespace limn
