#include "content/load/files/file_uri.h"
#include "content/load/files/texture_load.h"
#include "content/load/gltf/gltf_document.h"
#include "content/load/gltf/gltf_glossiness.h"
#include "content/load/gltf/gltf_layers.h"
#include "content/load/gltf/gltf_material_extras.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <optional>

namespace limn {

namespace {

/// An image that a material uses.
struct UsedImage {
    std::size_t source = 0;  ///< index in the file
    bool srgb = false;
    int fallback = -1;  ///< index of another image, where this one cannot be read
};

constexpr float kIndex = 1.5f;  ///< of refraction, by default
constexpr float kMaxIndex = 3;
constexpr float kMaxThickness = 1000;  // [m]

Wrap to_wrap(std::int32_t mode) {
    switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Wrap::Clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Wrap::Mirror;
    default:
        return Wrap::Repeat;
    }
}

/// Trilinear filters, which nearly all files ask for, are left to what the device is quick at.
Minify to_minify(std::int32_t filter) {
    switch (filter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
        return Minify::Nearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
        return Minify::Linear;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        return Minify::NearestMipNearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
        return Minify::LinearMipNearest;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        return Minify::NearestMipLinear;
    default:
        return Minify::Auto;
    }
}

/// The image of a texture in any supported format, DDS and WebP first; -1 if there is none.
int image_of(const tinygltf::Texture& texture) {
    for (const char* const extension : {"MSFT_texture_dds", "EXT_texture_webp"}) {
        const tinygltf::Value& source =
            member_of(extension_of(texture.extensions, extension), "source");
        if (source.IsNumber()) {
            return source.GetNumberAsInt();
        }
    }
    return texture.source;
}

/// A textureInfo of an extension; tinygltf knows only those of the standard.
tinygltf::TextureInfo texture_of(const tinygltf::Value& owner, const char* name) {
    tinygltf::TextureInfo info;
    const tinygltf::Value& source = member_of(owner, name);
    if (source.IsObject()) {
        info.index = member_of(source, "index").GetNumberAsInt();
        info.texCoord = static_cast<int>(number_of(source, "texCoord", 0));
        const tinygltf::Value& extensions = member_of(source, "extensions");
        for (const std::string& key : extensions.Keys()) {
            info.extensions[key] = extensions.Get(key);
        }
    }
    return info;
}

class MaterialBuilder {
  public:
    explicit MaterialBuilder(GltfDocument& document)
        : document_(document), number_(2 * document.images.size(), kNoAsset) {}

    Material build(std::size_t index) {
        const tinygltf::Material& source = document_.model.materials[index];
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        where_ = fmt::format("{}: materials[{}]", document_.file, index);

        Material material;
        material.name = source.name;
        material.double_sided = source.doubleSided;
        material.alpha_mode = source.alphaMode == "MASK"    ? AlphaMode::Mask
                              : source.alphaMode == "BLEND" ? AlphaMode::Blend
                                                            : AlphaMode::Opaque;
        material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        material.base_color = vector_of(pbr.baseColorFactor, Vec4(1));
        material.metalness = static_cast<float>(pbr.metallicFactor);
        material.roughness = static_cast<float>(pbr.roughnessFactor);
        material.normal_scale = static_cast<float>(source.normalTexture.scale);
        material.occlusion_strength = static_cast<float>(source.occlusionTexture.strength);
        warn_of_bright(source.emissiveFactor);
        const tinygltf::Value& emission =
            extension_of(source.extensions, "KHR_materials_emissive_strength");
        material.emission =
            number_of(emission, "emissiveStrength", 1) * vector_of(source.emissiveFactor, Vec3(0));
        if (source.extensions.contains("KHR_materials_unlit")) {
            material.shading = ShadingModel::Unlit;
            material.metalness = 0;  // no reflections, whatever the fallback is
        }
        const tinygltf::Value& glossiness =
            extension_of(source.extensions, "KHR_materials_pbrSpecularGlossiness");
        if (material.shading == ShadingModel::Unlit) {
            material.base_color_texture = slot(pbr.baseColorTexture, true);
        } else if (glossiness.IsObject()) {
            read_glossiness(glossiness, static_cast<std::uint32_t>(index), material);
        } else {
            material.base_color_texture = slot(pbr.baseColorTexture, true);
            material.metal_rough_texture = slot(pbr.metallicRoughnessTexture, false);
        }
        material.normal_texture = slot(source.normalTexture, false);
        material.occlusion_texture = slot(source.occlusionTexture, false);
        material.emission_texture = slot(source.emissiveTexture, true);
        if (material.shading == ShadingModel::Pbr && !glossiness.IsObject()) {
            add_layers(source.extensions, material);
        }
        transmit(source.extensions, material);
        add_extras(index, material);
        return material;
    }

    [[nodiscard]] const std::vector<UsedImage>& used() const { return used_; }
    [[nodiscard]] const std::vector<GlossyMaterial>& glossy() const { return glossy_; }

  private:
    /// Some files predate KHR_materials_emissive_strength.
    void warn_of_bright(const std::vector<double>& factor) {
        const auto largest = std::ranges::max_element(factor);
        if (largest != factor.end() && *largest > 1 + 1e-5) {
            document_.warnings.push_back(fmt::format(
                "{}.emissiveFactor: found {:.6g}, expected at most 1; it is used as it is", where_,
                *largest));
        }
    }

    void add_extras(std::size_t index, Material& material) {
        const JsonValue* const limn = extras_of(document_, "materials", index).find("limn");
        if (limn == nullptr) {
            return;
        }
        const tinygltf::Value& source = document_.model.materials[index].extras.Get("limn");
        Material with = material;
        const Status read = read_material_extras(
            *limn, {document_.file, fmt::format("materials[{}].extras.limn", index)},
            [&](const std::string& name) { return extra_slot(source, name); }, with);
        if (read) {
            material = std::move(with);
        } else {
            document_.warnings.push_back(read.error().message + "; drawn without");
        }
    }

    /// Of extras, which no schema has checked.
    TextureSlot extra_slot(const tinygltf::Value& limn, const std::string& name) {
        const tinygltf::Value& index = member_of(member_of(limn, name.c_str()), "index");
        const double found = index.IsNumber() ? index.GetNumberAsDouble() : -1;
        if (!(found >= 0 && found < static_cast<double>(document_.model.textures.size()))) {
            warn(fmt::format(
                "extras.limn.{}: found no index of a texture, expected {{\"index\": 0}} or the "
                "like; "
                "drawn without",
                name));
            return {};
        }
        return slot(texture_of(limn, name.c_str()), false);
    }

    void read_glossiness(const tinygltf::Value& source, std::uint32_t index, Material& material) {
        material.base_color = vector_of(source, "diffuseFactor", Vec4(1));
        material.base_color_texture = slot(texture_of(source, "diffuseTexture"), true);
        material.metal_rough_texture = slot(texture_of(source, "specularGlossinessTexture"), true);
        glossy_.push_back(
            {index, vector_of(source, "specularFactor", Vec3(1)),
             number_of(source, "glossinessFactor", 1)});
    }

    void add_layers(const tinygltf::ExtensionMap& extensions, Material& material) {
        read_layer_factors(extensions, material);
        for (const LayerTexture& texture : kLayerTextures) {
            const tinygltf::Value& extension = extension_of(extensions, texture.extension);
            material.*texture.slot = slot(texture_of(extension, texture.member), texture.srgb);
        }
        const tinygltf::Value& normals = member_of(
            extension_of(extensions, "KHR_materials_clearcoat"), "clearcoatNormalTexture");
        material.clearcoat_normal_scale = std::clamp(number_of(normals, "scale", 1), -10.0f, 10.0f);
    }

    /// An opaque material. The index 0 stands for a reflectance of 1 at normal incidence.
    static void reflect_by_index(float index, Material& material) {
        if (material.shading == ShadingModel::Pbr) {
            material.refractive_index = index == 0 ? kMaxIndex : std::clamp(index, 1.0f, kMaxIndex);
            material.specular_tint *= index == 0 ? square((kMaxIndex + 1) / (kMaxIndex - 1)) : 1.0f;
        }
    }

    void transmit(const tinygltf::ExtensionMap& extensions, Material& material) {
        const tinygltf::Value& transmission =
            extension_of(extensions, "KHR_materials_transmission");
        const float factor = number_of(transmission, "transmissionFactor", 0);
        const float index = number_of(extension_of(extensions, "KHR_materials_ior"), "ior", kIndex);
        if (factor <= 0 || material.alpha_mode == AlphaMode::Mask) {
            reflect_by_index(index, material);
            return;
        }
        const tinygltf::Value& volume = extension_of(extensions, "KHR_materials_volume");
        material.transmission = factor;
        material.transmission_texture =
            slot(texture_of(transmission, "transmissionTexture"), false);
        material.refractive_index = std::clamp(index, 1.0f, kMaxIndex);
        material.thickness = std::min(number_of(volume, "thicknessFactor", 0), kMaxThickness);
        if (material.thickness > 0) {
            material.thickness_texture = slot(texture_of(volume, "thicknessTexture"), false);
        }
        const float distance = number_of(volume, "attenuationDistance", 0);
        if (distance > 0) {
            material.attenuation_distance = distance;
            material.attenuation_color = vector_of(volume, "attenuationColor", Vec3(1));
        }
    }

    template <typename TextureInfo>
    TextureSlot slot(const TextureInfo& info, bool srgb) {
        TextureSlot result;
        if (info.index < 0) {
            return result;
        }
        const tinygltf::Texture& texture = item_at(document_.model.textures, info.index);
        const int source = image_of(texture);
        if (source < 0) {
            warn(fmt::format("textures[{}] has no image in a supported format", info.index));
            return result;
        }
        const int fallback = texture.source != source ? texture.source : -1;
        result.image.index = use_image(static_cast<std::size_t>(source), srgb, fallback);
        if (texture.sampler >= 0) {
            const tinygltf::Sampler& sampler = item_at(document_.model.samplers, texture.sampler);
            result.wrap_u = to_wrap(sampler.wrapS);
            result.wrap_v = to_wrap(sampler.wrapT);
            result.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
            result.minify = to_minify(sampler.minFilter);
            result.lod_range = lod_range_of(texture.sampler, result.lod_range);
        }
        const tinygltf::Value& transform = extension_of(info.extensions, "KHR_texture_transform");
        result.offset = vector_of(transform, "offset", Vec2(0));
        result.scale = vector_of(transform, "scale", Vec2(1));
        result.rotation = number_of(transform, "rotation", 0);
        const tinygltf::Value& uv_set = member_of(transform, "texCoord");
        const int set = uv_set.IsNumber() ? uv_set.GetNumberAsInt() : info.texCoord;
        if (set > 1) {
            warn(fmt::format("uv set {} is unsupported, 0 is used instead", set));
        }
        result.uv_set = set == 1 ? 1 : 0;
        return result;
    }

    /// Of extras.limn of a sampler, which no schema has checked.
    Vec2 lod_range_of(int sampler, const Vec2& all) {
        const JsonValue& range = extras_of(
            document_, "samplers", static_cast<std::size_t>(sampler))["limn"]["lod_range"];
        if (range.kind == JsonKind::Null) {
            return all;
        }
        const auto is_level = [&](const JsonValue& value) {
            return value.kind == JsonKind::Number && value.number >= static_cast<double>(all.x)
                   && value.number <= static_cast<double>(all.y);
        };
        if (range.items.size() != 2 || !std::ranges::all_of(range.items, is_level)
            || range.items[0].number > range.items[1].number) {
            warn(fmt::format(
                "samplers[{}].extras.limn.lod_range: expected the first and the last mip level, "
                "two "
                "numbers from {} to {}; all are used",
                sampler, all.x, all.y));
            return all;
        }
        return {range.items[0].number, range.items[1].number};
    }

    void warn(const std::string& what) {
        document_.warnings.push_back(fmt::format("{}: {}", where_, what));
    }

    std::uint32_t use_image(std::size_t source, bool srgb, int fallback) {
        std::uint32_t& number = number_[2 * source + (srgb ? 1 : 0)];
        if (number == kNoAsset) {
            number = static_cast<std::uint32_t>(used_.size());
            used_.push_back({source, srgb, fallback});
        }
        return number;
    }

    GltfDocument& document_;
    std::string where_;
    std::vector<UsedImage> used_;
    std::vector<GlossyMaterial> glossy_;
    std::vector<std::uint32_t> number_;  ///< index into used_ of image i as data, as color
};

Result<ImageData>
load_used(const GltfDocument& document, const UsedImage& used, const ImageLimits& limits) {
    const GltfImage& source = document.images[used.source];
    std::string where = fmt::format("{}: images[{}]", document.file, used.source);
    if (source.uri.has_value() == (source.view >= 0)) {
        return fail(
            "{}: found {} uri and bufferView, expected one of them", where,
            source.uri ? "both" : "neither");
    }
    std::vector<std::byte> fetched;
    std::span<const std::byte> bytes;
    if (source.uri) {
        fetched = LIMN_TRY(
            fetch_uri(*source.uri, document.folder, where + ".uri", document.limits.max_bytes));
        bytes = fetched;
        if (!source.uri->starts_with("data:")) {
            where += " (" + source.uri->substr(0, 200) + ")";
        }
    } else {
        bytes = LIMN_TRY(view_bytes(document, source.view));
    }
    ImageData image = LIMN_TRY(decode_texture(bytes, where, used.srgb, limits));
    const std::string& name = document.model.images[used.source].name;
    image.name = !name.empty() ? name
                 : source.uri  ? source.uri->substr(0, 200)
                               : fmt::format("image {}", used.source);
    return image;
}

/// DDS files often have formats that we do not read, and a PNG beside them.
Result<ImageData> load_used_or_fallback(
    const GltfDocument& document, const UsedImage& used, const ImageLimits& limits) {
    Result<ImageData> image = load_used(document, used, limits);
    if (!image && used.fallback >= 0) {
        const auto source = static_cast<std::size_t>(used.fallback);
        if (Result<ImageData> other = load_used(document, {source, used.srgb}, limits)) {
            return other;
        }
    }
    return image;
}

std::uint64_t pixels_of(const ImageData& image) {
    return static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
}

/// Fills `scene.images`; slots of images that cannot be read become empty.
void load_images(GltfDocument& document, const std::vector<UsedImage>& used, GltfScene& scene) {
    // Decoding dominates the load time, so it is parallel; batches limit what is decoded before the
    // total is checked.
    constexpr std::size_t kBatch = 8;
    std::vector<std::uint32_t> numbers;  // in the scene, of each used image
    std::vector<bool> failed(document.images.size(), false);
    std::uint64_t pixels_left = document.limits.max_pixels;
    for (std::size_t first = 0; first < used.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, used.size() - first);
        ImageLimits limits = document.limits.image;
        limits.max_pixels = std::min(limits.max_pixels, static_cast<std::int64_t>(pixels_left));
        std::vector<std::optional<Result<ImageData>>> images(count);
        parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                images[i] = load_used_or_fallback(document, used[first + i], limits);
            }
        });
        for (std::optional<Result<ImageData>>& image : images) {
            const std::size_t source = used[numbers.size()].source;
            if (*image && pixels_of(**image) > pixels_left) {
                *image = fail(
                    "{}: images[{}]: found {} more pixels, expected at most {} in all images",
                    document.file, source, pixels_of(**image), document.limits.max_pixels);
            }
            numbers.push_back(*image ? static_cast<std::uint32_t>(scene.images.size()) : kNoAsset);
            if (*image) {
                pixels_left -= pixels_of(**image);
                scene.images.push_back(**std::move(image));
            } else if (!failed[source]) {  // as color and as data: one warning
                failed[source] = true;
                warn_of_loss(document, image->error(), "materials are without it");
            }
        }
    }
    for (Material& material : scene.materials) {
        const auto renumber = [&](TextureSlot Material::*slot) {
            TextureSlot& texture = material.*slot;
            if (texture.image.index != kNoAsset) {
                texture.image.index = numbers[texture.image.index];
                texture = texture.image.index != kNoAsset ? texture : TextureSlot{};
            }
        };
        std::ranges::for_each(kGltfSlots, renumber);
        std::ranges::for_each(kExtraSlots, renumber);
    }
}

}  // namespace

Status build_materials(GltfDocument& document, GltfScene& scene) {
    MaterialBuilder builder(document);
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        scene.materials.push_back(builder.build(i));
    }
    Material fallback;  // specified for primitives without a material
    fallback.name = "default";
    fallback.base_color = {1, 1, 1, 1};
    fallback.metalness = 1.0f;
    fallback.roughness = 1.0f;
    scene.materials.push_back(fallback);
    load_images(document, builder.used(), scene);
    return convert_glossy_materials(document, scene, builder.glossy());
}

}  // namespace limn
