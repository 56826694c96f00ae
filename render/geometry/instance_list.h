#pragma once

#include "render/geometry/culling.h"
#include "render/geometry/render_items.h"
#include "render/gpu/ring_buffer.h"
#include "render/material/material_pool.h"
#include "render/render_view.h"

#include <vector>

namespace limn {

// From items to draw calls. Every block of items is culled; the draw keys of visible items are
// counted and prefix-summed, and every visible item writes its record to its slot: equal keys are
// contiguous, in world order, whatever thread wrote them. A key is one command of a multi-draw and
// all commands of a batch are one draw: ten thousand equal meshes are one. Only visible instances
// are written. A mesh without tangents is drawn without its normal map. A deformed instance has a
// key of its own, since its vertices are its own.
//
// With RenderItems, 100,000 boxes in view take 4 ms of a core, 1.4 at rest (instance_bench).

/// Layout of glMultiDrawElementsIndirect.
struct DrawCommand {
    std::uint32_t count = 0;
    std::uint32_t instance_count = 0;
    std::uint32_t first_index = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t base_instance = 0;
};

/// Consecutive commands with the same program, state and textures.
struct DrawRun {
    SurfaceFeatures features = {};  ///< without kVelocity
    std::uint32_t textures = 0;     ///< index for MaterialPool::bind_textures
    bool mirrored = false;          ///< front faces are clockwise
    bool wide = false;              ///< 32-bit indices (mesh_pool.h)
    std::uint32_t first_command = 0;
    std::uint32_t command_count = 0;
};

struct InstanceList {
    std::vector<DrawRun> opaque;
    std::vector<DrawRun> blended;  ///< back to front
    gpu::RingSlice commands;
    gpu::RingSlice instances;  ///< layout::InstanceRecord
    gpu::RingSlice previous;   ///< previous transforms (Affine); empty unless requested
    std::span<const DrawCommand>
        command_values;           ///< CPU copy of `commands`, valid until the next collect()
    std::vector<BoxBlock> boxes;  ///< world boxes by instance index; empty unless requested
    std::vector<std::uint32_t>
        without_tangents;  ///< meshes whose normal map is dropped for lack of tangents
    int total = 0;
    int visible = 0;
    int tested = 0;            ///< boxes against the frustum, of items and around blocks of them
    int opaque_instances = 0;  ///< these come first in `instances`
    std::int64_t triangles = 0;
};

/// The region from which a light's shadow casters are collected. Casters drawn with coarse
/// triangles are moved away from the light by the geometric error of their level, so that they do
/// not shadow the mesh itself; their projection onto the light's view does not change.
struct CasterVolume {
    Frustum frustum;
    Frustum shading = kEverywhere;  ///< the shadows of casters outside fall on nothing visible
    Vec3 eye = {0, 0, 0};
    float range = INFINITY;  ///< from the eye [m]
    Vec3 away = {0, 0, 0};   ///< unit, along parallel light; 0: light comes from the eye
    // Texel density of the map, for the choice of coarse triangles (CoarseTriangles): at `p`,
    // texels_per_unit / dot(depth_row, p) texels per meter.
    float texels_per_unit = 0;
    Vec4 depth_row = {0, 0, 0, 1};
    float detail = 0;  ///< Shadow::detail [texels]; 0: meshes as they are
};

/// Reuses its memory from frame to frame.
class InstanceCollector {
  public:
    /// Culls, sorts and writes into `ring`. `velocity` also fills `previous`, `boxes` the boxes.
    void collect(
        const RenderItems& items, const RenderView& view, bool velocity, gpu::RingBuffer& ring,
        InstanceList& list, bool boxes = false);
    /// The same for shadow casters within `volume`: no blended surfaces, no NoShadow.
    void collect_casters(
        const RenderItems& items, const CasterVolume& volume, gpu::RingBuffer& ring,
        InstanceList& list);

  private:
    /// Which items to collect.
    struct Selection {
        Frustum frustum;
        Frustum shading = kEverywhere;  ///< for casters
        Vec3 eye = {0, 0, 0};
        Vec3 forward = {0, 0, 0};
        float range = INFINITY;
        float previous_alpha = 0;
        // At `p`, pixels_per_unit / dot(depth_row, p) pixels or texels per meter.
        Vec4 depth_row = {0, 0, 0, 1};
        float pixels_per_unit = 0;
        bool velocity = false;
        const CasterVolume* casters = nullptr;  ///< null: not for shadow casters
        Entity hidden = {};
        bool boxes = false;
    };
    /// A key that occurs in a block, and how often; later, the slot of its next instance.
    struct KeyCount {
        DrawKey key = 0;
        std::uint32_t count = 0;
        std::uint32_t slot = 0;
        float distance = INFINITY;  ///< to the far side of the nearest box [m]
    };
    struct BlockWork {
        std::vector<KeyCount> keys;
        int tested = 0;                   ///< boxes
        std::uint16_t local[kCullBlock];  ///< index into keys; kHidden if not drawn
    };
    struct Entry {
        DrawKey key;
        std::uint32_t block;
        std::uint32_t local;
    };
    /// All instances of one key.
    struct Group {
        DrawKey key = 0;
        std::size_t first_entry = 0;
        std::size_t end_entry = 0;
        float distance = INFINITY;      ///< of the nearest [m]
        float run_distance = INFINITY;  ///< of the nearest instance in its run [m]
    };
    struct Blended {
        float distance;
        std::uint32_t instance;
        DrawKey key;
    };
    class KeyTable;

    void collect_from(
        const RenderItems& items, const Selection& selection, gpu::RingBuffer& ring,
        InstanceList& list);
    /// Culls a block and counts the keys of its visible items.
    void count_block(
        const RenderItems& items, const RenderItemBlock& block, const Selection& selection,
        BlockWork& work) const;
    /// The coarsest level of an item that is fine enough for `volume`: DrawState::level.
    static std::uint32_t level_of(
        const RenderItems& items, const RenderItemBlock& block, std::uint32_t i,
        const CasterVolume& volume);
    /// The key of an item with the material that it has at its size in the image.
    static DrawKey sized_key(
        const RenderItems& items, const RenderItemBlock& block, std::uint32_t i,
        const Selection& selection);
    /// Moves a caster away from the light by the geometric error of its level.
    static void push_back_caster(
        const RenderItems& items, const RenderItemBlock& block, std::uint32_t i, DrawKey key,
        const CasterVolume& volume, Affine& world);
    void write_block(
        const RenderItems& items, const RenderItemBlock& block, const Selection& selection,
        BlockWork& work, InstanceList& list);
    void group_keys();
    void assign_slots(const RenderItems& items, bool velocity, InstanceList& list);
    void order_blended(const RenderItems& items, bool velocity, InstanceList& list);
    void add_command(
        DrawKey key, std::uint32_t first, std::uint32_t count, const RenderItems& items,
        bool velocity, InstanceList& list);

    std::vector<BlockWork> blocks_;
    std::vector<Entry> entries_;
    std::vector<Group> groups_;
    std::vector<DrawCommand> commands_;
    std::vector<Blended> blended_;
    std::uint32_t opaque_count_ = 0;
    std::uint32_t visible_count_ = 0;
};

}  // namespace limn
