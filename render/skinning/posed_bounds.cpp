#include "render/skinning/posed_bounds.h"

#include "render/geometry/culling.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace limn {
namespace {

Bounds widened(const Bounds& box, const Bounds& by) {
    return is_empty(box) ? box : Bounds{box.min + by.min, box.max + by.max};
}

/// Largest distance between the images of a point of the box under two joints: at a corner.
float max_separation(const Affine& a, const Affine& b, const Bounds& box) {
    float widest = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner = {
            (i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
            (i & 4) != 0 ? box.max.z : box.min.z};
        widest =
            std::max(widest, glm::distance(transform_point(a, corner), transform_point(b, corner)));
    }
    return widest;
}

/// Bounds of the sum of the targets' offsets.
Bounds sum_of_morphs(const std::vector<Bounds>& morphs, std::span<const float> weights) {
    Bounds sum = {Vec3(0), Vec3(0)};
    for (std::size_t i = 0; i < std::min(morphs.size(), weights.size()); ++i) {
        const float w = weights[i];
        sum.min += w >= 0 ? w * morphs[i].min : w * morphs[i].max;
        sum.max += w >= 0 ? w * morphs[i].max : w * morphs[i].min;
    }
    return sum;
}

}  // namespace

SkinBounds make_skin_bounds(const MeshData& mesh) {
    SkinBounds made;
    std::map<std::uint16_t, Bounds> joints;
    std::map<std::pair<std::uint16_t, std::uint16_t>, Bounds> pairs;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        grow(made.rest, p);
        const std::uint32_t begin = mesh.skin.empty() ? 0 : mesh.skin.first[v];
        const std::uint32_t end = mesh.skin.empty() ? 0 : mesh.skin.first[v + 1];
        if (begin == end) {
            grow(made.still, p);
        }
        made.many = made.many || end - begin > 2;
        for (std::uint32_t i = begin; i < end; ++i) {
            grow(joints[mesh.skin.joints[i]], p);
            for (std::uint32_t j = begin; j < i; ++j) {
                grow(pairs[std::minmax(mesh.skin.joints[i], mesh.skin.joints[j])], p);
            }
        }
    }
    for (const auto& [joint, box] : joints) {
        made.joints.push_back({joint, box});
    }
    for (const auto& [both, box] : pairs) {
        made.pairs.push_back({both.first, both.second, box});
    }
    for (const MorphTarget& target : mesh.morphs) {
        Bounds offsets = {Vec3(0), Vec3(0)};
        for (const Vec3& offset : target.positions) {
            grow(offsets, offset);
        }
        made.morphs.push_back(offsets);
    }
    return made;
}

Bounds posed_bounds(
    const SkinBounds& bounds, std::span<const Affine> palette, Skinning skinning,
    std::span<const float> weights, float displacement) {
    Bounds morphs = sum_of_morphs(bounds.morphs, weights);
    morphs.min -= displacement;
    morphs.max += displacement;
    if (palette.empty()) {
        return widened(bounds.rest, morphs);
    }
    Bounds posed = widened(bounds.still, morphs);
    Vec3 sum(0);
    for (const SkinBounds::Joint& one : bounds.joints) {
        const Bounds there = transform_bounds(palette[one.joint], widened(one.box, morphs));
        sum += there.min + there.max;
        grow(posed, there);
    }
    if (!std::isfinite(sum.x + sum.y + sum.z)) {
        return {Vec3(NAN), Vec3(NAN)};  // min and max may drop a NaN
    }
    if (skinning == Skinning::DualQuaternion) {
        for (const SkinBounds::Pair& pair : bounds.pairs) {
            const Bounds box = widened(pair.box, morphs);
            const Affine& a = palette[pair.a];
            const Affine& b = palette[pair.b];
            const float apart = max_separation(a, b, box);
            const Vec3 beside = Vec3(bounds.many ? apart : 0.5f * apart);
            for (const Affine* joint : {&a, &b}) {
                const Bounds there = transform_bounds(*joint, box);
                grow(posed, Bounds{there.min - beside, there.max + beside});
            }
        }
    }
    return posed;
}

std::string check_deformable(const MeshData& mesh) {
    const std::size_t vertices = mesh.positions.size();
    const SkinWeights& skin = mesh.skin;
    if (!skin.empty()) {
        const bool whole = skin.first.size() == vertices + 1 && skin.first[0] == 0
                           && std::is_sorted(skin.first.begin(), skin.first.end())
                           && skin.first.back() == skin.joints.size()
                           && skin.joints.size() == skin.weights.size();
        if (!whole) {
            return fmt::format(
                "has {} ranges, {} joints and {} weights for {} vertices", skin.first.size(),
                skin.joints.size(), skin.weights.size(), vertices);
        }
        for (const float weight : skin.weights) {
            if (!std::isfinite(weight)) {
                return "has a non-finite weight";
            }
        }
    }
    for (const MorphTarget& target : mesh.morphs) {
        const auto fits = [&](const std::vector<Vec3>& offsets) {
            return offsets.empty() || offsets.size() == target.vertices.size();
        };
        if (target.positions.size() != target.vertices.size() || !fits(target.normals)
            || !fits(target.tangents)) {
            return fmt::format("has morph target {}, whose arrays differ in length", target.name);
        }
        for (const std::uint32_t vertex : target.vertices) {
            if (vertex >= vertices) {
                return fmt::format(
                    "has morph target {} of vertex {}, but only {} vertices", target.name, vertex,
                    vertices);
            }
        }
    }
    return {};
}

}  // namespace limn
