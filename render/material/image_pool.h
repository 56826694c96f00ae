#pragma once

#include "ecs/components/surface.h"
#include "render/gpu/texture.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace limn {

namespace gpu {
class Device;
}

// The images of a level on the GPU, with full mip chains. Images of one size and format are layers
// of one texture array, so that materials which differ in their images alone are drawn together.
// An image that is missing, broken or too large is magenta.
//
// Images are only added: images of one update() share arrays, later ones get new arrays.
//
// Images in blocks (BC5, BC7) bring their mip levels along and stay in blocks, a quarter of the
// memory (engine.opt-texture). The software profile decodes them when they are uploaded: llvmpipe
// takes 50 times as long to sample BC7 as RGBA8, because it decodes a block for each texel.
//
// Normal maps have mip levels of their own (normal_mips.h), and a second image, their spread, if
// materials want to know it. Images that a pass draws on the GPU get those of any other image.

/// By image: how the normal maps among them are filtered.
using NormalMaps = std::map<std::uint32_t, NormalMips>;

/// Location of an image.
struct ImageLayer {
    std::uint32_t array = 0;  ///< 0: the magenta one
    std::uint32_t layer = 0;
};

class ImagePool {
  public:
    explicit ImagePool(gpu::Device& device);

    void clear();
    /// Uploads the images beyond size(), and what normal maps lack. A spread that was once made
    /// stays.
    void update(std::span<const ImageData> images, const NormalMaps& normal_maps = {});
    [[nodiscard]] std::size_t size() const { return images_.size(); }
    /// Uploads images again whose ImageData::version has changed.
    void refresh(std::span<const ImageData> images);
    /// Replaces the pixels of an image, in its own format and the layout of ImageData; does nothing
    /// if there is no such image or the size differs.
    void replace(ImageId id, std::span<const std::uint8_t> pixels);

    /// Magenta if there is no such image.
    [[nodiscard]] ImageLayer find(ImageId id) const {
        return id.index < images_.size() ? images_[id.index].location : ImageLayer{};
    }
    /// The spread of a normal map; array 0 if it has none.
    [[nodiscard]] ImageLayer find_spread(ImageId id) const {
        return id.index < images_.size() ? images_[id.index].spread : ImageLayer{};
    }
    /// The image as a texture of its own; null if there is no such image, or it is broken.
    [[nodiscard]] const gpu::Texture* find_texture(ImageId id) const {
        return find(id).array != 0 ? &images_[id.index].texture : nullptr;
    }
    [[nodiscard]] const gpu::Texture& array(std::uint32_t array) const {
        return arrays_[array].texture;
    }
    /// The same texels without decoding sRGB; empty except for sRGB arrays in the software profile.
    [[nodiscard]] const gpu::Texture& encoded(std::uint32_t array) const {
        return arrays_[array].encoded;
    }

  private:
    struct Array {
        gpu::Texture texture;
        gpu::Texture encoded;
        bool has_normals = false;  ///< some layers have mip levels of their own
    };
    struct Image {
        ImageLayer location;
        gpu::Texture texture;  ///< a view of its layer
        ImageLayer spread;
        std::optional<NormalMips> normals;  ///< of a normal map
        std::uint32_t version = 0;          ///< ImageData::version
    };

    /// Assigns layers to new images and spreads; returns the arrays to create.
    [[nodiscard]] std::vector<gpu::TextureDesc>
    allocate_layers(std::span<const ImageData> images, const NormalMaps& normal_maps);
    [[nodiscard]] ImageLayer
    allocate_layer(std::vector<gpu::TextureDesc>& arrays, const gpu::TextureDesc& wanted) const;
    void create_array(const gpu::TextureDesc& desc);
    void upload_normals(Image& image, const ImageData& data, NormalMips mips);

    gpu::Device& device_;
    std::vector<Array> arrays_;
    std::vector<Image> images_;
};

}  // namespace limn
