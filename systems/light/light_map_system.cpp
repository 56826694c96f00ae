#include "systems/light/light_map_system.h"

#include "ecs/base/check.h"
#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"
#include "systems/light/light_map_charts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>

// Techniques: light.lightmap

namespace limn {
namespace {

constexpr float kFarAway = 1e4f;     ///< occluders of directional lights [m]
constexpr float kLiftOff = 1e-3f;    ///< of rays from their surface [m]
constexpr float kMinSquare = 1e-4f;  ///< of a distance [m^2]

Vec3 position_in(const Affine& a) {
    return {a.row[0].w, a.row[1].w, a.row[2].w};
}

Vec3 axis_in(const Affine& a) {
    return normalize_or({-a.row[0].z, -a.row[1].z, -a.row[2].z}, {0, 0, -1});
}

/// What is not finite lights nothing.
LightMapSource valid_source(const LightMapSource& source) {
    const bool valid = is_finite(source.color) && is_finite(source.position)
                       && is_finite(source.axis) && std::isfinite(source.radius);
    return valid ? source : LightMapSource{};
}

bool same_source(const LightMapSource& a, const LightMapSource& b) {
    const Attenuation& f = a.attenuation;
    const Attenuation& g = b.attenuation;
    return a.color == b.color && a.position == b.position && a.axis == b.axis
           && a.radius == b.radius && f.falloff == g.falloff && f.constant == g.constant
           && f.linear == g.linear && f.quadratic == g.quadratic && f.multiplier == g.multiplier
           && a.inner_angle == b.inner_angle && a.outer_angle == b.outer_angle
           && a.profile == b.profile && a.directional == b.directional;
}

float distance_factor(const LightMapSource& source, float distance) {
    const Attenuation& a = source.attenuation;
    const float part = source.radius > 0 ? distance / source.radius : 0.0f;
    const float window = square(std::clamp(1 - square(square(part)), 0.0f, 1.0f));
    switch (a.falloff) {
    case Falloff::InverseSquare:
        return window / std::max(square(distance), kMinSquare);
    case Falloff::Polynomial:
        return window
               / std::max(
                   a.constant + a.linear * distance + a.quadratic * square(distance), kMinSquare);
    case Falloff::Smooth:
        return std::clamp(a.multiplier * (1 - square(part)), 0.0f, 1.0f);
    case Falloff::None:
        return part < 1 ? 1.0f : 0.0f;
    }
    return 0;
}

float cone_factor(const LightMapSource& source, const Vec3& to_light) {
    if (source.outer_angle >= kPi) {
        return 1;
    }
    const float cosine = std::clamp(-glm::dot(source.axis, to_light), -1.0f, 1.0f);
    if (source.profile == SpotProfile::LinearAngle) {
        const float width = std::max(source.outer_angle - source.inner_angle, 1e-4f);
        return std::clamp((source.outer_angle - std::acos(cosine)) / width, 0.0f, 1.0f);
    }
    const float outer = std::cos(source.outer_angle);
    const float width = std::max(std::cos(source.inner_angle) - outer, 1e-4f);
    const float s = std::clamp((cosine - outer) / width, 0.0f, 1.0f);
    return source.profile == SpotProfile::Smoothstep ? s * s * (3 - 2 * s) : s;
}

bool is_in_shadow(
    const LightMapSource& source, const LightMapTexel& texel, const MeshBvh* occluders) {
    if (occluders == nullptr) {
        return false;
    }
    const Vec3 from = texel.position + kLiftOff * texel.normal;
    const Vec3 to = source.directional ? from - kFarAway * source.axis : source.position;
    return first_hit(*occluders, {from, to}).triangle != kNoTriangle;
}

/// As a byte stores it.
int stored_byte(float value) {
    return static_cast<int>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

/// Takes the old light of one source out of a sum of bytes, and adds the new one.
void exchange_bytes(std::uint8_t* pixel, const Vec3& old_light, const Vec3& new_light) {
    for (int c = 0; c < 3; ++c) {
        const int left = std::clamp(pixel[c] - stored_byte(old_light[c]), 0, 255);
        pixel[c] = static_cast<std::uint8_t>(std::clamp(left + stored_byte(new_light[c]), 0, 255));
    }
}

void store_sum(const LightMapState& state, std::size_t texel, ImageData& image) {
    Vec4 sum = {0, 0, 0, 1};
    for (const LightMapLight& light : state.lights) {
        sum += Vec4(light.light[texel], 0);
    }
    std::memcpy(&image.pixels[state.texels[texel].pixel * sizeof(Vec4)], &sum, sizeof sum);
}

/// The stored light of an entity; a new one, of color 0, if there is none.
LightMapLight& stored_light(LightMapState& state, Entity entity) {
    const auto found =
        std::find_if(state.lights.begin(), state.lights.end(), [&](const LightMapLight& light) {
            return light.entity == entity;
        });
    if (found != state.lights.end()) {
        return *found;
    }
    state.lights.push_back({entity, {}, std::vector<Vec3>(state.texels.size(), Vec3(0))});
    return state.lights.back();
}

/// Lights that are gone have color 0.
void add_removed_sources(const LightMapState& state, std::vector<PlacedSource>& sources) {
    for (const LightMapLight& light : state.lights) {
        const bool exists = std::any_of(sources.begin(), sources.end(), [&](const auto& source) {
            return source.entity == light.entity;
        });
        if (!exists) {
            sources.push_back({light.entity, {}});
        }
    }
}

void update_light(
    LightMapState& state, LightMapLight& light, const LightMapSource& source, LightMapFormat format,
    const MeshBvh* occluders, ImageData& image, std::vector<std::uint8_t>& touched) {
    const LightMapSource previous = std::exchange(light.source, source);
    parallel_for(state.patches.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const LightMapPatch& patch = state.patches[p];
            const bool lit = reaches(source, patch.box);
            if (!lit && !reaches(previous, patch.box)) {
                continue;
            }
            touched[p] = 1;
            for (std::size_t i = patch.first; i < std::size_t{patch.first} + patch.count; ++i) {
                const LightMapTexel& texel = state.texels[i];
                Vec3 now = lit ? light_at_texel(source, texel) : Vec3(0);
                if (now != Vec3(0) && is_in_shadow(source, texel, occluders)) {
                    now = Vec3(0);
                }
                if (format == LightMapFormat::Bytes) {
                    exchange_bytes(
                        &image.pixels[std::size_t{4} * texel.pixel], light.light[i], now);
                }
                light.light[i] = now;
            }
        }
    });
}

std::uint64_t hash_of_matrix(const Affine& world, std::uint64_t seed) {
    return hash_bytes(&world, sizeof world, seed);
}

std::uint64_t hash_of_mesh(const MeshId& mesh, const Assets& assets, std::uint64_t seed) {
    return hash_combine(hash_combine(seed, mesh.index), assets.meshes[mesh.index].version);
}

bool has_drawn_mesh(const MeshInstance& instance, const Assets& assets) {
    return instance.mesh.index < assets.meshes.size()
           && instance.material.index < assets.materials.size();
}

/// Cut into charts, unless the mesh has a second set of texture coordinates.
std::optional<ChartedMesh> charted_mesh(const MeshData& mesh, float density) {
    if (mesh.uvs1.size() != mesh.positions.size() || mesh.uvs1.empty()) {
        return cut_into_charts(mesh, density);
    }
    float area = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3& a = mesh.positions[mesh.indices[i]];
        area +=
            0.5f
            * glm::length(glm::cross(
                mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a));
    }
    const float side = std::clamp(
        std::ceil(std::sqrt(area) * density), 1.0f, static_cast<float>(kMaxLightMapSize));
    const int size = std::isfinite(side) ? static_cast<int>(side) : 1;
    return ChartedMesh{.mesh = mesh, .width = size, .height = size};
}

float largest_scale(const Affine& world) {
    float largest = 0;
    for (int c = 0; c < 3; ++c) {
        largest =
            std::max(largest, glm::length(Vec3(world.row[0][c], world.row[1][c], world.row[2][c])));
    }
    return largest;
}

/// Makes mesh, image and material of a map; false if the mesh cannot have one.
bool make_light_map(
    const LightMap& map, const Affine& world, const MeshInstance& instance, LightMapState& state,
    Assets& assets) {
    const MeshData& mesh = assets.meshes[instance.mesh.index];
    const bool deforms = !mesh.skin.joints.empty() || !mesh.morphs.empty();
    std::optional<ChartedMesh> charted;
    if (!deforms && mesh.normals.size() == mesh.positions.size()) {
        charted = charted_mesh(mesh, map.density * std::max(largest_scale(world), 1e-6f));
    }
    if (!charted) {
        log_warn(
            "light_map: the mesh {} is {}; it has none", mesh.name,
            deforms ? "skinned or morphed" : "without area or normals, or has too many charts");
        return false;
    }
    ImageData image = make_light_map_image(map.format, charted->width, charted->height);
    Material material = assets.materials[instance.material.index];
    material.name += " with a light map";
    state.mesh = {static_cast<std::uint32_t>(assets.meshes.size())};
    state.image = {static_cast<std::uint32_t>(assets.images.size())};
    state.material = {static_cast<std::uint32_t>(assets.materials.size())};
    // Mip levels would mix charts.
    material.light_map_texture = {
        .image = state.image,
        .wrap_u = Wrap::Clamp,
        .wrap_v = Wrap::Clamp,
        .uv_set = 1,
        .minify = Minify::Linear};
    assets.meshes.push_back(std::move(charted->mesh));
    assets.images.push_back(std::move(image));
    assets.materials.push_back(std::move(material));
    return true;
}

void place_texels(LightMapState& state, const Affine& world, const Assets& assets) {
    const ImageData& image = assets.images[state.image.index];
    state.texels = light_map_texels(assets.meshes[state.mesh.index], image.width, image.height);
    const auto column = [&](int c) {
        return Vec3(world.row[0][c], world.row[1][c], world.row[2][c]);
    };
    const Vec3 x = glm::cross(column(1), column(2));
    const Vec3 y = glm::cross(column(2), column(0));
    const Vec3 z = glm::cross(column(0), column(1));
    const float side = glm::dot(column(0), x) < 0 ? -1.0f : 1.0f;
    for (LightMapTexel& texel : state.texels) {
        texel.position = transform_point(world, texel.position);
        const Vec3 n = side * (texel.normal.x * x + texel.normal.y * y + texel.normal.z * z);
        texel.normal = normalize_or(n, {0, 1, 0});
    }
    state.patches = make_light_map_patches(state.texels, image.width);
    state.lights.clear();
}

LightMapFormat format_of(const ImageData& image) {
    return image.format == PixelFormat::Rgba8 ? LightMapFormat::Bytes : LightMapFormat::Floats;
}

void clear_image(ImageData& image) {
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{0});
    ++image.version;
}

void update_occluders(LightMapMeshes& maps, const Assets& assets, LightMapOccluders& occluders) {
    std::uint64_t made_of = 1;
    maps.each([&](const LightMap& map, const LightMapState&, const MeshInstance& instance,
                  const WorldTransform& transform) {
        if (map.shadows && has_drawn_mesh(instance, assets)) {
            made_of = hash_of_matrix(transform.world, hash_of_mesh(instance.mesh, assets, made_of));
        }
    });
    if (made_of == occluders.made_of) {
        return;
    }
    occluders.made_of = made_of;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    maps.each([&](const LightMap& map, const LightMapState&, const MeshInstance& instance,
                  const WorldTransform& transform) {
        if (!map.shadows || !has_drawn_mesh(instance, assets)) {
            return;
        }
        const MeshData& mesh = assets.meshes[instance.mesh.index];
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Vec3& position : mesh.positions) {
            positions.push_back(transform_point(transform.world, position));
        }
        for (const std::uint32_t index : mesh.indices) {
            indices.push_back(first + index);
        }
    });
    occluders.bvh = build_mesh_bvh(positions, indices);
}

std::vector<PlacedSource> placed_sources(LightMapLights& lights) {
    std::vector<PlacedSource> sources;
    lights.each([&](Entity entity, const WorldTransform& transform, const PointLight* point,
                    const SpotLight* spot, const DirectionalLight* sun) {
        // An entity has one light; of several the first counts.
        const LightMapSource source = point != nullptr  ? light_map_source(*point, transform.world)
                                      : spot != nullptr ? light_map_source(*spot, transform.world)
                                      : sun != nullptr  ? light_map_source(*sun, transform.world)
                                                        : LightMapSource{};
        sources.push_back({entity, source});
    });
    return sources;
}

}  // namespace

LightMapSource light_map_source(const PointLight& light, const Affine& world) {
    return valid_source(
        {.color = light.enabled ? light.color * light.intensity : Vec3(0),
         .position = position_in(world),
         .radius = light.radius,
         .attenuation = light.attenuation});
}

LightMapSource light_map_source(const SpotLight& light, const Affine& world) {
    const float outer = std::clamp(light.outer_angle, 0.0f, 0.5f * kPi);
    return valid_source(
        {.color = light.enabled ? light.color * light.intensity : Vec3(0),
         .position = position_in(world),
         .axis = axis_in(world),
         .radius = light.radius,
         .attenuation = light.attenuation,
         .inner_angle = std::clamp(light.inner_angle, 0.0f, outer),
         .outer_angle = outer,
         .profile = light.profile});
}

LightMapSource light_map_source(const DirectionalLight& light, const Affine& world) {
    return valid_source(
        {.color = light.enabled ? light.color * light.illuminance : Vec3(0),
         .axis = axis_in(world),
         .directional = true});
}

Vec3 light_at_texel(const LightMapSource& source, const LightMapTexel& texel) {
    const Vec3 offset = source.directional ? -source.axis : source.position - texel.position;
    const float distance = glm::length(offset);
    if (!(distance > 0)) {
        return Vec3(0);
    }
    const Vec3 to_light = offset / distance;
    const float cosine = std::max(glm::dot(texel.normal, to_light), 0.0f);
    const float factor = source.directional
                             ? 1.0f
                             : distance_factor(source, distance) * cone_factor(source, to_light);
    return source.color * (factor * cosine / kPi);
}

bool reaches(const LightMapSource& source, const Bounds& box) {
    if (source.color == Vec3(0)) {
        return false;
    }
    if (source.directional || source.radius <= 0) {
        return true;
    }
    const Vec3 away = source.position - glm::clamp(source.position, box.min, box.max);
    return glm::dot(away, away) <= square(source.radius);
}

std::uint64_t update_light_map(
    LightMapState& state, LightMapFormat format, std::vector<PlacedSource> sources,
    const MeshBvh* occluders, ImageData& image) {
    LIMN_CHECK(format_of(image) == format);
    add_removed_sources(state, sources);
    std::vector<std::uint8_t> touched(state.patches.size(), 0);
    for (const PlacedSource& placed : sources) {
        LightMapLight& light = stored_light(state, placed.entity);
        if (!same_source(light.source, placed.source)) {
            update_light(state, light, placed.source, format, occluders, image, touched);
        }
    }
    std::erase_if(
        state.lights, [](const LightMapLight& light) { return light.source.color == Vec3(0); });
    // Sums do not depend on the order in which lights came.
    std::sort(
        state.lights.begin(), state.lights.end(),
        [](const LightMapLight& a, const LightMapLight& b) {
            return a.entity.index < b.entity.index;
        });
    std::uint64_t texels = 0;
    for (std::size_t p = 0; p < state.patches.size(); ++p) {
        const LightMapPatch& patch = state.patches[p];
        texels += touched[p] != 0 ? patch.count : 0;
        for (std::size_t i = patch.first; touched[p] != 0 && format == LightMapFormat::Floats
                                          && i < std::size_t{patch.first} + patch.count;
             ++i) {
            store_sum(state, i, image);
        }
    }
    image.version += texels > 0 ? 1 : 0;
    state.updated_texels += texels;
    return texels;
}

ImageData make_light_map_image(LightMapFormat format, int width, int height) {
    ImageData image = {
        .name = "light map",
        .width = width,
        .height = height,
        .format = format == LightMapFormat::Floats ? PixelFormat::Rgba32F : PixelFormat::Rgba8,
        .pixels = {}};
    const std::size_t bytes = format == LightMapFormat::Floats ? sizeof(Vec4) : 4;
    image.pixels.assign(
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * bytes, 0);
    return image;
}

void add_light_map_states(Query<const LightMap, Without<LightMapState>> maps, Commands commands) {
    maps.each([&](Entity entity, const LightMap&) { commands.add(entity, LightMapState{}); });
}

void update_light_maps(
    LightMapMeshes maps, Query<MeshInstance> instances, LightMapLights lights, Res<Assets> assets,
    Res<LightMapOccluders> occluders) {
    if (maps.count() == 0) {
        return;
    }
    maps.each([&](Entity entity, const LightMap& map, LightMapState& state,
                  const MeshInstance& instance, const WorldTransform& transform) {
        const bool is_made = state.mesh != MeshId{} && instance.mesh == state.mesh;
        const bool is_refused = state.refused != MeshId{} && instance.mesh == state.refused;
        if (is_made || is_refused || !has_drawn_mesh(instance, *assets)) {
            return;
        }
        state = {};
        if (make_light_map(map, transform.world, instance, state, *assets)) {
            *instances.find<MeshInstance>(entity) = {state.mesh, state.material};
        } else {
            state.refused = instance.mesh;
        }
    });
    update_occluders(maps, *assets, *occluders);
    const std::vector<PlacedSource> sources = placed_sources(lights);
    maps.each([&](const LightMap& map, LightMapState& state, const MeshInstance& instance,
                  const WorldTransform& transform) {
        if (state.mesh == MeshId{} || instance.mesh != state.mesh) {
            return;
        }
        ImageData& image = assets->images[state.image.index];
        const std::uint64_t made_of = hash_of_matrix(
            transform.world,
            hash_of_mesh(state.mesh, *assets, map.shadows ? occluders->made_of : 0));
        if (state.made_of != made_of) {
            state.made_of = made_of;
            place_texels(state, transform.world, *assets);
            clear_image(image);
        }
        update_light_map(
            state, format_of(image), sources, map.shadows ? &occluders->bvh : nullptr, image);
    });
}

}  // namespace limn
