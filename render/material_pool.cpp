#include "render/material_pool.h"

#include "ecs/base/log.h"
#include "render/gpu/device.h"
#include "render/material_blocks.h"
#include "render/material_uv.h"

#include <algorithm>

namespace limn {
namespace {

/// Whether one fetch gives occlusion, roughness and metalness, as most exporters pack them.
bool shares_occlusion(const Material& m) {
    const TextureSlot& a = m.occlusion_texture;
    const TextureSlot& b = m.metal_rough_texture;
    return a.image.index != kNoAsset && a.image == b.image && a.wrap_u == b.wrap_u
           && a.wrap_v == b.wrap_v && a.nearest == b.nearest && same_uv(a, b);
}

layout::MaterialRecord make_record(const Material& m, std::vector<Vec4>& blocks) {
    return {
        .base_color = m.base_color,
        .emission = Vec4(m.emission, m.normal_scale),
        .factors = {m.metalness, m.roughness, m.occlusion_strength, m.alpha_cutoff},
        .blocks = append_blocks(m, blocks)};
}

GLenum wrap_mode(Wrap wrap) {
    return wrap == Wrap::Repeat   ? GL_REPEAT
           : wrap == Wrap::Mirror ? GL_MIRRORED_REPEAT
                                  : GL_CLAMP_TO_EDGE;
}

struct ImageFormat {
    GLenum format;
    GLenum type;
    std::size_t bytes;
};

ImageFormat image_format(const ImageData& image) {
    switch (image.format) {
    case PixelFormat::Rgba8:
        return {static_cast<GLenum>(image.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8), GL_UNSIGNED_BYTE, 4};
    case PixelFormat::Rgba16F:
        return {GL_RGBA16F, GL_HALF_FLOAT, 8};
    case PixelFormat::Rgba32F:
        return {GL_RGBA32F, GL_FLOAT, 16};
    }
    return {GL_RGBA8, GL_UNSIGNED_BYTE, 4};
}

}  // namespace

MaterialPool::MaterialPool(gpu::Device& device, float anisotropy)
    : device_(device),
      anisotropy_(
          device.caps().software  // not by profile: filters change quality, not formats
              ? 1.0f
              : std::clamp(anisotropy, 1.0f, std::max(device.caps().max_anisotropy, 1.0f))),
      magenta_("magenta", {.format = GL_RGBA8}), record_texture_("materials", GL_RGBA32F) {
    const std::uint8_t pixel[4] = {255, 0, 255, 255};
    magenta_.upload(std::span<const std::uint8_t>(pixel), GL_RGBA, GL_UNSIGNED_BYTE);
}

void MaterialPool::update(const Assets& assets, bool fresh) {
    if (fresh) {
        images_.clear();
        material_count_ = 0;
        material_version_ = 0;
    }
    const bool more_images = images_.size() < assets.images.size();
    for (std::size_t i = images_.size(); i < assets.images.size(); ++i) {
        upload_image(assets.images[i]);
    }
    if (!fresh && !more_images && material_version_ == assets.material_version
        && material_count_ == assets.materials.size()) {
        return;
    }

    ++revision_;
    records_.clear();
    blocks_.clear();
    batches_.clear();
    batch_of_.clear();
    models_.clear();
    sets_.clear();
    shading_models_ = 0;
    add_material(Material{});
    Material missing;
    missing.shading = ShadingModel::Unlit;
    missing.base_color = {1, 0, 1, 1};
    add_material(missing);
    for (const Material& material : assets.materials) {
        add_material(material);
    }
    material_count_ = assets.materials.size();
    material_version_ = assets.material_version;
    upload_records();
}

/// The blocks follow the records.
void MaterialPool::upload_records() {
    const auto first_block = static_cast<float>(records_.size() * layout::kMaterialTexels);
    for (layout::MaterialRecord& record : records_) {
        record.blocks.x += first_block;
    }
    const std::span<const layout::MaterialRecord> records = records_;
    const std::span<const Vec4> blocks = blocks_;
    record_buffer_ = gpu::Buffer(
        "materials", records.size_bytes() + blocks.size_bytes(), gpu::BufferUse::Dynamic);
    record_buffer_.write(0, records);
    record_buffer_.write(records.size_bytes(), blocks);
    record_texture_.set(record_buffer_);
}

void MaterialPool::upload_image(const ImageData& image) {
    const ImageFormat format = image_format(image);
    const std::size_t needed =
        image.width > 0 && image.height > 0
            ? static_cast<std::size_t>(image.width) * image.height * format.bytes
            : 1;
    const int limit = device_.caps().max_texture_size;
    if (image.width <= 0 || image.height <= 0 || image.width > limit || image.height > limit
        || image.pixels.size() < needed) {
        log_error(
            "image {}: found {}x{} pixels in {} bytes, expected 1 .. {} pixels per side and "
            "complete "
            "data; shown magenta",
            image.name, image.width, image.height, image.pixels.size(), limit);
        images_.emplace_back();
        return;
    }
    gpu::Texture texture(
        image.name,
        {.format = format.format, .width = image.width, .height = image.height, .levels = 0});
    // The first row of the image is row 0 of the texture, where v = 0, as in glTF.
    texture.upload<std::uint8_t>(std::span(image.pixels).first(needed), GL_RGBA, format.type);
    texture.generate_mipmaps();
    gpu::GlObject<gpu::ObjectKind::Texture> encoded;
    if (device_.caps().profile == gpu::Profile::Software && format.format == GL_SRGB8_ALPHA8) {
        GLuint id = 0;
        glGenTextures(1, &id);
        glTextureView(
            id, GL_TEXTURE_2D, texture.id(), GL_RGBA8, 0,
            static_cast<GLuint>(texture.desc().levels), 0, 1);
        encoded = gpu::GlObject<gpu::ObjectKind::Texture>(id, image.name);
    }
    images_.push_back({std::move(texture), std::move(encoded)});
}

bool MaterialPool::reads_encoded(ImageId image) const {
    return image.index < images_.size() && static_cast<bool>(images_[image.index].encoded);
}

void MaterialPool::add_material(const Material& material) {
    SurfaceBatch batch;
    batch.blend = material.alpha_mode == AlphaMode::Blend;
    TextureSet set;
    for (int i = 0; i < kMaterialTextures; ++i) {
        const TextureSlot& slot = texture_slot(material, i);
        if (slot.image.index != kNoAsset) {
            batch.features |= kBaseColorMap << i;
            set[i] = {slot.image.index, sampler_of(slot, i == 0 || !device_.caps().software)};
        }
    }
    if (shares_occlusion(material)) {
        batch.features = (batch.features & ~kOcclusionMap) | kOcclusionShared;
        set[3] = {};
    }
    batch.features |= uv_feature(material);
    batch.features |= reads_encoded(material.base_color_texture.image) ? kSrgbBaseColor : 0u;
    batch.features |= material.alpha_mode == AlphaMode::Mask ? kAlphaMask : 0u;
    batch.features |= material.double_sided ? kDoubleSided : 0u;
    batch.textures = texture_set(set);

    const auto same = [&](const SurfaceBatch& b) {
        return b.features == batch.features && b.blend == batch.blend
               && b.textures == batch.textures;
    };
    const auto found = std::find_if(batches_.begin(), batches_.end(), same);
    batch_of_.push_back(static_cast<std::uint32_t>(found - batches_.begin()));
    if (found == batches_.end()) {
        batches_.push_back(batch);
    }
    records_.push_back(make_record(material, blocks_));
    models_.push_back(static_cast<std::uint8_t>(stored_number(material.shading)));
    shading_models_ |= 1u << stored_number(material.shading);
}

std::uint32_t MaterialPool::sampler_of(const TextureSlot& slot, bool trilinear) {
    const std::uint32_t key = static_cast<std::uint32_t>(slot.wrap_u)
                              | static_cast<std::uint32_t>(slot.wrap_v) << 4
                              | static_cast<std::uint32_t>(slot.nearest) << 8
                              | static_cast<std::uint32_t>(trilinear) << 9;
    const auto found = std::find(sampler_keys_.begin(), sampler_keys_.end(), key);
    if (found == sampler_keys_.end()) {
        gpu::Sampler sampler(
            "material", {.minify = static_cast<GLenum>(
                             trilinear ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST),
                         .magnify = static_cast<GLenum>(slot.nearest ? GL_NEAREST : GL_LINEAR),
                         .wrap = wrap_mode(slot.wrap_u),
                         .anisotropy = slot.nearest ? 1.0f : anisotropy_});
        glSamplerParameteri(
            sampler.id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap_mode(slot.wrap_v)));
        samplers_.push_back(std::move(sampler));
        sampler_keys_.push_back(key);
        return static_cast<std::uint32_t>(samplers_.size() - 1);
    }
    return static_cast<std::uint32_t>(found - sampler_keys_.begin());
}

std::uint32_t MaterialPool::texture_set(const TextureSet& set) {
    const auto found = std::find(sets_.begin(), sets_.end(), set);
    const auto index = static_cast<std::uint32_t>(found - sets_.begin());
    if (found == sets_.end()) {
        sets_.push_back(set);
    }
    return index;
}

void MaterialPool::bind_textures(std::uint32_t textures) const {
    const TextureSet& set = sets_[textures];
    for (unsigned i = 0; i < set.size(); ++i) {
        const std::uint32_t image = set[i].image;
        if (image != kNoAsset) {
            const gpu::Sampler* sampler = &samplers_[set[i].sampler];
            if (image >= images_.size() || !images_[image].texture) {
                device_.bind_texture(i, magenta_, sampler);
            } else if (images_[image].encoded && i == 0) {
                device_.bind_texture_name(i, images_[image].encoded.id(), sampler);
            } else {
                device_.bind_texture(i, images_[image].texture, sampler);
            }
        }
    }
}

}  // namespace limn
