#include "systems/animation/deformer_kernels.h"

#include "ecs/components/deformers.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

/// Pulls of muscles, which add, and the most distant point that they pull to.
struct Pull {
    Vec3 sum{0};
    float farthest = 0.0f;
};

/// Arc cosine for 0 <= x <= 1 within 2e-8: M. Abramowitz and I. Stegun, "Handbook of Mathematical
/// Functions", 1964, 4.4.46. GLSL's own may be off by 1e-4.
float arc_cosine(float x) {
    constexpr std::array kTerms{-0.0012624911f, 0.0066700901f, -0.0170881256f, 0.0308918810f,
                                -0.0501743046f, 0.0889789874f, -0.2145988016f, 1.5707963050f};
    float sum = 0.0f;
    for (const float term : kTerms) {
        sum = sum * x + term;
    }
    return std::sqrt(1.0f - x) * sum;
}

void add_muscle(const Vec4* record, const Vec3& p, Pull& pull) {
    const Vec3 to_attachment = Vec3(record[1]) - p;
    const float distance = glm::length(to_attachment);
    const float full = record[1].w;
    const float reach = record[2].w;
    if (!(distance > 0.0f) || distance >= reach) {
        return;
    }
    const float cosine = -glm::dot(to_attachment, Vec3(record[2])) / distance;
    const float off_axis = arc_cosine(std::clamp(cosine, 0.0f, 1.0f)) / record[0].z;
    if (off_axis >= 1.0f) {
        return;
    }
    const float beyond = std::max((distance - full) / (reach - full), 0.0f);
    const float rise = std::sin(0.5f * kPi * std::min(distance / full, 1.0f));
    const float strength =
        rise * square(std::cos(0.5f * kPi * beyond)) * square(std::cos(0.5f * kPi * off_axis));
    pull.sum += (record[0].y * strength / distance) * to_attachment;
    pull.farthest = std::max(pull.farthest, distance);
}

void add_sphincter(const Vec4* record, const Vec3& p, Pull& pull) {
    const Vec3 to_center = Vec3(record[1]) - p;
    const Vec3 q(
        glm::dot(Vec3(record[2]), to_center), glm::dot(Vec3(record[3]), to_center),
        glm::dot(Vec3(record[4]), to_center));
    const float strength = 1.0f - glm::length(q);
    if (strength <= 0.0f) {
        return;
    }
    const Vec3 deep = record[4].w * Vec3(record[4]);
    const Vec3 inward = to_center - glm::dot(to_center, deep) * deep;
    pull.sum += record[0].y * strength * inward;
    pull.farthest = std::max(pull.farthest, glm::length(inward));
}

std::array<float, 4> bernstein(float t) {
    const float s = 1.0f - t;
    return {s * s * s, 3.0f * t * s * s, 3.0f * t * t * s, t * t * t};
}

Vec3 through_lattice(const Vec4* record, const Vec3& p) {
    const Vec3 from_origin = p - Vec3(record[1]);
    const Vec3 q(
        glm::dot(Vec3(record[2]), from_origin), glm::dot(Vec3(record[3]), from_origin),
        glm::dot(Vec3(record[4]), from_origin));
    if (glm::any(glm::lessThan(q, Vec3(0))) || glm::any(glm::greaterThan(q, Vec3(1)))) {
        return p;
    }
    const std::array<float, 4> bu = bernstein(q.x);
    const std::array<float, 4> bv = bernstein(q.y);
    const std::array<float, 4> bw = bernstein(q.z);
    Vec3 moved = p;
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t i = 0; i < 4; ++i) {
                moved += bu[i] * bv[j] * bw[k] * Vec3(record[5 + i + 4 * j + 16 * k]);
            }
        }
    }
    return moved;
}

}  // namespace

Vec3 deform_point(std::span<const Vec4> packed, const Vec3& point) {
    Pull pull;
    std::size_t i = 1;
    while (i < packed.size() && packed[i].x != kLattice) {
        if (packed[i].x == kMuscle) {
            add_muscle(&packed[i], point, pull);
            i += kMuscleTexels;
        } else {
            add_sphincter(&packed[i], point, pull);
            i += kSphincterTexels;
        }
    }
    const float length = glm::length(pull.sum);
    Vec3 moved = point + (length > pull.farthest ? (pull.farthest / length) * pull.sum : pull.sum);
    for (; i < packed.size(); i += kLatticeTexels) {
        moved = through_lattice(&packed[i], moved);
    }
    return moved;
}

Vec3 deform_normal(std::span<const Vec4> packed, const Vec3& point, const Vec3& normal) {
    if (packed.empty()) {
        return normal;
    }
    const Vec3 helper = std::abs(normal.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 s = glm::normalize(glm::cross(helper, normal));
    const Vec3 t = glm::cross(normal, s);
    const float step = packed[0].y;
    const auto difference = [&](const Vec3& direction) {
        return deform_point(packed, point + step * direction)
               - deform_point(packed, point - step * direction);
    };
    const Vec3 turned = glm::cross(difference(s), difference(t));
    const float length = glm::length(turned);
    return length > 0.0f ? turned / length : normal;
}

void deform_points(std::span<const Vec4> packed, std::span<Vec3> points) {
    if (packed.empty()) {
        return;
    }
    for (Vec3& point : points) {
        point = deform_point(packed, point);
    }
}

}  // namespace limn
