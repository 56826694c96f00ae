#include "content/load/gltf/gltf_glossiness.h"

#include "content/load/gltf/gltf_layers.h"
#include "ecs/base/jobs.h"
#include "ecs/base/srgb.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr float kDielectric = 0.04f;  // reflectance at normal incidence

float perceived_brightness(const Vec3& color) {
    return std::sqrt(glm::dot(Vec3(0.299f, 0.587f, 0.114f), color * color));
}

/// The metalness for which the mix of dielectric and metal has the same reflectance: a root of a
/// quadratic.
float solve_metalness(float diffuse, float specular, float rest) {
    if (specular < kDielectric) {
        return 0;
    }
    const float b = diffuse * rest / (1 - kDielectric) + specular - 2 * kDielectric;
    const float c = kDielectric - specular;
    const float root = std::sqrt(std::max(b * b - 4 * kDielectric * c, 0.0f));
    return std::clamp((root - b) / (2 * kDielectric), 0.0f, 1.0f);
}

std::uint8_t byte_of(float value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

const ImageData* image_of(const GltfScene& scene, const TextureSlot& slot) {
    return slot.image.index < scene.images.size() ? &scene.images[slot.image.index] : nullptr;
}

/// Linear color and alpha of an 8 bit image at a texel of one of `width` x `height`; white without
/// an image.
struct TexelReader {
    const ImageData* image = nullptr;
    int width = 1;
    int height = 1;

    [[nodiscard]] Vec4 at(int x, int y) const {
        static const std::array<float, 256> kLinear = [] {
            std::array<float, 256> all = {};
            for (std::size_t i = 0; i < all.size(); ++i) {
                all[i] = linear_from_srgb(static_cast<float>(i) / 255);
            }
            return all;
        }();
        if (image == nullptr || image->format != PixelFormat::Rgba8) {
            return Vec4(1);
        }
        const auto column = static_cast<std::size_t>(std::int64_t{x} * image->width / width);
        const auto row = static_cast<std::size_t>(std::int64_t{y} * image->height / height);
        const std::uint8_t* const texel =
            &image->pixels[4 * (row * static_cast<std::size_t>(image->width) + column)];
        return {
            kLinear[texel[0]], kLinear[texel[1]], kLinear[texel[2]],
            static_cast<float>(texel[3]) / 255};
    }
};

class GlossyConverter {
  public:
    GlossyConverter(GltfDocument& document, GltfScene& scene)
        : document_(document), scene_(scene), pixels_left_(document.limits.max_pixels) {}

    Status convert(const GlossyMaterial& glossy) {
        Material& material = scene_.materials[glossy.material];
        const ImageData* const diffuse = image_of(scene_, material.base_color_texture);
        const ImageData* const gloss = image_of(scene_, material.metal_rough_texture);
        if (diffuse == nullptr && gloss == nullptr) {
            const MetallicRoughness made = metallic_from_specular(
                Vec3(material.base_color), glossy.specular, glossy.glossiness);
            material.base_color = Vec4(made.base_color, material.base_color.w);
            material.metalness = made.metalness;
            material.roughness = made.roughness;
            return Done{};
        }
        TextureSlot lie = material.base_color_texture;
        if (diffuse == nullptr) {
            lie = material.metal_rough_texture;
        } else if (gloss != nullptr && !lies_alike(lie, material.metal_rough_texture)) {
            document_.warnings.push_back(fmt::format(
                "{}: materials[{}]: specularGlossinessTexture lies as diffuseTexture does",
                document_.file, glossy.material));
        }
        lie.image.index = LIMN_TRY(convert_maps(glossy, material, diffuse, gloss));
        material.base_color_texture = lie;
        lie.image.index += 1;
        material.metal_rough_texture = lie;
        material.base_color = Vec4(1, 1, 1, material.base_color.w);
        material.metalness = 1;
        material.roughness = 1;
        return Done{};
    }

  private:
    /// Two converted images, and their sources.
    struct Made {
        GlossyMaterial glossy;
        Vec3 diffuse_factor;
        std::uint32_t diffuse;
        std::uint32_t gloss;
        std::uint32_t first;
    };

    static bool lies_alike(const TextureSlot& a, const TextureSlot& b) {
        return a.uv_set == b.uv_set && a.offset == b.offset && a.scale == b.scale
               && a.rotation == b.rotation && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v;
    }

    /// The index of the color; metalness and roughness follow it.
    Result<std::uint32_t> convert_maps(
        const GlossyMaterial& glossy, const Material& material, const ImageData* diffuse,
        const ImageData* gloss) {
        const Made made = {
            glossy, Vec3(material.base_color), material.base_color_texture.image.index,
            material.metal_rough_texture.image.index,
            static_cast<std::uint32_t>(scene_.images.size())};
        for (const Made& other : made_) {
            if (other.diffuse == made.diffuse && other.gloss == made.gloss
                && other.diffuse_factor == made.diffuse_factor
                && other.glossy.specular == glossy.specular
                && other.glossy.glossiness == glossy.glossiness) {
                return other.first;
            }
        }
        ImageData color;
        color.width = std::max(diffuse ? diffuse->width : 1, gloss ? gloss->width : 1);
        color.height = std::max(diffuse ? diffuse->height : 1, gloss ? gloss->height : 1);
        const auto pixels =
            static_cast<std::uint64_t>(color.width) * static_cast<std::uint64_t>(color.height);
        if (2 * pixels > pixels_left_) {
            return fail(
                "{}: found more pixels, expected at most {} in all converted images",
                document_.file, document_.limits.max_pixels);
        }
        pixels_left_ -= 2 * pixels;
        color.name = diffuse != nullptr ? diffuse->name : gloss->name;
        color.srgb = true;
        color.pixels.resize(4 * pixels);
        ImageData surface = color;
        surface.name += " metalness and roughness";
        surface.srgb = false;
        fill(
            made, {diffuse, color.width, color.height}, {gloss, color.width, color.height}, color,
            surface);
        scene_.images.push_back(std::move(color));
        scene_.images.push_back(std::move(surface));
        made_.push_back(made);
        return made.first;
    }

    static void fill(
        const Made& made, const TexelReader& diffuse, const TexelReader& gloss, ImageData& color,
        ImageData& surface) {
        parallel_for(
            static_cast<std::size_t>(color.height), 16, [&](std::size_t begin, std::size_t end) {
                for (std::size_t y = begin; y < end; ++y) {
                    for (int x = 0; x < color.width; ++x) {
                        const Vec4 d = diffuse.at(x, static_cast<int>(y));
                        const Vec4 s = gloss.at(x, static_cast<int>(y));
                        const MetallicRoughness texel = metallic_from_specular(
                            made.diffuse_factor * Vec3(d), made.glossy.specular * Vec3(s),
                            made.glossy.glossiness * s.w);
                        const std::size_t at = 4
                                               * (y * static_cast<std::size_t>(color.width)
                                                  + static_cast<std::size_t>(x));
                        for (int k = 0; k < 3; ++k) {
                            color.pixels[at + static_cast<std::size_t>(k)] =
                                byte_of(srgb_from_linear(texel.base_color[k]));
                        }
                        color.pixels[at + 3] = byte_of(d.w);
                        surface.pixels[at] = 255;
                        surface.pixels[at + 1] = byte_of(texel.roughness);
                        surface.pixels[at + 2] = byte_of(texel.metalness);
                        surface.pixels[at + 3] = 255;
                    }
                }
            });
    }

    GltfDocument& document_;
    GltfScene& scene_;
    std::uint64_t pixels_left_;
    std::vector<Made> made_;
};

void drop_unused_images(GltfScene& scene) {
    std::vector<std::uint32_t> number(scene.images.size(), kNoAsset);
    std::vector<ImageData> kept;
    for (Material& material : scene.materials) {
        for (TextureSlot Material::*const slot : kGltfSlots) {
            std::uint32_t& index = (material.*slot).image.index;
            if (index == kNoAsset) {
                continue;
            }
            if (number[index] == kNoAsset) {
                number[index] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(std::move(scene.images[index]));
            }
            index = number[index];
        }
    }
    scene.images = std::move(kept);
}

}  // namespace

MetallicRoughness
metallic_from_specular(const Vec3& diffuse, const Vec3& specular, float glossiness) {
    constexpr float kTiny = 1e-6f;
    const float rest = 1 - std::max({specular.x, specular.y, specular.z});
    const float metalness =
        solve_metalness(perceived_brightness(diffuse), perceived_brightness(specular), rest);
    const Vec3 of_dielectric =
        diffuse * (rest / (1 - kDielectric) / std::max(1 - metalness, kTiny));
    const Vec3 of_metal =
        (specular - Vec3(kDielectric * (1 - metalness))) / std::max(metalness, kTiny);
    const Vec3 color = glm::mix(of_dielectric, of_metal, metalness * metalness);
    return {glm::clamp(color, Vec3(0), Vec3(1)), metalness, 1 - glossiness};
}

Status convert_glossy_materials(
    GltfDocument& document, GltfScene& scene, std::span<const GlossyMaterial> glossy) {
    GlossyConverter converter(document, scene);
    for (const GlossyMaterial& material : glossy) {
        LIMN_TRY(converter.convert(material));
    }
    if (!glossy.empty()) {
        drop_unused_images(scene);
    }
    return Done{};
}

}  // namespace limn
