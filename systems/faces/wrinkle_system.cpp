#include "systems/faces/wrinkle_system.h"

#include "ecs/base/hash.h"
#include "systems/faces/fold_height.h"
#include "systems/faces/skin_diffusion.h"
#include "systems/faces/skin_strain.h"
#include "systems/faces/wrinkle_fold.h"
#include "systems/faces/wrinkle_measure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <span>
#include <utility>

// Techniques: wrinkle.compression.direction, wrinkle.compression.integration,
//     wrinkle.compression.overlap, wrinkle.compression.prior-models, wrinkle.resting

namespace limn {

namespace {

const MeshData* mesh_of_instance(const MeshInstance& instance, const Assets& assets) {
    const std::uint32_t index = instance.mesh.index;
    return index < assets.meshes.size() ? &assets.meshes[index] : nullptr;
}

const TextureSlot* slot_of(const MeshInstance& instance, const Assets& assets) {
    const std::uint32_t material = instance.material.index;
    return material < assets.materials.size() ? &assets.materials[material].wrinkle_texture
                                              : nullptr;
}

const ImageData* map_of(const MeshInstance& instance, const Assets& assets) {
    const TextureSlot* const slot = slot_of(instance, assets);
    const std::uint32_t image = slot != nullptr ? slot->image.index : kNoAsset;
    return image < assets.images.size() ? &assets.images[image] : nullptr;
}

/// Whether the region has a weight per vertex and, if the driver is a chord, directions or none at
/// all.
bool is_used(const VertexRegion& region, const WrinkleSurface& surface, std::size_t vertices) {
    return is_named(region, surface.regions) && region.weights.size() == vertices
           && (region.across.size() == vertices || region.across.empty()
               || used_driver(surface) != WrinkleDriver::Chord);
}

/// Means of lengths ignore stretch along the folds.
float narrowing_of(const WrinkleSurface& surface) {
    return surface.mean_length ? 0.0f : surface.narrowing;
}

/// The regions of the second layer.
const std::vector<std::string>& second_regions(const WrinkleSurface& surface) {
    return surface.second_regions.empty() ? surface.regions : surface.second_regions;
}

/// A mesh without regions wrinkles anywhere with drivers that need no direction.
bool wrinkles_everywhere(const WrinkleSurface& surface, const MeshData& mesh) {
    return surface.method == WrinkleMethod::StrainView
           || (mesh.regions.empty() && surface.regions.empty()
               && used_driver(surface) != WrinkleDriver::Chord);
}

std::vector<WrinkleRest>
make_strain_rests(const MeshData& mesh, const WrinkleSurface& surface, std::vector<Vec2>& frames) {
    const SkinTriangles skin = make_skin_triangles(mesh.positions, mesh.indices, 0);
    std::vector<Vec3> normals;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        normals.push_back(glm::cross(skin.vertex_u[v], skin.vertex_v[v]));
    }
    if (mesh.tangents.size() == mesh.positions.size()) {
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3 tangent = mesh.tangents[v];
            const float along_u = glm::dot(tangent, skin.vertex_u[v]);
            const float along_v = glm::dot(tangent, skin.vertex_v[v]);
            frames.emplace_back(std::atan2(along_v, along_u), mesh.tangents[v].w < 0 ? -1 : 1);
        }
    }
    std::array<WrinkleRest, 3> rests = make_strain_rest(
        mesh.positions, mesh.indices, skin.vertex_u, normals, surface.weight, surface.smoothing);
    return {std::make_move_iterator(rests.begin()), std::make_move_iterator(rests.end())};
}

/// Appends the rest of the second layer, and returns its mask.
std::vector<float> add_second_layer(
    const WrinkleSurface& surface, const MeshData& mesh, std::vector<WrinkleRest>& rests) {
    FoldField field = merge_regions(mesh, second_regions(surface), true);
    if (surface.second_turned) {
        for (std::size_t v = 0; v < field.across.size() && v < mesh.normals.size(); ++v) {
            field.across[v] = glm::cross(mesh.normals[v], field.across[v]);
        }
    }
    rests.push_back(make_wrinkle_rest(
        mesh.positions, mesh.indices, field.across, surface.weight,
        {.aside = field.aside, .narrowing = narrowing_of(surface)}));
    rests.back().mean_length = surface.mean_length;
    if (surface.smoothing > 0) {
        diffuse_rest(rests.back(), mesh.positions, mesh.indices, surface.smoothing);
    }
    return std::move(field.mask);
}

std::vector<WrinkleRest> make_rests(
    const WrinkleSurface& surface, const MeshData& mesh, const FoldField& field,
    std::vector<Vec2>& frames) {
    std::vector<WrinkleRest> rests;
    switch (used_driver(surface)) {
    case WrinkleDriver::Chord:
        rests.push_back(make_wrinkle_rest(
            mesh.positions, mesh.indices, field.across, surface.weight,
            {.aside = field.aside, .narrowing = narrowing_of(surface)}));
        break;
    case WrinkleDriver::Edge:
        rests.push_back(make_edge_rest(mesh.positions, mesh.indices, surface.weight));
        break;
    case WrinkleDriver::Strain:
        return make_strain_rests(mesh, surface, frames);
    case WrinkleDriver::Radial:
        break;
    }
    for (WrinkleRest& rest : rests) {
        rest.mean_length = surface.mean_length;
        if (surface.smoothing > 0) {
            diffuse_rest(rest, mesh.positions, mesh.indices, surface.smoothing);
        }
    }
    return rests;
}

/// The maximum where regions overlap. Empty if the mesh has none of them.
std::vector<float> resting_folds(const WrinkleSurface& surface, const MeshData& mesh) {
    std::vector<float> resting;
    for (const RestingFolds& folds : surface.resting) {
        for (const VertexRegion& region : mesh.regions) {
            if (region.name != folds.region || region.weights.size() != mesh.positions.size()) {
                continue;
            }
            resting.resize(mesh.positions.size(), 0.0f);
            for (std::size_t v = 0; v < resting.size(); ++v) {
                const float weight = std::clamp(finite_or(region.weights[v], 0), 0.0f, 1.0f);
                resting[v] = std::max(resting[v], weight * folds.shortening);
            }
        }
    }
    return resting;
}

std::uint32_t shape_index(const MeshData& mesh, const std::string& name) {
    const auto found = std::ranges::find(mesh.morphs, name, &MorphTarget::name);
    return name.empty() ? kNoAsset : static_cast<std::uint32_t>(found - mesh.morphs.begin());
}

std::uint64_t hash_resting(const WrinkleSurface& surface) {
    std::uint64_t hash = hash_text(surface.resting_shape);
    for (const RestingFolds& folds : surface.resting) {
        hash = hash_combine(hash, hash_text(folds.region));
        hash = hash_combine(hash, std::bit_cast<std::uint32_t>(folds.shortening));
    }
    return hash;
}

/// Bound on the displacement: a fold's strength is below 1, or at most the largest of the table.
float largest_fold(const WrinkleState& state) {
    float highest = 0;
    for (const Vec2& height : state.heights) {
        highest = std::max(highest, std::abs(height.x) + std::abs(height.y));
    }
    return highest * std::max(1.0f, *std::ranges::max_element(state.folds));
}

}  // namespace

float radial_falloff(const Vec3& position, const Vec3& center, float radius) {
    const float relative = glm::distance(position, center) / radius;
    return relative < 1 ? 0.5f + 0.5f * std::cos(kPi * relative) : 0.0f;
}

std::uint64_t
wrinkle_source(const WrinkleSurface& surface, const MeshInstance& instance, const Assets& assets) {
    const MeshData* const mesh = mesh_of_instance(instance, assets);
    if (mesh == nullptr) {
        return 0;
    }
    std::uint64_t hash = hash_combine(instance.mesh.index, mesh->version);
    hash = hash_combine(hash, static_cast<std::uint64_t>(surface.weight));
    hash = hash_combine(hash, static_cast<std::uint64_t>(used_driver(surface)));
    hash = hash_combine(hash, surface.mean_length ? 1 : 0);
    hash = hash_combine(hash, surface.method == WrinkleMethod::StrainView ? 1 : 0);
    if (used_driver(surface) == WrinkleDriver::Radial) {
        hash = hash_bytes(&surface.center, sizeof surface.center, hash);
        hash = hash_bytes(&surface.radius, sizeof surface.radius, hash);
    }
    hash = hash_combine(hash, has_layers(surface) ? (surface.second_turned ? 2 : 1) : 0);
    for (const VertexRegion& region : mesh->regions) {
        const bool second = has_layers(surface) && is_named(region, second_regions(surface));
        hash = hash_combine(hash, second ? 1 : 0);
    }
    const ImageData* const map = map_of(instance, assets);
    hash = hash_combine(hash, map == nullptr ? kNoAsset : map - assets.images.data());
    bool any = wrinkles_everywhere(surface, *mesh);
    for (std::size_t i = 0; i < mesh->regions.size(); ++i) {
        if (is_used(mesh->regions[i], surface, mesh->positions.size())) {
            hash = hash_combine(hash, i);
            any = true;
        }
    }
    hash = hash_combine(hash, std::bit_cast<std::uint32_t>(narrowing_of(surface)));
    hash = hash_combine(hash, std::bit_cast<std::uint32_t>(surface.smoothing));
    hash = surface.resting.empty() ? hash : hash_combine(hash, hash_resting(surface));
    if (is_displaced(surface) && map != nullptr) {
        const TextureSlot& slot = *slot_of(instance, assets);
        for (const float number :
             {slot.scale.x, slot.scale.y, slot.offset.x, slot.offset.y, slot.rotation}) {
            hash = hash_combine(hash, std::bit_cast<std::uint32_t>(number));
        }
    }
    return any ? hash | 1 : 0;
}

WrinkleState make_wrinkle_state(
    const WrinkleSurface& surface, const MeshInstance& instance, const Assets& assets) {
    WrinkleState state;
    state.source = wrinkle_source(surface, instance, assets);
    if (state.source == 0) {
        return state;
    }
    const MeshData& mesh = *mesh_of_instance(instance, assets);
    const std::size_t vertices = mesh.positions.size();
    FoldField field = merge_regions(mesh, surface.regions, false);
    state.rests = make_rests(surface, mesh, field, state.frames);
    state.mask = std::move(field.mask);
    if (wrinkles_everywhere(surface, mesh)) {
        state.mask.assign(vertices, 1.0f);
    }
    state.resting = resting_folds(surface, mesh);
    state.resting_shape = shape_index(mesh, surface.resting_shape);
    if (has_layers(surface)) {
        state.second_mask = add_second_layer(surface, mesh, state.rests);
    }
    if (used_driver(surface) == WrinkleDriver::Radial) {
        for (std::size_t v = 0; v < vertices; ++v) {
            state.mask[v] *= radial_falloff(mesh.positions[v], surface.center, surface.radius);
        }
    }
    if (const ImageData* const map = map_of(instance, assets)) {
        state.folds =
            make_fold_table(has_layers(surface) ? layered_slopes(*map) : wrinkle_slopes(*map));
        if (is_displaced(surface)) {
            state.heights =
                fold_heights(mesh, *map, *slot_of(instance, assets), has_layers(surface));
            state.largest_fold = largest_fold(state);
        }
    }
    return state;
}

void prepare_wrinkles(
    Query<const WrinkleSurface, const MeshInstance> surfaces, Query<const WrinkleState> states,
    Res<const Assets> assets, Commands commands) {
    std::map<std::uint64_t, WrinkleState> made_now;  // a crowd has few distinct ones
    surfaces.each([&](Entity entity, const WrinkleSurface& surface, const MeshInstance& instance) {
        const WrinkleState* const made = states.find<const WrinkleState>(entity);
        const std::uint64_t source = wrinkle_source(surface, instance, *assets);
        if (source == 0 && made != nullptr) {
            commands.remove<WrinkleState>(entity);
        } else if (source != 0 && (made == nullptr || made->source != source)) {
            const auto [state, is_new] = made_now.try_emplace(source);
            if (is_new) {
                state->second = make_wrinkle_state(surface, instance, *assets);
            }
            commands.add(entity, state->second);
        }
    });
}

}  // namespace limn
