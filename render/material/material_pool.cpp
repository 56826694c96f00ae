#include "render/material/material_pool.h"

#include "ecs/base/log.h"
#include "render/gpu/device.h"
#include "render/material/detail_limit.h"
#include "render/material/material_blocks.h"
#include "render/material/relief_hook.h"
#include "render/material/skin_tone.h"
#include "render/shaders/material_maps_gpu.h"

#include <algorithm>
#include <numeric>

// Techniques: engine.material-bind, shade.batching, tex.sampling

namespace limn {
namespace {

/// Whether one fetch gives occlusion, roughness and metalness, as most exporters pack them.
bool shares_occlusion(const Material& m) {
    return is_used(m.occlusion_texture) && m.occlusion_texture == m.metal_rough_texture;
}

layout::MaterialRecord make_record(const Material& m, std::vector<Vec4>& blocks) {
    return {
        .base_color = m.base_color * Vec4(skin_tone(m), 1.0f),
        .emission = Vec4(m.emission, m.normal_scale),
        .factors =
            {m.metalness, has_wide_highlights(m) ? 0.0f : m.roughness, m.occlusion_strength,
             m.alpha_cutoff},
        .blocks = append_blocks(m, blocks),
        .maps = {}};
}

bool has_strands(ShadingModel model) {
    return model == ShadingModel::Hair || model == ShadingModel::Strand;
}

/// SurfaceFeature.
std::uint32_t bump_feature(BumpShadow shadow) {
    constexpr std::uint32_t kFeatures[] = {0, kBumpGate, kBumpSmooth, kBumpRamp};
    return kFeatures[static_cast<std::size_t>(shadow)];
}

GLenum wrap_mode(Wrap wrap) {
    return wrap == Wrap::Repeat   ? GL_REPEAT
           : wrap == Wrap::Mirror ? GL_MIRRORED_REPEAT
                                  : GL_CLAMP_TO_EDGE;
}

GLenum minify_filter(Minify minify, bool trilinear) {
    constexpr GLenum kFilters[] = {
        GL_NONE,
        GL_NEAREST,
        GL_LINEAR,
        GL_NEAREST_MIPMAP_NEAREST,
        GL_LINEAR_MIPMAP_NEAREST,
        GL_NEAREST_MIPMAP_LINEAR,
        GL_LINEAR_MIPMAP_LINEAR};
    if (minify == Minify::Auto) {
        return trilinear ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST;
    }
    return kFilters[static_cast<std::size_t>(minify)];
}

/// An image of several materials is filtered as the most demanding of them says. Plain ones are as
/// any other image: shaders normalize their means.
NormalMaps normal_maps_of(const Assets& assets) {
    NormalMaps maps;
    for (const Material& m : assets.materials) {
        const std::uint32_t image = m.normal_texture.image.index;
        if (image < assets.images.size() && !assets.images[image].srgb
            && normal_mips_of(m) != NormalMips::Plain) {
            NormalMips& mips = maps.try_emplace(image, NormalMips::Plain).first->second;
            mips = std::max(mips, normal_mips_of(m));
        }
    }
    return maps;
}

}  // namespace

MaterialPool::MaterialPool(gpu::Device& device, float anisotropy)
    : device_(device),
      anisotropy_(
          device.caps().software  // not by profile: filters change quality, not formats
              ? 1.0f
              : std::clamp(anisotropy, 1.0f, std::max(device.caps().max_anisotropy, 1.0f))),
      images_(device), record_texture_("materials", GL_RGBA32F) {}

void MaterialPool::update(const Assets& assets, bool fresh, DetailLimit limit, bool plain) {
    if (fresh) {
        images_.clear();
        material_count_ = 0;
        material_version_ = 0;
    }
    images_.refresh(assets.images);
    const bool more_images = images_.size() < assets.images.size();
    if (!fresh && !more_images && limit_ == limit && plain_ == plain
        && material_version_ == assets.material_version
        && material_count_ == assets.materials.size()) {
        return;
    }
    images_.update(assets.images, normal_maps_of(assets));

    ++revision_;
    records_.clear();
    blocks_.clear();
    batches_.clear();
    batch_of_.clear();
    models_.clear();
    displacements_.clear();
    textures_.clear();
    shading_models_ = 0;
    layers_ = 0;
    diffuses_ = false;
    curves_ = false;
    key_shadows_ = false;
    displaces_ = false;
    bump_shadows_ = false;
    add_material(Material{});
    Material missing;
    missing.shading = ShadingModel::Unlit;
    missing.base_color = {1, 0, 1, 1};
    add_material(missing);
    for (const Material& material : assets.materials) {
        Material drawn = supported(material);
        drawn.detail = limited_detail(drawn.detail, limit);
        add_material(drawn);
    }
    plain_of_.resize(records_.size());
    std::iota(plain_of_.begin(), plain_of_.end(), 0u);
    for (std::uint32_t i = 0; plain && i < assets.materials.size(); ++i) {
        if (has_fine_detail(assets.materials[i])) {
            plain_of_[i + 2] = static_cast<std::uint32_t>(records_.size());
            add_material(without_fine_detail(assets.materials[i]));
        }
    }
    limit_ = limit;
    plain_ = plain;
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

void MaterialPool::add_maps(
    const Material& material, SurfaceBatch& batch, layout::MaterialRecord& record) {
    MapBindings bindings;
    for (const MapSlot& slot : map_slots()) {
        const TextureSlot& texture = material.*slot.texture;
        if (!has_map(material, slot)) {
            continue;
        }
        if (slot.number == layout::kOcclusionSlot && shares_occlusion(material)) {
            batch.features.bits |= kOcclusionShared;
            continue;
        }
        const ImageLayer image = slot.number == layout::kNormalSpreadSlot
                                     ? images_.find_spread(texture.image)
                                     : images_.find(texture.image);
        if (slot.number == layout::kNormalSpreadSlot && image.array == 0) {
            continue;
        }
        const bool encoded = slot.number == layout::kBaseColorSlot && images_.encoded(image.array);
        const auto unit = bindings.add(
            {.array = image.array,
             .sampler = sampler_of(texture, slot.trilinear || !device_.caps().software),
             .encoded = encoded});
        if (!unit) {
            log_error(
                "material {}: its maps need more than {} texture arrays, one per size, format and "
                "sampler; drawn without {}",
                material.name, layout::kMapUnits, slot.definition);
            continue;
        }
        batch.features.maps.set(slot.number, *unit);
        batch.features.bits |= encoded ? kSrgbBaseColor : 0u;
        set_layer(record.maps, slot.number, image.layer);
    }
    batch.textures = index_of(bindings);
}

Material MaterialPool::supported(Material material) {
    const SurfaceDetail detail = supported_detail(material.detail, device_.caps());
    if (detail != material.detail && !reported_tessellation_) {
        reported_tessellation_ = true;
        log_warn(
            "material {}: no tessellation found; displaced materials are drawn as silhouette",
            material.name);
    }
    material.detail = detail;
    return material;
}

void MaterialPool::add_material(const Material& material) {
    layout::MaterialRecord record = make_record(material, blocks_);
    SurfaceBatch batch;
    batch.blend = is_see_through(material);
    batch.features.bits = uv_feature(material);
    batch.features.bits |= material.alpha_mode == AlphaMode::Mask ? kAlphaMask : 0u;
    batch.features.bits |= material.double_sided ? kDoubleSided : 0u;
    batch.features.bits |= has_strands(material.shading) ? kStrands : 0u;
    if (material.transmission > 0) {
        batch.features.bits |= kTransmission | (material.thickness > 0 ? kRefraction : 0u);
        batch.features.bits |= material.thickness > 0 && material.dispersion > 0 ? kDispersion : 0u;
    }
    batch.features.hooks = material_hooks(material);
    const MaterialLayers layers = layers_of(material);
    batch.features.bits |= layers != 0 ? kLayered : 0u;
    batch.features.bits |= (layers & kAnisotropyLayer) != 0 ? kAnisotropic : 0u;
    batch.features.bits |= has_lean_normals(material) ? kLeanNormals : 0u;
    batch.features.bits |= bump_feature(material.bump_shadow);
    batch.features.bits |= material.dress != Dress{} ? kDressed : 0u;
    add_maps(material, batch, record);
    if (batch.features.maps.has(layout::kNormalSlot)
        && (material.shading == ShadingModel::Blinn || material.shading == ShadingModel::Phong)) {
        batch.features.bits |= kClassicBumps;
    }

    const auto same = [&](const SurfaceBatch& b) {
        return b.features == batch.features && b.blend == batch.blend
               && b.textures == batch.textures;
    };
    const auto found = std::find_if(batches_.begin(), batches_.end(), same);
    batch_of_.push_back(static_cast<std::uint32_t>(found - batches_.begin()));
    if (found == batches_.end()) {
        batches_.push_back(batch);
    }
    records_.push_back(record);
    key_shadows_ =
        key_shadows_
        || (material.relief_shadow == ReliefShadow::Ray && depth_below_mesh(material) > 0);
    curves_ = curves_ || material.detail == SurfaceDetail::Silhouette;
    const bool displaced = is_tessellated(batch.features);
    displaces_ = displaces_ || displaced;
    displacements_.push_back(displaced ? material.relief_depth : 0.0f);
    const std::uint32_t model = stored_number(layers != 0 ? kLayeredModel : material.shading);
    models_.push_back(static_cast<std::uint8_t>(model));
    shading_models_ |= 1u << model;
    layers_ |= layers;
    bump_shadows_ = bump_shadows_ || material.bump_shadow != BumpShadow::None;
    diffuses_ =
        diffuses_ || (material.shading == ShadingModel::Subsurface && material.scatter != Vec3(0));
}

std::uint32_t MaterialPool::sampler_of(const TextureSlot& slot, bool trilinear) {
    const float anisotropy = slot.anisotropy > 0                           ? slot.anisotropy
                             : slot.nearest || slot.minify != Minify::Auto ? 1.0f
                                                                           : anisotropy_;
    const gpu::SamplerDesc desc = {
        .minify = minify_filter(slot.minify, trilinear),
        .magnify = static_cast<GLenum>(slot.nearest ? GL_NEAREST : GL_LINEAR),
        .wrap = wrap_mode(slot.wrap_u),
        .wrap_v = wrap_mode(slot.wrap_v),
        .anisotropy = std::max(anisotropy, 1.0f),
        .lod_bias = slot.lod_bias,
        .lod_range = {slot.lod_range.x, std::max(slot.lod_range.x, slot.lod_range.y)}};
    const auto found = std::find(sampler_descs_.begin(), sampler_descs_.end(), desc);
    const auto index = static_cast<std::uint32_t>(found - sampler_descs_.begin());
    if (found == sampler_descs_.end()) {
        samplers_.emplace_back("material", desc);
        sampler_descs_.push_back(desc);
    }
    return index;
}

std::uint32_t MaterialPool::index_of(const MapBindings& bindings) {
    const auto found = std::find(textures_.begin(), textures_.end(), bindings);
    const auto index = static_cast<std::uint32_t>(found - textures_.begin());
    if (found == textures_.end()) {
        textures_.push_back(bindings);
    }
    return index;
}

void MaterialPool::bind_textures(std::uint32_t textures) const {
    unsigned unit = layout::kFirstMapUnit;
    for (const MapBinding& map : textures_[textures].used()) {
        const gpu::Texture& texture =
            map.encoded ? images_.encoded(map.array) : images_.array(map.array);
        device_.bind_texture(unit++, texture, &samplers_[map.sampler]);
    }
}

}  // namespace limn
