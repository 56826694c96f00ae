#pragma once

#include "ecs/base/hash.h"
#include "ecs/components/surface.h"
#include "render/gpu/buffer_texture.h"
#include "render/shaders/fur_gpu.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace limn {

struct Fur;
namespace gpu {
class Device;
}

// Fur as shells (Lengyel et al., "Real-Time Fur over Arbitrary Surfaces", 2001): the mesh is drawn
// again and again, inflated by
//
//     length i / k,    i = 1 .. k - 1
//
// with holes between the cross-sections of strands (lib/fur.glsl). Shells are opaque, so every
// lighting method, shadow maps and motion blur take them as surfaces: they are items of
// RenderItems. Shadow volumes and programs that light vertices leave them out.
//
// Roots lie in cells of the second texture coordinates or, without any, of the first, scaled by
// their mean stretch; content/make/models/fur_coordinates.h makes some that are in meters
// everywhere.

/// A shell as an item.
struct FurShell {
    std::uint8_t fur = 0;    ///< number in the FurList
    std::uint8_t index = 0;  ///< i; 0: fins
    float spacing = 0;       ///< of shells, length / k [m]
    float lean = 0;          ///< upper bound, in offsets
};

/// Offset of shell `i` along normals [m].
[[nodiscard]] float shell_offset(const Fur& fur, std::int32_t i);

/// How far tips can lie from their roots along the surface, in lengths.
[[nodiscard]] float fur_lean(const Fur& fur);

/// Texture coordinates of a mesh for fur.
struct FurChart {
    Vec2 scale = {1, 1};  ///< mean length on the surface of a unit of u and of v [m]
    bool second = false;  ///< the second set
};
[[nodiscard]] FurChart find_fur_chart(const MeshData& mesh);

/// The different coats of a frame.
class FurList {
  public:
    void clear() { records_.clear(); }
    /// The number of a coat; none if kMaxFurs are taken by others, which is logged once.
    std::optional<std::uint8_t> add(const Fur& fur, MeshId mesh, const Assets& assets);
    [[nodiscard]] std::span<const layout::FurRecord> records() const { return records_; }
    [[nodiscard]] std::uint64_t hash(std::uint8_t number) const {
        return hash_bytes(&records_[number], sizeof(layout::FurRecord), 0);
    }

    void upload(gpu::RingBuffer& ring);
    void bind(gpu::Device& device) const;

  private:
    const FurChart& chart_of(MeshId mesh, const Assets& assets);

    struct KnownChart {
        std::uint32_t version;
        FurChart chart;
    };
    std::vector<layout::FurRecord> records_;
    std::unordered_map<std::uint32_t, KnownChart> charts_;  ///< by mesh
    std::uint64_t assets_ = 0;                              ///< whose charts they are
    std::unique_ptr<BufferTexture> texture_;                ///< null: no fur yet
    bool reported_ = false;
};

}  // namespace limn
