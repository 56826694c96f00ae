#include "render/material/image_pool.h"

#include "ecs/base/log.h"
#include "ecs/components/image_blocks.h"
#include "render/gpu/device.h"
#include "render/material/normal_mips.h"
#include "render/shaders/material_maps_gpu.h"

#include <algorithm>

namespace limn {
namespace {

/// Larger arrays are split: drivers allocate an array in one piece.
constexpr std::size_t kMaxArrayBytes = std::size_t{256} << 20;

GLenum image_format(const ImageData& image, bool decoded) {
    switch (image.format) {
    case PixelFormat::Rgba16F:
        return GL_RGBA16F;
    case PixelFormat::Rgba32F:
        return GL_RGBA32F;
    case PixelFormat::Bc5:
        return decoded ? GL_RGBA8 : GL_COMPRESSED_RG_RGTC2;
    case PixelFormat::Bc7:
        if (!decoded) {
            return image.srgb ? GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM : GL_COMPRESSED_RGBA_BPTC_UNORM;
        }
        break;
    case PixelFormat::Rgba8:
        break;
    }
    return image.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
}

bool is_valid_image(const ImageData& image, int limit) {
    return image.width > 0 && image.height > 0 && image.width <= limit && image.height <= limit
           && image.mip_levels > 0 && image.mip_levels <= max_mip_levels(image.width, image.height)
           && image.pixels.size() >= image_bytes(image);
}

PixelFormat pixel_format(GLenum format) {
    return format == GL_RGBA16F   ? PixelFormat::Rgba16F
           : format == GL_RGBA32F ? PixelFormat::Rgba32F
                                  : PixelFormat::Rgba8;
}

/// Whether a normal map needs mip levels that say more than those it has.
bool lacks(const std::optional<NormalMips>& has, NormalMips wanted) {
    return !has || *has < wanted;
}

/// In the software profile, since software OpenGL decodes a block for each texel that it samples.
bool is_decoded(const gpu::Device& device, const ImageData& image) {
    return is_in_blocks(image.format) && device.caps().profile == gpu::Profile::Software;
}

gpu::TextureDesc array_of(const gpu::Device& device, const ImageData& image) {
    const bool decoded = is_decoded(device, image);
    return {
        .format = image_format(image, decoded),
        .width = image.width,
        .height = image.height,
        .levels = is_in_blocks(image.format) && !decoded ? image.mip_levels : 0,
        .target = GL_TEXTURE_2D_ARRAY};
}

bool is_in_blocks(const gpu::Texture& texture) {
    return gpu::format_info(texture.desc().format).pixel_format == GL_NONE;
}

void upload_level(
    gpu::Texture& array, const ImageLayer& location, const ImageData& image, int level,
    bool decoded) {
    const auto layer = static_cast<int>(location.layer);
    if (decoded) {
        const ImageData texels = decoded_level(image, level);
        array.upload(std::as_bytes(std::span(texels.pixels)), level, layer);
    } else {
        array.upload(std::as_bytes(level_pixels(image, level)), level, layer);
    }
}

bool has_room(const gpu::TextureDesc& array, const gpu::TextureDesc& wanted, int max_layers) {
    gpu::TextureDesc more = array;
    more.depth = wanted.depth;
    const bool same = more == wanted;
    more.depth = array.depth + 1;
    return same && more.depth <= max_layers && gpu::texture_bytes(more) <= kMaxArrayBytes;
}

}  // namespace

ImagePool::ImagePool(gpu::Device& device) : device_(device) {
    clear();
}

void ImagePool::clear() {
    images_.clear();
    arrays_.clear();
    gpu::Texture magenta("magenta", {.format = GL_RGBA8, .target = GL_TEXTURE_2D_ARRAY});
    const std::uint8_t pixel[4] = {255, 0, 255, 255};
    magenta.upload(std::span<const std::uint8_t>(pixel), GL_RGBA, GL_UNSIGNED_BYTE);
    arrays_.push_back({std::move(magenta), {}});
}

void ImagePool::update(std::span<const ImageData> images, const NormalMaps& normal_maps) {
    const std::size_t first = images_.size();
    const std::size_t first_array = arrays_.size();
    for (const gpu::TextureDesc& desc : allocate_layers(images, normal_maps)) {
        create_array(desc);
    }
    // The first row of the image is row 0 of the texture, where v = 0, as in glTF.
    const auto upload = [&](std::size_t i, int level) {
        upload_level(
            arrays_[images_[i].location.array].texture, images_[i].location, images[i], level,
            is_decoded(device_, images[i]));
    };
    bool decodes = false;
    for (std::size_t i = first; i < images.size(); ++i) {
        if (images_[i].location.array != 0) {
            upload(i, 0);
            decodes = decodes || is_decoded(device_, images[i]);
        }
    }
    if (decodes) {
        log_info("images in blocks are decoded: software OpenGL samples them slowly");
    }
    for (std::size_t i = first_array; i < arrays_.size(); ++i) {
        if (!is_in_blocks(arrays_[i].texture)) {
            arrays_[i].texture.generate_mipmaps();
        }
    }
    for (std::size_t i = first; i < images.size(); ++i) {
        const std::uint32_t array = images_[i].location.array;
        for (int level = 1; array != 0 && level < images[i].mip_levels; ++level) {
            upload(i, level);
            arrays_[array].has_normals = true;
        }
    }
    for (std::size_t i = first; i < images.size(); ++i) {
        if (images_[i].location.array != 0) {
            const gpu::Texture& array = arrays_[images_[i].location.array].texture;
            images_[i].texture = array.view(
                images[i].name, array.desc().format, static_cast<int>(images_[i].location.layer));
        }
    }
    for (const auto& [index, mips] : normal_maps) {
        if (index < images.size() && lacks(images_[index].normals, mips)) {
            upload_normals(images_[index], images[index], mips);
        }
    }
}

void ImagePool::upload_normals(Image& image, const ImageData& data, NormalMips mips) {
    image.normals = mips;
    if (image.location.array == 0) {
        return;
    }
    Array& array = arrays_[image.location.array];
    array.has_normals = true;
    const bool in_blocks = is_in_blocks(data.format);
    const bool stays = in_blocks && !is_decoded(device_, data);  // with the means in its own levels
    const ImageData decoded = in_blocks ? decoded_level(data) : ImageData{};
    int level = 0;
    for (const NormalLevel& texels : make_normal_levels(in_blocks ? decoded : data, mips)) {
        if (!texels.normals.empty() && !stays) {
            array.texture.upload(
                std::as_bytes(std::span(texels.normals)), level,
                static_cast<int>(image.location.layer));
        }
        if (!texels.spread.empty()) {
            arrays_[image.spread.array].texture.upload<std::uint8_t>(
                texels.spread, GL_RGBA, GL_UNSIGNED_BYTE, level,
                static_cast<int>(image.spread.layer));
        }
        ++level;
    }
    arrays_[image.spread.array].has_normals |= image.spread.array != 0;
}

void ImagePool::refresh(std::span<const ImageData> images) {
    const std::size_t count = std::min(images_.size(), images.size());
    for (std::size_t i = 0; i < count; ++i) {
        if (images_[i].version != images[i].version) {
            images_[i].version = images[i].version;
            replace({static_cast<std::uint32_t>(i)}, images[i].pixels);
        }
    }
}

void ImagePool::replace(ImageId id, std::span<const std::uint8_t> pixels) {
    const ImageLayer location = find(id);
    if (location.array == 0) {
        return;
    }
    Array& array = arrays_[location.array];
    gpu::TextureDesc level = array.texture.desc();
    level.levels = 1;
    level.depth = 1;
    if (pixels.size() != gpu::texture_bytes(level) || is_in_blocks(array.texture)) {
        return;
    }
    if (!array.has_normals) {
        array.texture.upload(std::as_bytes(pixels), 0, static_cast<int>(location.layer));
        array.texture.generate_mipmaps();  // all layers: Mesa ignores a view of one layer
        return;
    }
    level.levels = array.texture.desc().levels;
    level.target = GL_TEXTURE_2D;
    gpu::Texture single("replaced image", level);
    single.upload(std::as_bytes(pixels));
    single.generate_mipmaps();
    single.copy_to(array.texture, static_cast<int>(location.layer));
    Image& image = images_[id.index];
    if (image.normals) {
        ImageData data = {
            .name = {},
            .width = level.width,
            .height = level.height,
            .format = pixel_format(level.format),
            .pixels = {pixels.begin(), pixels.end()}};
        upload_normals(image, data, *image.normals);
    }
}

ImageLayer ImagePool::allocate_layer(
    std::vector<gpu::TextureDesc>& arrays, const gpu::TextureDesc& wanted) const {
    const int max_layers = std::min(device_.caps().max_texture_layers, 1 << layout::kLayerBits);
    const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const auto& array) {
        return has_room(array, wanted, max_layers);
    });
    const auto index = static_cast<std::uint32_t>(found - arrays.begin());
    if (found == arrays.end()) {
        arrays.push_back(wanted);
    } else {
        ++found->depth;
    }
    return {
        static_cast<std::uint32_t>(arrays_.size()) + index,
        static_cast<std::uint32_t>(arrays[index].depth) - 1};
}

std::vector<gpu::TextureDesc>
ImagePool::allocate_layers(std::span<const ImageData> images, const NormalMaps& normal_maps) {
    const int max_size = device_.caps().max_texture_size;
    std::vector<gpu::TextureDesc> arrays;
    for (std::size_t i = images_.size(); i < images.size(); ++i) {
        const ImageData& image = images[i];
        images_.emplace_back();
        images_.back().version = image.version;
        if (!is_valid_image(image, max_size)) {
            log_error(
                "image {}: found {}x{} pixels in {} bytes, expected 1 .. {} pixels per side and "
                "complete data; shown magenta",
                image.name, image.width, image.height, image.pixels.size(), max_size);
            continue;
        }
        images_.back().location = allocate_layer(arrays, array_of(device_, image));
    }
    for (const auto& [index, mips] : normal_maps) {
        if (index < images.size() && mips != NormalMips::Plain && images_[index].spread.array == 0
            && images_[index].location.array != 0) {
            gpu::TextureDesc spread = array_of(device_, images[index]);
            spread.format = GL_RGBA8;
            spread.levels = 0;
            images_[index].spread = allocate_layer(arrays, spread);
        }
    }
    return arrays;
}

void ImagePool::create_array(const gpu::TextureDesc& desc) {
    Array array = {gpu::Texture("images", desc), {}};
    if (device_.caps().profile == gpu::Profile::Software && desc.format == GL_SRGB8_ALPHA8) {
        array.encoded = array.texture.view("encoded images", GL_RGBA8);
    }
    arrays_.push_back(std::move(array));
}

}  // namespace limn
