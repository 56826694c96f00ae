#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/surface_anchors.h"
#include "render/geometry/slot_allocator.h"
#include "render/gpu/buffer.h"
#include "render/skinning/posed_bounds.h"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace limn {

/// A mesh in rest pose, in the layout of deform.comp.
struct RestMesh {
    std::uint32_t first_texel = 0;
    std::uint32_t texel_count = 0;  ///< 0: not uploaded
    std::uint32_t vertex_count = 0;
    std::uint32_t joint_count = 0;  ///< required of its skin; 0: not skinned
    SkinBounds bounds;
    std::uint32_t version = 0;  ///< of the MeshData
    bool has_anchors = false;   ///< on the patches of a surface
    std::string fault;          ///< why it cannot be deformed; empty if it can
};

/// Rest poses of deformable meshes on the GPU: one buffer of texels (deform_gpu.h). A mesh is
/// uploaded when its first instance appears, and again after it was edited.
class RestPool {
  public:
    /// `anchors`: of its vertices on patches, one per vertex, or empty.
    [[nodiscard]] const RestMesh&
    get(const Assets& assets, MeshId mesh, std::span<const SurfaceAnchor> anchors = {});
    /// The same with each vertex in the spaces of its joints (kDeformOffsets), and the boxes of
    /// `bounds` likewise, so that the joints' own matrices move both. The skin must have all
    /// joints of the mesh. Valid until clear().
    [[nodiscard]] const RestMesh& get_joint_offsets(const Assets& assets, MeshId mesh, SkinId skin);
    void clear();

    [[nodiscard]] const gpu::Buffer& texels() const {
        return buffer_;
    }  ///< null until the first mesh

  private:
    /// `skin`: null, or of joint offsets.
    RestMesh
    upload(const MeshData& mesh, std::span<const SurfaceAnchor> anchors, const SkinData* skin);
    void release(const RestMesh& mesh);

    std::vector<std::optional<RestMesh>> meshes_;                                ///< by mesh
    std::map<std::pair<std::uint32_t, std::uint32_t>, RestMesh> joint_offsets_;  ///< by mesh, skin
    gpu::Buffer buffer_;
    SlotAllocator slots_;  // texels
};

}  // namespace limn
