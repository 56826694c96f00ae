#include "content/make/head_clay.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn {

namespace {

constexpr float kFar = 100;  // [cm]

/// Scaled so that its gradient is about 1 near the surface.
float solid_distance(const Solid& solid, const Vec3& p) {
    const Vec3 along = solid.b - solid.a;
    const float length2 = glm::dot(along, along);
    const float t =
        length2 > 0 ? glm::clamp(glm::dot(p - solid.a, along) / length2, 0.0f, 1.0f) : 0.0f;
    const Vec3 radii = glm::mix(solid.ra, solid.rb, t);
    const Vec3 q = p - solid.a - t * along;
    const float k0 = glm::length(q / radii);
    const float k1 = glm::length(q / (radii * radii));
    return k1 > 1e-6f ? k0 * (k0 - 1) / k1 : -std::min({radii.x, radii.y, radii.z});
}

/// Smooth minimum that begins to blend where the distances differ by `width`.
float blend_min(float a, float b, float width) {
    const float h = std::max(width - std::abs(a - b), 0.0f) / width;
    return std::min(a, b) - h * h * width * 0.25f;
}

bool contains(const StrokePath& path, const Vec3& p) {
    return p.x > path.low.x && p.y > path.low.y && p.z > path.low.z && p.x < path.high.x
           && p.y < path.high.y && p.z < path.high.z;
}

/// To the curve, by its nearest chord [cm].
float path_distance(const StrokePath& path, const Vec3& p) {
    float nearest2 = kFar * kFar;
    for (std::size_t i = 1; i < path.points.size(); ++i) {
        const Vec3 from = path.points[i - 1];
        const Vec3 chord = path.points[i] - from;
        const float s = glm::clamp(glm::dot(p - from, chord) / glm::dot(chord, chord), 0.0f, 1.0f);
        const Vec3 offset = p - from - s * chord;
        nearest2 = std::min(nearest2, glm::dot(offset, offset));
    }
    return std::sqrt(nearest2);
}

}  // namespace

float join(float distance, std::span<const Solid> solids, const Vec3& p) {
    for (const Solid& solid : solids) {
        const float other = solid_distance(solid, p);
        distance = solid.blend > 0 ? blend_min(distance, other, solid.blend)
                                   : -blend_min(-distance, other, -solid.blend);
    }
    return distance;
}

std::vector<StrokePath>
make_stroke_paths(std::span<const Stroke> strokes, const std::function<Vec3(const Vec3&)>& place) {
    std::vector<StrokePath> paths(strokes.size());
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        const Stroke& stroke = strokes[i];
        StrokePath& path = paths[i];
        path.low = Vec3(kFar);
        path.high = Vec3(-kFar);
        for (std::size_t k = 0; k < path.points.size(); ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(path.points.size() - 1);
            const Vec3 p =
                glm::mix(glm::mix(stroke.a, stroke.b, t), glm::mix(stroke.b, stroke.c, t), t);
            path.points[k] = place ? place(p) : p;
            path.low = glm::min(path.low, path.points[k] - 3 * stroke.radius);
            path.high = glm::max(path.high, path.points[k] + 3 * stroke.radius);
        }
    }
    return paths;
}

float relief(
    std::span<const Stroke> strokes, std::span<const StrokePath> paths, const Vec3& p,
    const HeadShape& shape) {
    float height = 0;
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        if (!contains(paths[i], p)) {
            continue;
        }
        const Stroke& stroke = strokes[i];
        const float amount = stroke.amount + stroke.sex * shape.sex + stroke.build * shape.build
                             + stroke.age * (shape.age - 0.3f);
        height += amount * std::exp(-square(path_distance(paths[i], p) / stroke.radius));
    }
    return height;
}

}  // namespace limn
