#include "content/load/gltf_material.h"

#include "content/load/gltf_file.h"
#include "content/load/image_load.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <optional>

namespace limn {

namespace {

/// A picture that some material uses.
struct WantedImage {
    std::size_t source = 0;  ///< index in the file
    bool srgb = false;
};

Wrap to_wrap(int mode) {
    switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Wrap::Clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Wrap::Mirror;
    default:
        return Wrap::Repeat;
    }
}

float number_in(const tinygltf::Value& object, const char* key, float fallback) {
    return object.Has(key) ? static_cast<float>(object.Get(key).GetNumberAsDouble()) : fallback;
}

Vec2 vector_in(const tinygltf::Value& object, const char* key, const Vec2& fallback) {
    if (!object.Has(key)) {
        return fallback;
    }
    const tinygltf::Value& value = object.Get(key);
    return {
        static_cast<float>(value.Get(0).GetNumberAsDouble()),
        static_cast<float>(value.Get(1).GetNumberAsDouble())};
}

class MaterialBuilder {
  public:
    explicit MaterialBuilder(GltfDocument& document) : document_(document) {
        const JsonValue* images = document.json.find("images");
        number_.assign(images != nullptr ? 2 * images->items.size() : 0, kNoAsset);
    }

    Material build(std::size_t index) {
        const tinygltf::Material& source = document_.model.materials[index];
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        place_ = fmt::format("{}: materials[{}]", document_.file, index);

        Material material;
        material.name = source.name;
        material.double_sided = source.doubleSided;
        material.alpha_mode = source.alphaMode == "MASK"    ? AlphaMode::Mask
                              : source.alphaMode == "BLEND" ? AlphaMode::Blend
                                                            : AlphaMode::Opaque;
        material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        for (int i = 0; i < 4; ++i) {
            material.base_color[i] =
                static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
        }
        material.metalness = static_cast<float>(pbr.metallicFactor);
        material.roughness = static_cast<float>(pbr.roughnessFactor);
        material.normal_scale = static_cast<float>(source.normalTexture.scale);
        material.occlusion_strength = static_cast<float>(source.occlusionTexture.strength);
        read_emission(source, material);
        if (source.extensions.contains("KHR_materials_unlit")) {
            material.shading = ShadingModel::Unlit;
            material.metalness = 0;  // it mirrors nothing, whatever the fallback is
        }
        material.base_color_texture = slot(pbr.baseColorTexture, true);
        if (material.shading != ShadingModel::Unlit) {
            material.metal_rough_texture = slot(pbr.metallicRoughnessTexture, false);
        }
        material.normal_texture = slot(source.normalTexture, false);
        material.occlusion_texture = slot(source.occlusionTexture, false);
        material.emission_texture = slot(source.emissiveTexture, true);
        return material;
    }

    [[nodiscard]] const std::vector<WantedImage>& wanted() const { return wanted_; }

  private:
    static void read_emission(const tinygltf::Material& source, Material& material) {
        float strength = 1.0f;
        const auto extension = source.extensions.find("KHR_materials_emissive_strength");
        if (extension != source.extensions.end()) {
            strength = number_in(extension->second, "emissiveStrength", 1.0f);
        }
        for (int i = 0; i < 3; ++i) {
            material.emission[i] =
                strength * static_cast<float>(source.emissiveFactor[static_cast<std::size_t>(i)]);
        }
    }

    /// `info` is a TextureInfo, NormalTextureInfo or OcclusionTextureInfo.
    template <typename Info>
    TextureSlot slot(const Info& info, bool srgb) {
        TextureSlot result;
        if (info.index < 0) {
            return result;
        }
        const tinygltf::Texture& texture =
            document_.model.textures[static_cast<std::size_t>(info.index)];
        if (texture.source < 0) {
            warn(
                fmt::format("textures[{}] has no image in a format that is read here", info.index));
            return result;
        }
        result.image.index = want(static_cast<std::size_t>(texture.source), srgb);
        if (texture.sampler >= 0) {
            const tinygltf::Sampler& sampler =
                document_.model.samplers[static_cast<std::size_t>(texture.sampler)];
            result.wrap_u = to_wrap(sampler.wrapS);
            result.wrap_v = to_wrap(sampler.wrapT);
            result.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        }
        int uv_set = info.texCoord;
        const auto transform = info.extensions.find("KHR_texture_transform");
        if (transform != info.extensions.end()) {
            const tinygltf::Value& values = transform->second;
            result.offset = vector_in(values, "offset", {0, 0});
            result.scale = vector_in(values, "scale", {1, 1});
            result.rotation = number_in(values, "rotation", 0.0f);
            if (values.Has("texCoord")) {
                uv_set = values.Get("texCoord").GetNumberAsInt();
            }
        }
        if (uv_set > 1) {
            warn(fmt::format("uv set {} is taken for 0, since only 0 and 1 are read", uv_set));
            uv_set = 0;
        }
        result.uv_set = static_cast<std::uint8_t>(uv_set);
        return result;
    }

    void warn(const std::string& what) {
        document_.warnings.push_back(fmt::format("{}: {}", place_, what));
    }

    std::uint32_t want(std::size_t source, bool srgb) {
        std::uint32_t& number = number_[2 * source + (srgb ? 1 : 0)];
        if (number == kNoAsset) {
            number = static_cast<std::uint32_t>(wanted_.size());
            wanted_.push_back({source, srgb});
        }
        return number;
    }

    GltfDocument& document_;
    std::string place_;
    std::vector<WantedImage> wanted_;
    std::vector<std::uint32_t> number_;  ///< index into wanted_ of image i as data, as color
};

Result<ImageData>
load_wanted(const GltfDocument& document, const WantedImage& wanted, const ImageLimits& limits) {
    const JsonValue& source = json_item(document, "images", wanted.source);
    const JsonValue* uri = source.find("uri");
    const JsonValue* view = source.find("bufferView");
    const JsonValue* name = source.find("name");
    std::string place = fmt::format("{}: images[{}]", document.file, wanted.source);
    if ((uri == nullptr) == (view == nullptr)) {
        return fail(
            "{}: found {} uri and bufferView, expected one of them", place,
            uri == nullptr ? "neither" : "both");
    }
    std::vector<std::byte> fetched;
    std::span<const std::byte> bytes;
    if (uri != nullptr) {
        Result<std::vector<std::byte>> file =
            fetch_uri(uri->text, document.folder, place + ".uri", document.limits.max_bytes);
        if (!file) {
            return file.error();
        }
        fetched = std::move(*file);
        bytes = fetched;
        if (!uri->text.starts_with("data:")) {
            place += " (" + uri->text.substr(0, 200) + ")";
        }
    } else {
        bytes = view_bytes(document, static_cast<std::size_t>(view->number));
    }
    Result<ImageData> image = decode_image(bytes, place, wanted.srgb, limits);
    if (image) {
        image->name = name != nullptr  ? name->text
                      : uri != nullptr ? uri->text.substr(0, 200)
                                       : fmt::format("image {}", wanted.source);
    }
    return image;
}

}  // namespace

Status build_materials(GltfDocument& document, GltfScene& scene) {
    MaterialBuilder builder(document);
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        scene.materials.push_back(builder.build(i));
    }
    Material fallback;  // what the specification gives to a primitive without a material
    fallback.name = "default";
    fallback.base_color = {1, 1, 1, 1};
    fallback.metalness = 1.0f;
    fallback.roughness = 1.0f;
    scene.materials.push_back(fallback);

    // Decoding takes most of the time of a load. Batches bound what is decoded before the sum is
    // known.
    const std::vector<WantedImage>& wanted = builder.wanted();
    constexpr std::size_t kBatch = 8;
    std::uint64_t pixels_left = document.limits.max_pixels;
    for (std::size_t first = 0; first < wanted.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, wanted.size() - first);
        ImageLimits limits = document.limits.image;
        limits.max_pixels = std::min(limits.max_pixels, static_cast<std::int64_t>(pixels_left));
        std::vector<std::optional<Result<ImageData>>> images(count);
        parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                images[i] = load_wanted(document, wanted[first + i], limits);
            }
        });
        for (std::optional<Result<ImageData>>& image : images) {
            if (!image->ok()) {
                return image->error();
            }
            ImageData& data = image->value();
            const auto pixels =
                static_cast<std::uint64_t>(data.width) * static_cast<std::uint64_t>(data.height);
            if (pixels > pixels_left) {
                return fail(
                    "{}: found more pixels, expected at most {} in all images", document.file,
                    document.limits.max_pixels);
            }
            pixels_left -= pixels;
            scene.images.push_back(std::move(data));
        }
    }
    return Done{};
}

}  // namespace limn
