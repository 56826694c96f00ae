#pragma once

#include "ecs/components/surface.h"
#include "render/gpu/buffer.h"
#include "render/skinning/posed_bounds.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace limn {

/// A mesh in rest pose, as deform.comp reads it.
struct RestMesh {
    std::uint32_t first_texel = 0;
    std::uint32_t vertex_count = 0;
    std::uint32_t joint_count = 0;  ///< required of its skin; 0: not skinned
    SkinBounds bounds;
    std::string fault;  ///< why it cannot be deformed; empty if it can
};

/// Rest poses of deformable meshes on the GPU: one buffer of texels (deform_gpu.h), appended to
/// when the first instance of a mesh appears.
class RestPool {
  public:
    [[nodiscard]] const RestMesh& get(const Assets& assets, MeshId mesh);
    void clear();

    [[nodiscard]] const gpu::Buffer& texels() const {
        return buffer_;
    }  ///< null until the first mesh

  private:
    RestMesh upload(const MeshData& mesh);

    std::vector<std::optional<RestMesh>> meshes_;  ///< by mesh
    gpu::Buffer buffer_;
    std::size_t used_ = 0;      // texels
    std::size_t capacity_ = 0;  // texels
};

}  // namespace limn
