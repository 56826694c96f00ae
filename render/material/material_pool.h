#pragma once

#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"
#include "render/gpu/buffer.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/texture.h"
#include "render/material/image_pool.h"
#include "render/material/material_layers.h"
#include "render/material/material_maps.h"
#include "render/material/shading_models.h"
#include "render/material/surface_features.h"
#include "render/shaders/material_gpu.h"

#include <span>
#include <vector>

namespace limn {

namespace gpu {
class Device;
}

// Materials as one array of records, followed by their blocks (material_blocks.h). Materials with
// the same program, fixed state, texture arrays and samplers share a batch: instances of a batch
// are drawn together, whatever their mesh and material.
//
// Cheaper settings on a software OpenGL, where filtering that is free on a GPU has a cost: the sRGB
// of the base color is decoded after filtering (a third of the cost), only the base color is
// filtered trilinearly, and nothing anisotropically (five times the cost). Emission is decoded
// before filtering: at the edges of lit windows the error would be visible.

/// Materials that share a draw state.
struct SurfaceBatch {
    SurfaceFeatures features;
    bool blend = false;
    std::uint32_t textures = 0;  ///< index for MaterialPool::bind_textures
};

class MaterialPool {
  public:
    MaterialPool(gpu::Device& device, float anisotropy);

    /// Uploads changes of `assets`: new images, and all materials if any were added or their
    /// version changed. `fresh`: the assets were replaced since the last call. Materials with
    /// dearer surface detail than `limit` fall to it. A map that would need one texture array more
    /// than a material has units is left out, with an error.
    /// `plain`: materials with fine detail also get a record without, plain_record_of().
    void update(
        const Assets& assets, bool fresh, DetailLimit limit = DetailLimit::Full,
        bool plain = false);

    /// Record index of a material; 0 for none, 1 for an unknown one.
    [[nodiscard]] std::uint32_t record_of(MaterialId id) const {
        return id.index == kNoAsset ? 0 : id.index + 2 < plain_of_.size() ? id.index + 2 : 1;
    }
    /// The record of the same material without normal maps and relief, for what is small in the
    /// image; the same one if it has none.
    [[nodiscard]] std::uint32_t plain_record_of(std::uint32_t record) const {
        return plain_of_[record];
    }
    [[nodiscard]] std::uint32_t batch_of(std::uint32_t record) const { return batch_of_[record]; }
    /// Appends to a table by the records of assets' materials what plain records have, that of the
    /// same material.
    template <typename T>
    void append_plain(std::vector<T>& of_record) const {
        for (std::size_t i = 0; i < plain_of_.size(); ++i) {
            if (plain_of_[i] != i) {  // in rising order
                of_record.push_back(of_record[i]);
            }
        }
    }
    /// Counts the changes of records and batches.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// stored_number() of its shading model, kLayeredModel for one with layers.
    [[nodiscard]] std::uint32_t model_of(std::uint32_t record) const { return models_[record]; }
    [[nodiscard]] const SurfaceBatch& batch(std::uint32_t index) const { return batches_[index]; }
    [[nodiscard]] std::size_t batch_count() const { return batches_.size(); }
    /// The models that some material uses.
    [[nodiscard]] ShadingModelSet shading_models() const { return shading_models_; }
    /// The layers that some material has.
    [[nodiscard]] MaterialLayers layers() const { return layers_; }
    /// Whether some material has subsurface scattering (subsurface_pass.h).
    [[nodiscard]] bool diffuses() const { return diffuses_; }

    /// Whether some relief is shadowed by rays toward the key lights (ReliefShadow::Ray).
    [[nodiscard]] bool key_shadows() const { return key_shadows_; }

    /// Whether some material needs the curvatures of meshes (SurfaceDetail::Silhouette).
    [[nodiscard]] bool curves() const { return curves_; }

    /// How far a material moves vertices [m], in the scale of the mesh (SurfaceDetail::Displaced).
    [[nodiscard]] float displacement_of(std::uint32_t record) const {
        return displacements_[record];
    }
    /// Whether some material does.
    [[nodiscard]] bool displaces() const { return displaces_; }
    /// Whether some material has a BumpShadow.
    [[nodiscard]] bool bump_shadows() const { return bump_shadows_; }

    void bind_textures(std::uint32_t textures) const;
    [[nodiscard]] const BufferTexture& records() const { return record_texture_; }
    [[nodiscard]] const ImagePool& images() const { return images_; }
    [[nodiscard]] ImagePool& images() { return images_; }

  private:
    void upload_records();
    void add_material(const Material& material);
    /// With detail that the device can draw; reported once if it is another.
    [[nodiscard]] Material supported(Material material);
    /// Assigns texture units to its maps and writes their layers.
    void add_maps(const Material& material, SurfaceBatch& batch, layout::MaterialRecord& record);
    [[nodiscard]] std::uint32_t sampler_of(const TextureSlot& slot, bool trilinear);
    [[nodiscard]] std::uint32_t index_of(const MapBindings& bindings);

    gpu::Device& device_;
    float anisotropy_;
    ImagePool images_;
    std::vector<gpu::Sampler> samplers_;
    std::vector<gpu::SamplerDesc> sampler_descs_;  ///< of samplers_
    std::vector<MapBindings> textures_;
    std::vector<SurfaceBatch> batches_;
    std::vector<std::uint32_t> batch_of_;  ///< by record; 0: default material, 1: missing material
    std::vector<std::uint32_t> plain_of_;  ///< by record of a material
    std::vector<std::uint8_t> models_;     ///< by record
    std::vector<float> displacements_;     ///< by record
    std::vector<layout::MaterialRecord> records_;
    std::vector<Vec4> blocks_;  ///< of all materials, one after the other
    gpu::Buffer record_buffer_;
    BufferTexture record_texture_;
    std::size_t material_count_ = 0;
    std::uint64_t material_version_ = 0;
    DetailLimit limit_ = DetailLimit::Full;
    bool plain_ = false;
    std::uint64_t revision_ = 0;
    ShadingModelSet shading_models_ = 0;
    MaterialLayers layers_ = 0;
    bool diffuses_ = false;
    bool curves_ = false;
    bool key_shadows_ = false;
    bool displaces_ = false;
    bool reported_tessellation_ = false;
    bool bump_shadows_ = false;
};

}  // namespace limn
