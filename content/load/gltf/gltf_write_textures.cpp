#include "content/load/gltf/gltf_write_textures.h"

#include "content/load/files/json_document.h"
#include "content/load/files/png_file.h"
#include "ecs/base/text.h"
#include "ecs/components/image_blocks.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace limn {

namespace {

int gltf_wrap(Wrap wrap) {
    switch (wrap) {
    case Wrap::Mirror:
        return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    case Wrap::Clamp:
        return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    case Wrap::Repeat:
        break;
    }
    return TINYGLTF_TEXTURE_WRAP_REPEAT;
}

int gltf_minify(Minify minify) {
    switch (minify) {
    case Minify::Nearest:
        return TINYGLTF_TEXTURE_FILTER_NEAREST;
    case Minify::Linear:
        return TINYGLTF_TEXTURE_FILTER_LINEAR;
    case Minify::NearestMipNearest:
        return TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST;
    case Minify::LinearMipNearest:
        return TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST;
    case Minify::NearestMipLinear:
        return TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
    case Minify::Auto:
    case Minify::LinearMipLinear:
        break;
    }
    return TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
}

}  // namespace

Status append_images(tinygltf::Model& model, const GltfScene& scene) {
    for (const ImageData& image_of_scene : scene.images) {
        const bool in_blocks = is_in_blocks(image_of_scene.format);
        const ImageData decoded = in_blocks ? decoded_level(image_of_scene) : ImageData{};
        const ImageData& source = in_blocks ? decoded : image_of_scene;
        if (source.format != PixelFormat::Rgba8) {
            return fail(
                "{}: found floats in the image {}, expected 8 bits: glTF has no others", scene.name,
                in_quotes(source.name));
        }
        const std::size_t bytes =
            4 * static_cast<std::size_t>(source.width) * static_cast<std::size_t>(source.height);
        if (source.width < 1 || source.height < 1 || source.pixels.size() != bytes) {
            return fail(
                "{}: found {} bytes in the image {} of {} x {} pixels, expected {}", scene.name,
                source.pixels.size(), in_quotes(source.name), source.width, source.height, bytes);
        }
        const std::vector<std::uint8_t> png =
            LIMN_TRY(png_bytes(source.width, source.height, 4, source.pixels));
        tinygltf::Image image;
        image.name = source.name;
        image.mimeType = "image/png";
        image.bufferView = append_view(model, std::as_bytes(std::span(png)));
        model.images.push_back(std::move(image));
    }
    return Done{};
}

int append_texture(tinygltf::Model& model, const TextureSlot& slot) {
    if (slot.image.index >= model.images.size()) {
        return -1;
    }
    tinygltf::Sampler sampler;
    sampler.magFilter =
        slot.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.minFilter = gltf_minify(slot.minify);
    sampler.wrapS = gltf_wrap(slot.wrap_u);
    sampler.wrapT = gltf_wrap(slot.wrap_v);
    if (slot.lod_range != TextureSlot{}.lod_range) {
        const auto level = [](float value) { return tinygltf::Value(static_cast<double>(value)); };
        tinygltf::Value::Array range = {level(slot.lod_range.x), level(slot.lod_range.y)};
        tinygltf::Value::Object limn = {{"lod_range", tinygltf::Value(std::move(range))}};
        sampler.extras =
            tinygltf::Value(tinygltf::Value::Object{{"limn", tinygltf::Value(std::move(limn))}});
    }
    const auto image = static_cast<int>(slot.image.index);
    for (std::size_t i = 0; i < model.textures.size(); ++i) {
        const tinygltf::Sampler& other =
            model.samplers[static_cast<std::size_t>(model.textures[i].sampler)];
        if (model.textures[i].source == image && other.magFilter == sampler.magFilter
            && other.minFilter == sampler.minFilter && other.wrapS == sampler.wrapS
            && other.wrapT == sampler.wrapT && other.extras == sampler.extras) {
            return static_cast<int>(i);
        }
    }
    tinygltf::Texture texture;
    texture.source = image;
    texture.sampler = static_cast<int>(model.samplers.size());
    model.samplers.push_back(std::move(sampler));
    model.textures.push_back(std::move(texture));
    return static_cast<int>(model.textures.size()) - 1;
}

}  // namespace limn
