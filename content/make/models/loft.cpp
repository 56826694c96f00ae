#include "content/make/models/loft.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn {

namespace {

constexpr int kPieces = 8;    ///< between two stations
constexpr float kFar = 2.5f;  ///< from where the ball around it will do; wider than any blend

template <typename T>
T catmull_rom(const T& a, const T& b, const T& c, const T& d, float t) {
    return 0.5f
           * (2.0f * b + t * (c - a) + t * t * (2.0f * a - 5.0f * b + 4.0f * c - d)
              + t * t * t * (3.0f * (b - c) + d - a));
}

struct Section {
    Vec3 center;
    Vec4 radii;
};

Section section_at(std::span<const LoftStation> stations, std::size_t k, float t) {
    const std::size_t last = stations.size() - 1;
    const auto& a = stations[k == 0 ? 0 : k - 1];
    const auto& b = stations[k];
    const auto& c = stations[k + 1];
    const auto& d = stations[std::min(k + 2, last)];
    const auto radii = [](const LoftStation& s) { return Vec4(s.right, s.up, s.left, s.down); };
    return {
        catmull_rom(a.center, b.center, c.center, d.center, t),
        catmull_rom(radii(a), radii(b), radii(c), radii(d), t)};
}

float piece_distance(const LoftPiece& piece, const Vec3& p) {
    const Vec3 from = p - piece.begin;
    const float along = glm::dot(from, piece.axis) / piece.length2;
    const float t = std::clamp(along, 0.0f, 1.0f);
    const Vec4 radii = glm::mix(piece.first, piece.last, t);
    const float x = glm::dot(from, piece.right);
    const float y = glm::dot(from, piece.up);
    const float cap = along < 0 ? piece.first_cap : piece.last_cap;
    const float z = cap > 0 ? (along - t) * std::sqrt(piece.length2) : 0.0f;
    const Vec3 r(x < 0 ? radii.z : radii.x, y < 0 ? radii.w : radii.y, cap > 0 ? cap : 1.0f);
    const Vec3 scaled = Vec3(x, y, z) / r;
    const float k0 = glm::length(scaled);
    const float k1 = glm::length(scaled / r);
    return k1 > 0.0f ? k0 * (k0 - 1.0f) / k1 : -std::min(r.x, r.y);
}

}  // namespace

Loft make_loft(const LoftShape& shape) {
    LIMN_CHECK(shape.stations.size() >= 2);
    std::vector<Section> sections;
    for (std::size_t k = 0; k + 1 < shape.stations.size(); ++k) {
        for (int i = 0; i < kPieces; ++i) {
            sections.push_back(
                section_at(shape.stations, k, static_cast<float>(i) / static_cast<float>(kPieces)));
        }
    }
    sections.push_back(section_at(shape.stations, shape.stations.size() - 2, 1));
    Loft loft;
    float widest = std::max(shape.first_cap, shape.last_cap);
    Vec3 low = sections.front().center;
    Vec3 high = low;
    for (std::size_t i = 0; i < sections.size(); ++i) {
        const Section& a = sections[i];
        low = glm::min(low, a.center);
        high = glm::max(high, a.center);
        widest = std::max({widest, a.radii.x, a.radii.y, a.radii.z, a.radii.w});
        if (i + 1 == sections.size()) {
            break;
        }
        const Section& b = sections[i + 1];
        const Vec3 axis = b.center - a.center;
        const Vec3 right = glm::normalize(glm::cross(axis, shape.up));
        loft.pieces.push_back(
            {.begin = a.center,
             .axis = axis,
             .right = right,
             .up = glm::normalize(glm::cross(right, axis)),
             .first = a.radii,
             .last = b.radii,
             .first_cap = i == 0 ? shape.first_cap : 0.0f,
             .last_cap = i + 2 == sections.size() ? shape.last_cap : 0.0f,
             .length2 = glm::dot(axis, axis)});
    }
    loft.center = 0.5f * (low + high);
    loft.reach = 0.5f * glm::distance(low, high) + widest;
    return loft;
}

float loft_distance(const Loft& loft, const Vec3& p) {
    const float outside = glm::distance(p, loft.center) - loft.reach;
    if (outside > kFar) {
        return outside;
    }
    const LoftPiece* nearest = nullptr;
    float nearest2 = 1e30f;
    for (const LoftPiece& piece : loft.pieces) {
        const Vec3 from = p - piece.begin;
        const float t = std::clamp(glm::dot(from, piece.axis) / piece.length2, 0.0f, 1.0f);
        const Vec3 q = from - t * piece.axis;
        const float distance2 = glm::dot(q, q);
        if (distance2 < nearest2) {
            nearest2 = distance2;
            nearest = &piece;
        }
    }
    return nearest != nullptr ? piece_distance(*nearest, p) : outside;
}

}  // namespace limn
