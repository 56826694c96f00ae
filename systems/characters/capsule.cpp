#include "systems/characters/capsule.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

/// Where the segment crosses the inside of the triangle.
std::optional<Vec3> crossing(const Vec3& from, const Vec3& to, const TriangleCorners& t) {
    const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const float begin = glm::dot(from - t[0], normal);
    const float end = glm::dot(to - t[0], normal);
    if (!(begin * end < 0)) {
        return std::nullopt;
    }
    const Vec3 point = glm::mix(from, to, begin / (begin - end));
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = t[(i + 1) % 3] - t[i];
        if (glm::dot(glm::cross(edge, point - t[i]), normal) < 0) {
            return std::nullopt;
        }
    }
    return point;
}

}  // namespace

Vec3 nearest_on_triangle(const TriangleCorners& t, const Vec3& point) {
    const Vec3 ab = t[1] - t[0];
    const Vec3 ac = t[2] - t[0];
    const Vec3 ap = point - t[0];
    const float d1 = glm::dot(ab, ap);
    const float d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        return t[0];
    }
    const Vec3 bp = point - t[1];
    const float d3 = glm::dot(ab, bp);
    const float d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        return t[1];
    }
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {
        return t[0] + d1 / (d1 - d3) * ab;
    }
    const Vec3 cp = point - t[2];
    const float d5 = glm::dot(ab, cp);
    const float d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        return t[2];
    }
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
        return t[0] + d2 / (d2 - d6) * ac;
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6 && (d4 - d3) + (d5 - d6) > 0) {
        return t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]);
    }
    const float sum = va + vb + vc;
    return sum > 0 ? t[0] + vb / sum * ab + vc / sum * ac : t[0];
}

NearestPoints nearest_of_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
    const Vec3 u = a1 - a0;
    const Vec3 v = b1 - b0;
    const Vec3 w = a0 - b0;
    const float uu = glm::dot(u, u);
    const float vv = glm::dot(v, v);
    const float uv = glm::dot(u, v);
    const float uw = glm::dot(u, w);
    const float vw = glm::dot(v, w);
    const float denominator = uu * vv - uv * uv;
    float s = denominator > 1e-12f * uu * vv
                  ? std::clamp((uv * vw - uw * vv) / denominator, 0.0f, 1.0f)
                  : 0.0f;
    float t = vv > 0 ? (uv * s + vw) / vv : 0.0f;
    if (!(t >= 0 && t <= 1)) {
        t = std::clamp(t, 0.0f, 1.0f);
    }
    s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0f, 1.0f) : 0.0f;
    const Vec3 a = a0 + s * u;
    const Vec3 b = b0 + t * v;
    return {a, b, glm::distance(a, b)};
}

std::optional<CapsuleContact>
touch_triangle(const Capsule& capsule, const TriangleCorners& triangle) {
    const Vec3 face =
        normalize_or(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]), Vec3(0));
    if (const std::optional<Vec3> point = crossing(capsule.low, capsule.high, triangle)) {
        const float low = glm::dot(capsule.low - *point, face);
        const float high = glm::dot(capsule.high - *point, face);
        const float side = low + high < 0 ? -1.0f : 1.0f;
        return CapsuleContact{
            side * face, capsule.radius - std::min(side * low, side * high), *point};
    }
    NearestPoints nearest = {capsule.low, nearest_on_triangle(triangle, capsule.low), INFINITY};
    nearest.distance = glm::distance(nearest.a, nearest.b);
    const Vec3 from_high = nearest_on_triangle(triangle, capsule.high);
    if (const float d = glm::distance(capsule.high, from_high); d < nearest.distance) {
        nearest = {capsule.high, from_high, d};
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const NearestPoints edge =
            nearest_of_segments(capsule.low, capsule.high, triangle[i], triangle[(i + 1) % 3]);
        if (edge.distance < nearest.distance) {
            nearest = edge;
        }
    }
    if (!(nearest.distance < capsule.radius)) {
        return std::nullopt;
    }
    const Vec3 normal = normalize_or(nearest.a - nearest.b, face);
    if (normal == Vec3(0)) {
        return std::nullopt;
    }
    return CapsuleContact{normal, capsule.radius - nearest.distance, nearest.b};
}

}  // namespace limn
