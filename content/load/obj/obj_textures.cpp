#include "content/load/obj/obj_textures.h"

#include "content/load/files/image_load.h"
#include "content/load/gltf/gltf_scene.h"
#include "content/load/obj/obj_maps.h"
#include "content/load/obj/obj_paths.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace limn {

namespace {

/// Perceptual roughness whose GGX lobe is as wide as a Blinn-Phong lobe of this exponent
/// (Karis 2013: alpha^2 = 2 / (n + 2)).
float roughness_of_exponent(float shininess) {
    return std::sqrt(std::sqrt(2.0f / (shininess + 2.0f)));
}

/// Codes of roughness for the codes of a map of the exponent.
std::array<std::uint8_t, 256> make_obj_roughness_table(float shininess) {
    std::array<std::uint8_t, 256> table;
    for (std::size_t code = 0; code < table.size(); ++code) {
        const float exponent = shininess * static_cast<float>(code) / 255;
        table[code] = static_cast<std::uint8_t>(std::lround(255 * roughness_of_exponent(exponent)));
    }
    return table;
}

/// MTL scales and moves coordinates whose v goes up; the engine's goes down.
TextureSlot make_obj_slot(std::uint32_t image, const ObjMap& map) {
    TextureSlot slot;
    slot.image.index = image;
    slot.scale = map.scale;
    slot.offset = {map.offset.x, 1 - map.scale.y - map.offset.y};
    slot.wrap_u = slot.wrap_v = map.clamp ? Wrap::Clamp : Wrap::Repeat;
    return slot;
}

/// A factor of a map; some programs write 0 where they write a map.
template <typename Value>
Value obj_map_factor(const std::optional<Value>& value) {
    return value && *value != Value(0) ? *value : Value(1);
}

/// Of maps that are combined, a part of the key of the result.
std::string obj_map_key(const ObjMap& map) {
    return format_text("{}#{}", map.file, static_cast<int>(map.channel));
}

}  // namespace

ObjMaterialBuilder::ObjMaterialBuilder(
    GltfScene& scene, std::string folder, const ObjLimits& limits)
    : scene_(scene), folder_(std::move(folder)), limits_(limits), pixels_left_(limits.max_pixels) {}

Material ObjMaterialBuilder::build(const ObjMaterial& source, const std::string& subfolder) {
    subfolder_ = subfolder;
    Material material;
    material.name = source.name;
    material.base_color = Vec4(source.diffuse.value_or(Vec3(0.8f)), source.opacity.value_or(1));
    material.emission = source.emission.value_or(Vec3(0));
    material.alpha_mode = material.base_color.w < 1 ? AlphaMode::Blend : AlphaMode::Opaque;
    material.roughness = source.roughness.value_or(roughness_of_exponent(source.shininess));
    material.metalness = source.metalness.value_or(0);
    add_color(source, material);
    add_relief(source, material);
    add_roughness(source, material);
    if (const ImageData* const image = load(source.emission_map)) {
        material.emission = obj_map_factor(source.emission);
        material.emission_texture =
            make_obj_slot(add_color_image(source.emission_map, *image), source.emission_map);
    }
    return material;
}

const ImageData* ObjMaterialBuilder::load(const ObjMap& map) {
    if (map.file.empty()) {
        return nullptr;
    }
    const auto [entry, is_new] = loaded_.try_emplace(subfolder_ + "/" + map.file);
    if (is_new) {
        const auto read = [&]() -> Result<ImageData> {
            const ObjFetched fetched = LIMN_TRY(
                fetch_obj_file(map.file, folder_, subfolder_, map.position, limits_.max_bytes));
            ImageLimits limits;
            limits.max_pixels =
                std::min(limits.max_pixels, static_cast<std::int64_t>(pixels_left_));
            return decode_image(
                fetched.bytes, format_text("{}: {}", map.position, fetched.path), false, limits);
        };
        if (Result<ImageData> image = read()) {
            image->name = map.file;
            pixels_left_ -= static_cast<std::uint64_t>(image->width)
                            * static_cast<std::uint64_t>(image->height);
            entry->second = *std::move(image);
        } else {
            scene_.warnings.push_back(
                format_text("{}; the material has no such image", image.error().message));
        }
    }
    return entry->second.width > 0 ? &entry->second : nullptr;
}

template <typename Make>
std::uint32_t ObjMaterialBuilder::add_image(const std::string& key, Make&& make) {
    const auto next = static_cast<std::uint32_t>(scene_.images.size());
    const auto [entry, is_new] = made_.try_emplace(subfolder_ + "/ " + key, next);
    if (is_new) {
        scene_.images.push_back(make());
    }
    return entry->second;
}

std::uint32_t ObjMaterialBuilder::add_color_image(const ObjMap& map, const ImageData& image) {
    return add_image("srgb " + obj_map_key(map), [&] {
        ImageData copy = image;
        copy.srgb = copy.format == PixelFormat::Rgba8;
        return copy;
    });
}

void ObjMaterialBuilder::add_color(const ObjMaterial& source, Material& material) {
    const ImageData* const color = load(source.diffuse_map);
    const ImageData* const opacity = load(source.opacity_map);
    if (color != nullptr) {
        material.base_color = Vec4(obj_map_factor(source.diffuse), material.base_color.w);
    }
    if (opacity != nullptr) {
        const std::uint32_t index = add_image(
            format_text(
                "{} opacity {}", color != nullptr ? obj_map_key(source.diffuse_map) : "",
                obj_map_key(source.opacity_map)),
            [&] { return with_opacity(color, *opacity, source.opacity_map.channel); });
        material.base_color_texture =
            make_obj_slot(index, color != nullptr ? source.diffuse_map : source.opacity_map);
        material.base_color.w = obj_map_factor(source.opacity);
        material.alpha_mode =
            material.base_color.w < 1 ? AlphaMode::Blend : alpha_mode_of(scene_.images[index]);
    } else if (color != nullptr) {
        material.base_color_texture =
            make_obj_slot(add_color_image(source.diffuse_map, *color), source.diffuse_map);
    }
}

void ObjMaterialBuilder::add_relief(const ObjMaterial& source, Material& material) {
    const bool has_normals = !source.normal_map.file.empty();
    const ObjMap& map = has_normals ? source.normal_map : source.relief_map;
    const ImageData* const image = load(map);
    if (image == nullptr) {
        return;
    }
    if (!has_normals && is_gray(*image)) {
        const std::uint32_t index =
            add_image(format_text("heights {} {}", obj_map_key(map), map.strength), [&] {
                return normals_of_heights(*image, map.strength, map.clamp);
            });
        material.normal_texture = make_obj_slot(index, map);
        return;
    }
    material.normal_scale = std::clamp(map.strength, 0.0f, 10.0f);
    material.normal_texture =
        make_obj_slot(add_image("data " + obj_map_key(map), [&] { return *image; }), map);
}

void ObjMaterialBuilder::add_roughness(const ObjMaterial& source, Material& material) {
    ObjScalarMap roughness{load(source.roughness_map), source.roughness_map.channel};
    ObjScalarMap metalness{load(source.metalness_map), source.metalness_map.channel};
    const std::array<std::uint8_t, 256> table = make_obj_roughness_table(source.shininess);
    const ObjMap* map = &source.metalness_map;
    if (roughness.image != nullptr) {
        map = &source.roughness_map;
        material.roughness = obj_map_factor(source.roughness);
        // One image for both is packed as in glTF.
        if (roughness.image == metalness.image && roughness.channel == metalness.channel) {
            roughness.channel = ObjChannel::Green;
            metalness.channel = ObjChannel::Blue;
        }
    } else if (const ImageData* const exponent = load(source.shininess_map)) {
        map = &source.shininess_map;
        roughness = {exponent, source.shininess_map.channel, table};
        material.roughness = 1;
    }
    if (metalness.image != nullptr) {
        material.metalness = obj_map_factor(source.metalness);
    }
    if (roughness.image == nullptr && metalness.image == nullptr) {
        return;
    }
    const std::string key = format_text(
        "roughness {} {} metalness {}", obj_map_key(*map),
        roughness.table.empty() ? 0.0f : source.shininess, obj_map_key(source.metalness_map));
    material.metal_rough_texture = make_obj_slot(
        add_image(key, [&] { return pack_roughness_and_metalness(roughness, metalness); }), *map);
}

}  // namespace limn
