#include "render/shadow/light_bounds.h"

#include "render/light/light_list.h"
#include "render/render_view.h"

#include <glm/geometric.hpp>

#include <algorithm>

// Techniques: shadow.caster-cull, shadow.depth-bounds, shadow.light-scissor

namespace limn {
namespace {

Vec3 axis(const Affine& a, int column) {
    return {a.row[0][column], a.row[1][column], a.row[2][column]};
}

struct PixelRange {
    int first;
    int count;
};

/// Converts slopes to pixels: the image spans -tangent .. tangent, shifted by `jitter` [px].
PixelRange to_pixels(const SlopeRange& slopes, float tangent, float jitter, int size) {
    const auto extent = static_cast<float>(size);
    const auto pixel = [&](float slope) {
        const float x = 0.5f * (slope / tangent + 1) * extent + jitter;
        return std::clamp(x, 0.0f, extent);
    };
    const int first = static_cast<int>(std::floor(pixel(slopes.low)));
    const int end = static_cast<int>(std::ceil(pixel(slopes.high)));
    return {first, end - first};
}

}  // namespace

void grow(LightBounds& bounds, const LightBounds& other) {
    if (is_empty(bounds) || is_empty(other)) {
        bounds = is_empty(other) ? bounds : other;
        return;
    }
    const int right = std::max(bounds.x + bounds.width, other.x + other.width);
    const int top = std::max(bounds.y + bounds.height, other.y + other.height);
    bounds.x = std::min(bounds.x, other.x);
    bounds.y = std::min(bounds.y, other.y);
    bounds.width = right - bounds.x;
    bounds.height = top - bounds.y;
    bounds.depth_min = std::min(bounds.depth_min, other.depth_min);
    bounds.depth_max = std::max(bounds.depth_max, other.depth_max);
}

SlopeRange sphere_slopes(float x, float z, float radius, float near) {
    const double d2 = square(static_cast<double>(x)) + square(static_cast<double>(z));
    const double r2 = square(static_cast<double>(radius));
    const double n = near;
    // Where the near plane cuts the circle; beyond `half` it does not.
    const double cut = r2 - square(n + static_cast<double>(z));
    const double half = std::sqrt(std::max(cut, 0.0));
    const auto edge = [&](double sign) {
        if (d2 > r2) {
            // The tangent from the eye touches at distance t, in the direction of the center
            // rotated by the angle of sine r / d.
            const double t2 = d2 - r2;
            const double scale = std::sqrt(t2) / d2;
            const double tx = scale * (std::sqrt(t2) * x - sign * radius * z);
            const double tz = scale * (sign * radius * x + std::sqrt(t2) * z);
            if (tz <= -n) {
                return tx / -tz;
            }
        }
        return (x + sign * half) / n;
    };
    // Rounding must not cut off visible parts.
    const double low = edge(-1);
    const double high = edge(1);
    return {
        static_cast<float>(low - 1e-6 * std::abs(low)),
        static_cast<float>(high + 1e-6 * std::abs(high))};
}

LightBounds light_bounds(const RenderView& view, const Vec3& center, float radius) {
    LightBounds bounds = {0, 0, view.width, view.height, 0, 1};
    if (!std::isfinite(radius)) {
        return bounds;
    }
    const Affine& camera = view.world_from_camera;
    const Vec3 offset = center - Vec3(camera.row[0].w, camera.row[1].w, camera.row[2].w);
    const Vec3 c = {
        glm::dot(offset, axis(camera, 0)), glm::dot(offset, axis(camera, 1)),
        glm::dot(offset, axis(camera, 2))};
    const float nearest = -c.z - radius;
    const float farthest = -c.z + radius;
    if (farthest <= view.near) {
        return {};
    }
    bounds.depth_max = view.near / std::max(nearest, view.near);
    bounds.depth_min = view.near / farthest;
    if (glm::dot(c, c) <= square(radius)) {
        return bounds;  // the eye is inside the sphere
    }
    const PixelRange across = to_pixels(
        sphere_slopes(c.x, c.z, radius, view.near), view.tangent.x, view.jitter.x, view.width);
    const PixelRange up = to_pixels(
        sphere_slopes(c.y, c.z, radius, view.near), view.tangent.y, view.jitter.y, view.height);
    if (across.count <= 0 || up.count <= 0) {
        return {};
    }
    bounds.x = across.first;
    bounds.y = up.first;
    bounds.width = across.count;
    bounds.height = up.count;
    return bounds;
}

RangeSphere range_sphere(const LightRange& range) {
    // A sector of half angle up to 45 degrees fits into the sphere through its apex and rim; a
    // wider one, up to 90 degrees, into the sphere around the rim.
    const bool cone = range.axis != Vec3(0) && range.cosine > 0 && std::isfinite(range.radius);
    if (!cone) {
        return {range.center, range.radius};
    }
    if (2 * square(range.cosine) >= 1) {
        const float r = 0.5f * range.radius / range.cosine;
        return {range.center + range.axis * r, r};
    }
    const float sine = std::sqrt(1 - square(range.cosine));
    return {range.center + range.axis * (range.radius * range.cosine), range.radius * sine};
}

bool reaches_box(const LightRange& range, const Bounds& box) {
    const Vec3 nearest = glm::clamp(range.center, box.min, box.max);
    const Vec3 offset = nearest - range.center;
    if (glm::dot(offset, offset) > square(range.radius)) {
        return false;
    }
    if (range.axis == Vec3(0) || range.cosine <= 0) {
        return true;
    }
    // The sphere around the box against the cone, moved back along its axis to account for the
    // sphere's radius.
    const Vec3 to_box = center(box) - range.center;
    const float radius = glm::length(half_extent(box));
    const float along = glm::dot(to_box, range.axis);
    const float across = std::sqrt(std::max(glm::dot(to_box, to_box) - square(along), 0.0f));
    const float sine = std::sqrt(std::max(1 - square(range.cosine), 0.0f));
    return across * range.cosine - along * sine <= radius;
}

}  // namespace limn
