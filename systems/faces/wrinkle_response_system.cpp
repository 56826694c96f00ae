#include "systems/faces/wrinkle_response_system.h"

#include "ecs/base/hash.h"
#include "systems/animation/deform_mesh.h"
#include "systems/animation/mesh_source.h"
#include "systems/faces/wrinkle_measure.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

// Techniques: skin.pipeline

namespace limn {

namespace {

constexpr float kMinResponseWeight = 1e-4f;  ///< of the area of the mesh that a region must have
constexpr std::size_t kRegions = kWrinkleRegions.size();

/// The texel of an 8-bit mask at `uv`, which repeats; 0 of other images.
std::array<float, 4> mask_at(const ImageData* mask, const Vec2& uv) {
    std::array<float, 4> found = {};
    if (mask == nullptr || mask->format != PixelFormat::Rgba8
        || mask->pixels.size()
               < 4 * static_cast<std::size_t>(mask->width) * static_cast<std::size_t>(mask->height)
        || !std::isfinite(uv.x + uv.y)) {
        return found;
    }
    const auto texel_index = [](float x, int count) {
        const auto at = static_cast<int>((x - std::floor(x)) * static_cast<float>(count));
        return static_cast<std::size_t>(std::min(at, count - 1));
    };
    const std::size_t texel =
        texel_index(uv.y, mask->height) * static_cast<std::size_t>(mask->width)
        + texel_index(uv.x, mask->width);
    for (std::size_t c = 0; c < 4; ++c) {
        found[c] = static_cast<float>(mask->pixels[4 * texel + c]) / 255.0f;
    }
    return found;
}

const ImageData* image_of(ImageId id, const Assets& assets) {
    return id.index < assets.images.size() ? &assets.images[id.index] : nullptr;
}

/// A third of the triangles at each vertex [m^2].
std::vector<float> vertex_areas(const MeshData& mesh) {
    std::vector<float> areas(mesh.positions.size(), 0.0f);
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::uint32_t* const v = &mesh.indices[t];
        if (std::max({v[0], v[1], v[2]}) >= areas.size()) {
            continue;
        }
        const Vec3& p = mesh.positions[v[0]];
        const float area =
            0.5f * glm::length(glm::cross(mesh.positions[v[1]] - p, mesh.positions[v[2]] - p));
        for (std::size_t k = 0; k < 3; ++k) {
            areas[v[k]] += finite_or(area, 0.0f) / 3.0f;
        }
    }
    return areas;
}

const MeshData* measurable_mesh(const MeshInstance& instance, const Assets& assets) {
    if (instance.mesh.index >= assets.meshes.size()) {
        return nullptr;
    }
    const MeshData& mesh = assets.meshes[instance.mesh.index];
    const bool directed = std::ranges::any_of(mesh.regions, [&](const VertexRegion& region) {
        return region.across.size() == mesh.positions.size();
    });
    const bool whole =
        mesh.uvs.size() == mesh.positions.size() && mesh.normals.size() == mesh.positions.size();
    return directed && whole ? &mesh : nullptr;
}

std::uint64_t
source_of(const WrinkleMaps& maps, const MeshInstance& instance, const Assets& assets) {
    const MeshData* const mesh = measurable_mesh(instance, assets);
    if (mesh == nullptr) {
        return 0;
    }
    std::uint64_t hash = hash_combine(instance.mesh.index, mesh->version);
    hash = hash_combine(hash, maps.first_masks.index);
    hash = hash_combine(hash, maps.second_masks.index);
    return hash_combine(hash, maps.third_masks.index) | 1;
}

/// What a region does.
RegionResponse response_of(const WrinkleResponse& response, std::size_t region) {
    for (const RegionResponse& own : response.regions) {
        if (static_cast<std::size_t>(own.region) == region) {
            return own;
        }
    }
    return {
        .region = static_cast<WrinkleRegion>(region),
        .compressed_gain = response.compressed_gain,
        .stretched_gain = response.stretched_gain,
        .bias = response.bias,
        .smoothing = response.smoothing};
}

}  // namespace

ResponseRest
make_response_rest(const WrinkleMaps& maps, const MeshInstance& instance, const Assets& assets) {
    ResponseRest rest;
    rest.source = source_of(maps, instance, assets);
    if (rest.source == 0) {
        return rest;
    }
    const MeshData& mesh = *measurable_mesh(instance, assets);
    const std::size_t vertices = mesh.positions.size();
    FoldField folds = merge_regions(mesh, {}, true);
    const AlongFolds along = {.aside = folds.aside, .narrowing = 0};
    rest.fields[0] =
        make_wrinkle_rest(mesh.positions, mesh.indices, folds.across, WrinkleWeight::Angle, along);
    for (std::size_t v = 0; v < vertices; ++v) {
        folds.across[v] = glm::cross(mesh.normals[v], folds.across[v]);
    }
    rest.fields[1] =
        make_wrinkle_rest(mesh.positions, mesh.indices, folds.across, WrinkleWeight::Angle, along);

    const std::vector<float> areas = vertex_areas(mesh);
    const ImageData* const images[] = {
        image_of(maps.first_masks, assets), image_of(maps.second_masks, assets),
        image_of(maps.third_masks, assets)};
    float whole = 0;
    rest.areas.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::array<float, 4> masks[] = {
            mask_at(images[0], mesh.uvs[v]), mask_at(images[1], mesh.uvs[v]),
            mask_at(images[2], mesh.uvs[v])};
        for (std::size_t m = 0; m < kRegions; ++m) {
            const float mask = masks[m / 4][m % 4];
            // Nothing is measured where no region has a direction.
            rest.areas[v][m] = folds.mask[v] > 0 ? mask * areas[v] : 0.0f;
            rest.total[m] += rest.areas[v][m];
        }
        whole += areas[v];
    }
    for (float& total : rest.total) {
        total = total > kMinResponseWeight * whole ? total : 0.0f;
    }
    return rest;
}

WrinkleWeights response_weights(
    const WrinkleResponse& response, const ResponseRest& rest, std::span<const Vec3> deformed,
    const WrinkleWeights* animated) {
    std::array<std::array<float, kRegions>, 2> sums = {};
    for (std::size_t field = 0; field < 2; ++field) {
        const std::vector<float> ratio = vertex_compression({&rest.fields[field], 1}, deformed);
        for (std::size_t v = 0; v < ratio.size(); ++v) {
            const float strength =
                std::max(wrinkle_intensity(ratio[v], response.lambda, response.beta), 0.0f);
            for (std::size_t m = 0; strength > 0 && m < kRegions; ++m) {
                sums[field][m] += rest.areas[v][m] * strength;
            }
        }
    }
    const std::array<float, kRegions> set =
        animated != nullptr ? region_weights(*animated) : std::array<float, kRegions>{};
    WrinkleWeights weights;
    for (std::size_t m = 0; m < kRegions; ++m) {
        const float total = rest.total[m];
        const RegionResponse own = response_of(response, m);
        const float measured =
            total > 0 ? (own.compressed_gain * sums[0][m] - own.stretched_gain * sums[1][m]) / total
                      : 0.0f;
        weights.*kWrinkleRegions[m] = std::clamp(set[m] + measured + own.bias, -1.0f, 1.0f);
    }
    return weights;
}

void prepare_wrinkle_responses(
    Query<const WrinkleResponse, const WrinkleMaps, const MeshInstance, const Deformed> faces,
    Query<const ResponseRest> rests, Query<const MeasuredWrinkles> measured,
    Res<const Assets> assets, Commands commands) {
    faces.each([&](Entity entity, const WrinkleResponse&, const WrinkleMaps& maps,
                   const MeshInstance& instance, const Deformed&) {
        const ResponseRest* const made = rests.find<const ResponseRest>(entity);
        const std::uint64_t source = source_of(maps, instance, *assets);
        if (source == 0) {
            if (made != nullptr) {
                commands.remove<ResponseRest>(entity);
            }
            if (measured.find<const MeasuredWrinkles>(entity) != nullptr) {
                commands.remove<MeasuredWrinkles>(entity);
            }
            return;
        }
        if (made == nullptr || made->source != source) {
            commands.add(entity, make_response_rest(maps, instance, *assets));
        }
        if (measured.find<const MeasuredWrinkles>(entity) == nullptr) {
            commands.add(entity, MeasuredWrinkles{});
        }
    });
}

void update_wrinkle_responses(
    Query<
        const WrinkleResponse, const ResponseRest, const MeshInstance, const Deformed,
        MeasuredWrinkles>
        faces,
    Query<const WrinkleWeights> animated, Query<const DeformerState> deformers,
    Query<const Pose> poses, Query<const MorphWeights> morphs, Query<const WrinkleRungs> ladders,
    Res<const Assets> assets, Res<const FrameTime> time) {
    std::vector<Vec3> positions;
    faces.each([&](Entity entity, const WrinkleResponse& response, const ResponseRest& rest,
                   const MeshInstance& instance, const Deformed& deformed,
                   MeasuredWrinkles& measured) {
        const MeshSource source = find_mesh_source(
            instance.mesh, &deformed, deformers.find<const DeformerState>(entity), poses, morphs,
            *assets);
        const auto* const rungs = ladders.find<const WrinkleRungs>(entity);
        if (rungs != nullptr && rungs->maps == 0) {
            measured.started = false;  // too far away to be seen: at once when it comes closer
            return;
        }
        if (source.data == nullptr || source.data->positions.size() != rest.areas.size()) {
            return;
        }
        deform_positions(
            *source.data, deformed, source.skin, source.pose, source.morphs, source.deformers,
            positions);
        const WrinkleWeights target = response_weights(
            response, rest, positions, animated.find<const WrinkleWeights>(entity));
        for (std::size_t m = 0; m < kRegions; ++m) {
            const float smoothing = response_of(response, m).smoothing;
            const bool at_once = !measured.started || smoothing <= 0;
            const float step = at_once ? 1.0f : 1 - std::exp(-time->step / smoothing);
            float& weight = measured.weights.*kWrinkleRegions[m];
            const float wanted = target.*kWrinkleRegions[m];
            weight = step < 1 ? weight + step * (wanted - weight) : wanted;
        }
        measured.started = true;
    });
}

}  // namespace limn
