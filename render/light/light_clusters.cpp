#include "render/light/light_clusters.h"

#include "render/shadow/light_bounds.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

/// Relative enlargement of spheres: the GPU's log2 and ours differ in the last bits.
constexpr float kSlack = 1e-3f;
constexpr float kSlackPixels = 0.25f;
constexpr float kMaxDistance = 1e12f;  ///< [m]; the last slice is unbounded
constexpr int kMaxTiles = 256;         ///< per axis: boxes store 8 bits for each end

/// In view space: x right, y up, z along the axis.
Vec3 to_view(const Affine& world_from_camera, const Vec3& v) {
    const auto& r = world_from_camera.row;
    return {
        r[0].x * v.x + r[1].x * v.y + r[2].x * v.z, r[0].y * v.x + r[1].y * v.y + r[2].y * v.z,
        -(r[0].z * v.x + r[1].z * v.y + r[2].z * v.z)};
}

Vec3 camera_position(const RenderView& view) {
    const auto& r = view.world_from_camera.row;
    return {r[0].w, r[1].w, r[2].w};
}

bool is_unbounded(const LightRange& light) {
    return !(light.radius < kMaxDistance);
}

/// Minimum and maximum x / z of a circle about (x, z), seen from the origin.
Vec2 slopes_of_circle(float x, float z, float radius) {
    const float tangent2 = x * x + z * z - radius * radius;
    if (tangent2 <= 0) {
        return {-INFINITY, INFINITY};
    }
    // The two tangents; one that points backward bounds nothing.
    const float tangent = std::sqrt(tangent2);
    const float down = z * tangent + x * radius;
    const float up = z * tangent - x * radius;
    return {
        down > 0 ? (x * tangent - z * radius) / down : -INFINITY,
        up > 0 ? (x * tangent + z * radius) / up : INFINITY};
}

/// Range of tiles between two slopes, both ends included; begin > end: none.
struct TileRange {
    int begin;
    int end;
};
TileRange tiles_between(
    const Vec2& slopes, float tangent, float jitter, int pixels, const ClusterShape& shape,
    int tiles) {
    const float per_slope = 0.5f * static_cast<float>(pixels) / tangent;
    const auto tile_of = [&](float slope, float slack) {
        const float pixel = (slope + tangent) * per_slope + jitter + slack;
        const float tile = std::floor(pixel / static_cast<float>(shape.tile));
        return static_cast<int>(std::clamp(tile, -1.0f, static_cast<float>(tiles)));
    };
    return {
        std::max(tile_of(slopes.x, -kSlackPixels), 0),
        std::min(tile_of(slopes.y, kSlackPixels), tiles - 1)};
}

int slice_of(const ClusterShape& shape, float distance) {
    const float slice = std::floor(std::log2(distance) * shape.depth_scale + shape.depth_bias);
    return static_cast<int>(std::clamp(slice, 0.0f, static_cast<float>(shape.slices - 1)));
}

layout::uvec2 pack(const ClusterBox& box) {
    const auto bits = [](int value, int shift) {
        return static_cast<layout::uint>(value) << shift;
    };
    return {
        bits(box.column[0], 0) | bits(box.column[1], 8) | bits(box.row[0], 16)
            | bits(box.row[1], 24),
        bits(box.slice[0], 0) | bits(box.slice[1], 8)};
}

}  // namespace

ClusterShape make_cluster_shape(const RenderView& view, std::span<const LightRange> reach) {
    ClusterShape shape;
    while (std::max(view.width, view.height) > shape.tile * kMaxTiles) {
        shape.tile *= 2;
    }
    shape.columns = (view.width + shape.tile - 1) / shape.tile;
    shape.rows = (view.height + shape.tile - 1) / shape.tile;
    const Vec3 eye = camera_position(view);
    float farthest = view.near * 100;
    for (const LightRange& light : reach) {
        const float end = to_view(view.world_from_camera, light.center - eye).z + light.radius;
        farthest = std::isfinite(end) ? std::max(farthest, end) : farthest;
    }
    farthest = std::min(farthest, 0.5f * kMaxDistance);
    // The first slice ends at a hundredth of the whole depth or more.
    const float nearest = std::max(view.near, farthest * 0.01f);
    shape.depth_scale = static_cast<float>(shape.slices - 1) / std::log2(farthest / nearest);
    shape.depth_bias = 1.0f - shape.depth_scale * std::log2(nearest);
    return shape;
}

bool find_cells(
    const RenderView& view, const ClusterShape& shape, const LightRange& light, ClusterBox& box) {
    box = {{0, shape.columns - 1}, {0, shape.rows - 1}, {0, shape.slices - 1}};
    if (is_unbounded(light)) {
        return true;
    }
    const RangeSphere around = range_sphere(light);
    const float radius = around.radius * (1 + kSlack);
    const Vec3 c = to_view(view.world_from_camera, around.center - camera_position(view));
    const float end = (c.z + radius) * (1 + kSlack);
    if (!(end > view.near)) {
        return false;
    }
    box.slice[0] = slice_of(shape, std::max(c.z - radius, view.near) * (1 - kSlack));
    box.slice[1] = slice_of(shape, end);
    const TileRange columns = tiles_between(
        slopes_of_circle(c.x, c.z, radius), view.tangent.x, view.jitter.x, view.width, shape,
        shape.columns);
    const TileRange rows = tiles_between(
        slopes_of_circle(c.y, c.z, radius), view.tangent.y, view.jitter.y, view.height, shape,
        shape.rows);
    box.column[0] = columns.begin;
    box.column[1] = columns.end;
    box.row[0] = rows.begin;
    box.row[1] = rows.end;
    return columns.begin <= columns.end && rows.begin <= rows.end;
}

void place_lights(const RenderView& view, const LightList& lights, ClusterLights& clusters) {
    clusters.shape = make_cluster_shape(view, lights.reach);
    clusters.lights.clear();
    clusters.boxes.clear();
    clusters.capacity = 0;
    clusters.dropped = 0;
    const Vec3 eye = camera_position(view);
    for (std::size_t i = 0; i < lights.reach.size(); ++i) {
        const LightRange& light = lights.reach[i];
        ClusterBox box;
        if (!find_cells(view, clusters.shape, light, box)) {
            continue;
        }
        if (clusters.capacity + box.volume() > clusters.max_entries) {
            ++clusters.dropped;
            continue;
        }
        const RangeSphere around = range_sphere(light);
        const float radius2 = is_unbounded(light) ? -1.0f : square(around.radius * (1 + kSlack));
        const auto index = static_cast<float>(i + static_cast<std::size_t>(lights.directional));
        clusters.lights.push_back(
            {Vec4(to_view(view.world_from_camera, around.center - eye), radius2),
             Vec4(to_view(view.world_from_camera, light.center - eye), light.cosine),
             Vec4(to_view(view.world_from_camera, light.axis), index)});
        clusters.boxes.push_back(pack(box));
        clusters.capacity += box.volume();
    }
}

int cell_of(const ClusterShape& shape, float pixel_x, float pixel_y, float distance) {
    const int column = static_cast<int>(pixel_x) / shape.tile;
    const int row = static_cast<int>(pixel_y) / shape.tile;
    return (slice_of(shape, distance) * shape.rows + row) * shape.columns + column;
}

}  // namespace limn
