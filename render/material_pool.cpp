#include "render/material_pool.h"

#include "ecs/base/log.h"
#include "render/gpu/device.h"

#include <algorithm>

namespace limn {
namespace {

/// Stored models of lib/gbuffer.glsl.
float stored_model(ShadingModel model) {
    return static_cast<float>(model) + 1.0f;
}

const TextureSlot* slots_of(const Material& m, int i) {
    const TextureSlot* slots[kMaterialTextures] = {
        &m.base_color_texture,
        &m.metal_rough_texture,
        &m.normal_texture,
        &m.occlusion_texture,
        &m.emission_texture};
    return slots[i];
}

bool plain_uv(const TextureSlot& slot) {
    return slot.uv_set == 0 && slot.offset == Vec2(0) && slot.scale == Vec2(1)
           && slot.rotation == 0;
}

layout::MaterialRecord make_record(const Material& m) {
    layout::MaterialRecord record{};
    record.base_color = m.base_color;
    record.emission = Vec4(m.emission, m.normal_scale);
    record.factors = {m.metalness, m.roughness, m.occlusion_strength, m.alpha_cutoff};
    record.specular = Vec4(m.specular, std::max(m.shininess, 1e-3f));
    record.model = {stored_model(m.shading), 0, 0, 0};
    for (int i = 0; i < kMaterialTextures; ++i) {
        const TextureSlot& slot = *slots_of(m, i);
        // Counter-clockwise as the viewer of the Khronos Group has it; v runs down the image.
        const float c = std::cos(slot.rotation);
        const float s = std::sin(slot.rotation);
        record.uv_map[2 * i] = {
            c * slot.scale.x, s * slot.scale.y, -s * slot.scale.x, c * slot.scale.y};
        record.uv_map[2 * i + 1] = {slot.offset.x, slot.offset.y, slot.uv_set, 0};
    }
    return record;
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
      anisotropy_(std::clamp(anisotropy, 1.0f, std::max(device.caps().max_anisotropy, 1.0f))),
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
    for (std::size_t i = images_.size(); i < assets.images.size(); ++i) {
        upload_image(assets.images[i]);
    }
    if (!fresh && material_version_ == assets.material_version
        && material_count_ == assets.materials.size()) {
        return;
    }

    records_.clear();
    batches_.clear();
    batch_of_.clear();
    sets_.clear();
    has_classic_ = false;
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
    record_buffer_ =
        gpu::Buffer::of("materials", std::span<const layout::MaterialRecord>(records_));
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
            "image {}: {}x{} with {} bytes, expected 1 .. {} pixels a side and all of them; it is "
            "magenta",
            image.name,
            image.width,
            image.height,
            image.pixels.size(),
            limit);
        images_.emplace_back();
        return;
    }
    gpu::Texture texture(
        image.name,
        {.format = format.format, .width = image.width, .height = image.height, .levels = 0});
    // The first row of the image is row 0 of the texture, where v = 0: as glTF has it.
    texture.upload<std::uint8_t>(std::span(image.pixels).first(needed), GL_RGBA, format.type);
    texture.generate_mipmaps();
    images_.push_back(std::move(texture));
}

void MaterialPool::add_material(const Material& material) {
    SurfaceBatch batch;
    batch.blend = material.alpha_mode == AlphaMode::Blend;
    TextureSet set;
    bool own_uvs = false;
    for (int i = 0; i < kMaterialTextures; ++i) {
        const TextureSlot& slot = *slots_of(material, i);
        if (slot.image.index != kNoAsset) {
            batch.features |= kBaseColorMap << i;
            set[i] = {slot.image.index, sampler_of(slot)};
            own_uvs = own_uvs || !plain_uv(slot);
        }
    }
    batch.features |= own_uvs ? kUvMaps : 0u;
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
    records_.push_back(make_record(material));
    has_classic_ = has_classic_ || material.shading == ShadingModel::Blinn
                   || material.shading == ShadingModel::Phong;
}

std::uint32_t MaterialPool::sampler_of(const TextureSlot& slot) {
    const std::uint32_t key = static_cast<std::uint32_t>(slot.wrap_u)
                              | static_cast<std::uint32_t>(slot.wrap_v) << 4
                              | static_cast<std::uint32_t>(slot.nearest) << 8;
    const auto found = std::find(sampler_keys_.begin(), sampler_keys_.end(), key);
    if (found == sampler_keys_.end()) {
        gpu::Sampler sampler(
            "material",
            {.magnify = static_cast<GLenum>(slot.nearest ? GL_NEAREST : GL_LINEAR),
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
            const bool there = image < images_.size() && images_[image];
            device_.bind_texture(i, there ? images_[image] : magenta_, &samplers_[set[i].sampler]);
        }
    }
}

}  // namespace limn
