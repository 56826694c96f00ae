#include "content/bake/region_directions.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace limn {

namespace {

constexpr double kMaxTurn = 35 * kPi / 180.0;
constexpr float kMidlineWidth = 0.008f;  ///< |x| below which directions turn less [m]
constexpr double kMinShortening = 0.01;  ///< mean of a region; less determines no direction
constexpr double kMinAgreement = 0.3;    ///< length of the mean direction; 1: all agree

struct FoldedBy {
    std::string_view region;
    std::array<std::string_view, 2> units;  ///< of FACS, both sides
};

constexpr FoldedBy kFoldedBy[] = {
    {"forehead", {"AU1", "AU2"}}, {"glabella", {"AU4"}},    {"nose_root", {"AU9"}},
    {"nose_side", {"AU9"}},       {"upper_lid", {"AU9"}},   {"lower_lid", {"AU6", "AU12"}},
    {"cheek", {"AU12"}},          {"nasolabial", {"AU12"}}, {"inner_canthus", {"AU7"}},
    {"marionette", {"AU15"}},
};

bool shows_unit(const MorphTarget& morph, std::string_view unit) {
    std::string_view name = morph.action_unit;
    if (name.ends_with("_L") || name.ends_with("_R")) {
        name.remove_suffix(2);
    }
    return !unit.empty() && name == unit;
}

std::vector<Vec3> express(const MeshData& mesh, std::span<const std::string_view> units) {
    std::vector<Vec3> deformed = mesh.positions;
    for (const MorphTarget& morph : mesh.morphs) {
        for (const std::string_view unit : units) {
            for (std::size_t i = 0; shows_unit(morph, unit) && i < morph.vertices.size(); ++i) {
                deformed[morph.vertices[i]] += morph.positions[i];
            }
        }
    }
    return deformed;
}

/// The maximum shortening of a triangle, and its direction, from across the folds towards along
/// them.
struct Shortening {
    double amount = 0;
    double angle = 0;  ///< [rad]
};

Shortening find_shortening(
    const std::array<Vec3, 3>& rest, const std::array<Vec3, 3>& now, const Vec3& across) {
    const Vec3 e1 = rest[1] - rest[0];
    const Vec3 e2 = rest[2] - rest[0];
    const Vec3 cross = glm::cross(e1, e2);
    const float area2 = glm::dot(cross, cross);
    const Vec3 normal = normalize_or(cross, Vec3(0));
    const Vec3 a = normalize_or(across - glm::dot(across, normal) * normal, Vec3(0));
    if (!(area2 > 0) || a == Vec3(0)) {
        return {};
    }
    // The image of a vector x e1 + y e2 of the plane.
    const auto carry = [&](const Vec3& v) {
        const float x = glm::dot(glm::cross(v, e2), cross) / area2;
        const float y = glm::dot(glm::cross(e1, v), cross) / area2;
        return x * (now[1] - now[0]) + y * (now[2] - now[0]);
    };
    const Vec3 along_a = carry(a);
    const Vec3 along_b = carry(glm::cross(normal, a));
    const double aa = glm::dot(along_a, along_a);
    const double bb = glm::dot(along_b, along_b);
    const double ab = glm::dot(along_a, along_b);
    const double least = 0.5 * (aa + bb) - std::hypot(0.5 * (aa - bb), ab);
    return {std::max(1 - std::sqrt(std::max(least, 0.0)), 0.0), 0.5 * std::atan2(-2 * ab, bb - aa)};
}

/// The angle by which the directions of a region turn, from lateral towards up on the left [rad].
double find_turn(const MeshData& mesh, const VertexRegion& region, std::span<const Vec3> deformed) {
    glm::dvec2 sum = {0, 0};
    double shortening = 0;
    double total = 0;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        std::array<Vec3, 3> rest;
        std::array<Vec3, 3> now;
        Vec3 across = Vec3(0);
        float weight = 0;
        float x = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.indices[t + k];
            rest[k] = mesh.positions[v];
            now[k] = deformed[v];
            across += region.weights[v] * region.across[v];
            weight += region.weights[v] / 3;
            x += mesh.positions[v].x / 3;
        }
        if (!(weight > 0)) {
            continue;
        }
        const Shortening found = find_shortening(rest, now, across);
        const float area = glm::length(glm::cross(rest[1] - rest[0], rest[2] - rest[0]));
        const double counts = double{weight} * double{area} * found.amount;
        const double side = x < 0 ? -1 : 1;
        sum += counts * glm::dvec2(std::cos(2 * found.angle), side * std::sin(2 * found.angle));
        shortening += counts;
        total += double{weight} * double{area};
    }
    const bool clear =
        shortening > kMinShortening * total && glm::length(sum) > kMinAgreement * shortening;
    return clear ? std::clamp(0.5 * std::atan2(sum.y, sum.x), -kMaxTurn, kMaxTurn) : 0.0;
}

}  // namespace

void fit_region_directions(MeshData& mesh) {
    for (VertexRegion& region : mesh.regions) {
        const auto* const rule = std::ranges::find(kFoldedBy, region.name, &FoldedBy::region);
        if (rule == std::end(kFoldedBy) || region.across.size() != mesh.positions.size()) {
            continue;
        }
        const double turn = find_turn(mesh, region, express(mesh, rule->units));
        for (std::size_t v = 0; v < region.across.size(); ++v) {
            Vec3& across = region.across[v];
            const float x = mesh.positions[v].x;
            const float factor =
                std::copysign(glm::smoothstep(0.0f, kMidlineWidth, std::abs(x)), x);
            const float angle = factor * static_cast<float>(turn);
            across =
                std::cos(angle) * across + std::sin(angle) * glm::cross(mesh.normals[v], across);
        }
    }
}

}  // namespace limn
