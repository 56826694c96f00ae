#include "content/make/head/strain_fold_pattern.h"

#include "content/bake/skin_texels.h"
#include "content/bake/wrinkle_model.h"
#include "content/make/head/face_fold_pattern.h"
#include "content/make/head/head.h"
#include "content/make/head/head_expressions.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

// Techniques: face.wrinkle-model

namespace limn {

namespace {

constexpr int kFoldGutter = 4;  ///< [texels]
constexpr float kFlat = 1e-6f;  ///< square of a slope that counts as flat
constexpr float kMinNormalZ = 0.05f;
constexpr float kMaxFolding = 0.5f;  ///< of the length of skin

using Pose = std::array<std::string_view, 4>;
constexpr std::array<Pose, 16> kPoses = {{
    {"AU1_L", "AU1_R", "AU2_L", "AU2_R"},
    {"AU1_L", "AU1_R"},
    {"AU2_L", "AU2_R"},
    {"AU4_L", "AU4_R"},
    {"AU4_L", "AU4_R", "AU1_L", "AU1_R"},
    {"AU6_L", "AU6_R"},
    {"AU7_L", "AU7_R"},
    {"AU9_L", "AU9_R"},
    {"AU12_L", "AU12_R"},
    {"AU6_L", "AU6_R", "AU12_L", "AU12_R"},
    {"AU15_L", "AU15_R"},
    {"AU17"},
    {"AU18"},
    {"AU20_L", "AU20_R"},
    {"AU27"},
    {"AU43_L", "AU43_R"},
}};

std::vector<Vec3> posed(const MeshData& mesh, const Pose& pose) {
    std::vector<Vec3> positions = mesh.positions;
    for (const std::string_view name : pose) {
        if (!name.empty()) {
            const MorphTarget& morph = mesh.morphs[expression_index(name)];
            for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
                positions[morph.vertices[i]] += morph.positions[i];
            }
        }
    }
    return positions;
}

std::vector<Vec2> slopes_of(const ImageData& map) {
    std::vector<Vec2> slopes;
    for (std::size_t i = 0; i + 4 <= map.pixels.size(); i += 4) {
        const auto component = [&](std::size_t k) {
            return (static_cast<float>(map.pixels[i + k]) - 128.0f) / 127.0f;
        };
        slopes.push_back(Vec2{component(0), component(1)} / -std::max(component(2), kMinNormalZ));
    }
    return slopes;
}

/// Factor of the slopes for a unit excess length, in the limit of small ones.
float unit_factor(std::span<const Vec2> slopes) {
    double sum = 0;
    double count = 0;
    for (const Vec2& slope : slopes) {
        const float square = glm::dot(slope, slope);
        sum += square > kFlat ? double{square} : 0;
        count += square > kFlat ? 1 : 0;
    }
    return sum > 0 ? static_cast<float>(std::sqrt(2 * count / sum)) : 0.0f;
}

/// Where the skin of a mesh may fold, and the direction across the folds in its tangent frame.
struct Foldable {
    std::vector<float> mask;
    std::vector<Vec2> across;
};

Foldable find_foldable_texels(const MeshData& mesh) {
    const std::size_t vertices = mesh.positions.size();
    Foldable found = {std::vector<float>(vertices, 0.0f), std::vector<Vec2>(vertices, Vec2(0))};
    std::vector<float> strongest(vertices, 0.0f);
    for (const VertexRegion& region : mesh.regions) {
        for (std::size_t v = 0; v < vertices && !region.across.empty(); ++v) {
            found.mask[v] = std::min(found.mask[v] + region.weights[v], 1.0f);
            if (region.weights[v] > strongest[v]) {
                strongest[v] = region.weights[v];
                const Vec3 t = mesh.tangents[v];
                const Vec3 b = mesh.tangents[v].w * glm::cross(mesh.normals[v], t);
                found.across[v] = {glm::dot(region.across[v], t), glm::dot(region.across[v], b)};
            }
        }
    }
    return found;
}

/// Strength of folds that preserve the length of the skin, for small slopes.
float strength_of(const Vec3& strain, const Vec2& across, const StrainFoldsPattern& pattern) {
    const Vec2 now = {
        (1 + strain.x) * across.x + strain.z * across.y,
        strain.z * across.x + (1 + strain.y) * across.y};
    const float before = glm::length(across);
    const float shortening = before > 0.1f ? 1 - glm::length(now) / before - pattern.slack : 0.0f;
    const float folded = std::min(pattern.share * std::max(shortening, 0.0f), kMaxFolding);
    return std::sqrt(1 / (1 - folded) - 1);
}

}  // namespace

PatternMaps make_strain_folds(const StrainFoldsPattern& pattern) {
    PatternMaps maps = make_face_folds(
        {.image = {.size = pattern.size, .seed = pattern.seed},
         .depth = pattern.depth,
         .wander = pattern.wander});
    const int size = maps.normal.width;
    const std::vector<Vec2> slopes = slopes_of(maps.normal);
    const float factor = unit_factor(slopes);
    const MeshData mesh = make_head({.age = pattern.age});
    const Foldable foldable = find_foldable_texels(mesh);
    const std::vector<SkinTexel> texels = find_skin_texels(mesh, size, kFoldGutter);

    std::vector<WrinklePose> poses;
    for (const Pose& pose : kPoses) {
        const std::vector<Vec3> strain = find_tangent_strain(mesh, posed(mesh, pose));
        std::vector<float> strength(strain.size());
        for (std::size_t v = 0; v < strain.size(); ++v) {
            strength[v] =
                foldable.mask[v] * factor * strength_of(strain[v], foldable.across[v], pattern);
        }
        WrinklePose& captured = poses.emplace_back();
        for (std::size_t i = 0; i < texels.size(); ++i) {
            captured.strain.push_back(
                at_texel(mesh.indices, texels[i], std::span<const Vec3>(strain)));
            captured.slopes.push_back(
                at_texel(mesh.indices, texels[i], std::span<const float>(strength)) * slopes[i]);
        }
    }
    maps.normal = pack_wrinkle_model(
        fit_wrinkle_model(size, poses, {.degree = pattern.degree, .ridge = pattern.ridge}));
    return maps;
}

}  // namespace limn
