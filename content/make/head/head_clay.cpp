#include "content/make/head/head_clay.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn {

namespace {

constexpr float kFar = 100;  // [cm]

template <typename Number>
Number dot_of(const PointOf<Number>& a, const PointOf<Number>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename Number>
PointOf<Number> offset_from(const Vec3& from, const PointOf<Number>& p) {
    return {p.x - from.x, p.y - from.y, p.z - from.z};
}

/// `p` along `chord`: 0 at its start, 1 at its end. `p` is an offset from its start.
template <typename Number>
Number along_chord(const PointOf<Number>& p, const Vec3& chord, float length2) {
    return saturated<Number>((p.x * chord.x + p.y * chord.y + p.z * chord.z) / length2);
}

/// `p` without `t` of `chord`.
template <typename Number>
PointOf<Number> beside_chord(const PointOf<Number>& p, const Number& t, const Vec3& chord) {
    return {p.x - t * chord.x, p.y - t * chord.y, p.z - t * chord.z};
}

template <typename Number>
Number divided_length(const PointOf<Number>& p, const PointOf<Number>& by) {
    const PointOf<Number> q = {p.x / by.x, p.y / by.y, p.z / by.z};
    return root_of(dot_of(q, q));
}

/// Scaled so that its gradient is about 1 near the surface.
template <typename Number>
Number solid_distance(const Solid& solid, const PointOf<Number>& p) {
    const Vec3 along = solid.b - solid.a;
    const float length2 = glm::dot(along, along);
    const PointOf<Number> offset = offset_from(solid.a, p);
    const Number t = length2 > 0 ? along_chord(offset, along, length2) : same_for_all<Number>(0);
    const auto radius = [&](float a, float b) { return a * (1 - t) + b * t; };
    const PointOf<Number> radii = {
        radius(solid.ra.x, solid.rb.x), radius(solid.ra.y, solid.rb.y),
        radius(solid.ra.z, solid.rb.z)};
    const PointOf<Number> squares = {radii.x * radii.x, radii.y * radii.y, radii.z * radii.z};
    const PointOf<Number> q = beside_chord(offset, t, along);
    const Number k0 = divided_length(q, radii);
    const Number k1 = divided_length(q, squares);
    const Number inside = -smaller_of(smaller_of(radii.x, radii.y), radii.z);
    return k1 > 1e-6f ? k0 * (k0 - 1) / k1 : inside;
}

/// Smooth minimum that begins to blend where the distances differ by `width`.
template <typename Number>
Number blend_min(const Number& a, const Number& b, float width) {
    const Number h = larger_of(width - absolute(a - b), same_for_all<Number>(0)) / width;
    return smaller_of(a, b) - h * h * width * 0.25f;
}

bool contains(const StrokePath& path, const PointOf<float>& p) {
    return p.x > path.low.x && p.y > path.low.y && p.z > path.low.z && p.x < path.high.x
           && p.y < path.high.y && p.z < path.high.z;
}

/// For each of the four points.
auto contains(const StrokePath& path, const PointOf<Four>& p) {
    return (p.x > path.low.x) & (p.y > path.low.y) & (p.z > path.low.z) & (p.x < path.high.x)
           & (p.y < path.high.y) & (p.z < path.high.z);
}

/// Distance to the nearest chord of the curve [cm].
template <typename Number>
Number path_distance(const StrokePath& path, const PointOf<Number>& p) {
    Number nearest2 = same_for_all<Number>(kFar * kFar);
    for (std::size_t i = 1; i < path.points.size(); ++i) {
        const Vec3 from = path.points[i - 1];
        const Vec3 chord = path.points[i] - from;
        const PointOf<Number> offset = offset_from(from, p);
        const Number t = along_chord(offset, chord, glm::dot(chord, chord));
        const PointOf<Number> beside = beside_chord(offset, t, chord);
        nearest2 = smaller_of(nearest2, dot_of(beside, beside));
    }
    return root_of(nearest2);
}

}  // namespace

template <typename Number>
Number join(Number distance, std::span<const Solid> solids, const PointOf<Number>& p) {
    for (const Solid& solid : solids) {
        const Number other = solid_distance(solid, p);
        distance = solid.blend > 0 ? blend_min(distance, other, solid.blend)
                                   : -blend_min<Number>(-distance, other, -solid.blend);
    }
    return distance;
}

template float join(float, std::span<const Solid>, const PointOf<float>&);
template Four join(Four, std::span<const Solid>, const PointOf<Four>&);

std::vector<StrokePath>
make_stroke_paths(std::span<const Stroke> strokes, const std::function<Vec3(const Vec3&)>& map) {
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
            path.points[k] = map ? map(p) : p;
            path.low = glm::min(path.low, path.points[k] - 3 * stroke.radius);
            path.high = glm::max(path.high, path.points[k] + 3 * stroke.radius);
        }
    }
    return paths;
}

template <typename Number>
Number relief(
    std::span<const Stroke> strokes, std::span<const StrokePath> paths, const PointOf<Number>& p,
    const HeadShape& shape) {
    Number height = same_for_all<Number>(0);
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        const auto inside = contains(paths[i], p);
        if (!any_of(inside)) {
            continue;
        }
        const Stroke& stroke = strokes[i];
        const float amount = stroke.amount + stroke.sex * shape.sex + stroke.build * shape.build
                             + stroke.age * (shape.age - 0.3f);
        const Number distance = path_distance(paths[i], p) / stroke.radius;
        const Number weight =
            map_each(-(distance * distance), [](float one) { return std::exp(one); });
        height += inside ? amount * weight : same_for_all<Number>(0);
    }
    return height;
}

template float relief(
    std::span<const Stroke>, std::span<const StrokePath>, const PointOf<float>&, const HeadShape&);
template Four relief(
    std::span<const Stroke>, std::span<const StrokePath>, const PointOf<Four>&, const HeadShape&);

}  // namespace limn
