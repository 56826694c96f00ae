#pragma once

#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "render/frame_data.h"
#include "render/geometry/instance_list.h"
#include "render/gpu/ring_buffer.h"
#include "render/light/light_list.h"
#include "render/shaders/shadow_volume_gpu.h"
#include "render/shadow/light_bounds.h"
#include "render/shadow/shadow_mesh_pool.h"

#include <set>
#include <vector>

namespace limn {

// Which lights use stencil shadow volumes in this frame, and the draws that count them. A light
// with the method volume or hybrid gets a layer of the shadow mask. It gets a shadow map instead,
// logged once, if kMaxVolumeLights others precede it or if a caster in its range cannot have a
// volume: a mesh that is not closed or is deformed, or a material with holes (shadow.selection).
// Only casters within the light's range are considered (shadow.caster-cull); of these, casters
// whose volume is off screen are skipped, but not casters that are themselves off screen.
// Relief casts the volume of its mesh, whose near cap is behind the relief (shadow.relief-stencil).
//
// Closed casters whose volume cannot contain the eye are counted by z-pass, where an infinite
// volume needs no caps; the others by z-fail.

inline constexpr int kMaxVolumeLights = 8;

struct ShadowVolumePass;

/// Draws that share a pipeline state.
struct VolumeRun {
    bool prisms = false;  ///< one volume per triangle
    bool z_fail = false;
    bool mirrored = false;  ///< front faces are clockwise
    std::uint32_t first_command = 0;
    std::uint32_t command_count = 0;
};

struct VolumeLight {
    std::uint32_t record = 0;     ///< index into LightList::records
    bool hybrid = false;          ///< the shadow map is used away from its edges
    Vec4 map = {0, 0, 0, 0};      ///< LightRecord::shadow of that map
    LightBounds bounds;           ///< its range on screen
    gpu::RingSlice block;         ///< layout::VolumeBlock
    std::uint32_t first_run = 0;  ///< index into VolumeList::runs
    std::uint32_t run_count = 0;
};

/// Light i uses layer i of the shadow mask.
struct VolumeList {
    std::vector<VolumeLight> lights;
    std::vector<VolumeRun> runs;
    gpu::RingSlice commands;
    gpu::RingSlice instances;    ///< layout::VolumeInstance
    int casters = 0;             ///< volumes drawn for all lights
    std::int64_t triangles = 0;  ///< submitted
    int unserved = 0;            ///< lights that have maps instead
    ShadowMeshPool* meshes = nullptr;
    const ShadowVolumePass* pass = nullptr;  ///< that draws them; null until it has
};

/// Resolves ShadowMethod::Auto for a light with, or without, a ShadowVolume component
/// (shadow.selection): shadow volumes with it, else shadow maps, which suit every caster.
[[nodiscard]] ShadowMethod choose_shadow_method(ShadowMethod requested, bool has_volume);

/// Whether the shadow of a caster in `box` may contain a point of the sphere; conservative.
[[nodiscard]] bool
shadow_may_contain(const Bounds& box, const Vec4& light, const Vec3& center, float radius);

/// Whether the caster and its shadow lie wholly outside the frustum; conservative.
[[nodiscard]] bool shadow_is_outside(const Bounds& box, const Vec4& light, const Frustum& frustum);

/// Reuses its memory, and remembers what it logged, from frame to frame.
class VolumeCollector {
  public:
    /// Call before the shadow maps. Claims lights with the method volume: sets their
    /// LightRecord::shadow and removes them from LightList::shadowed. Lights it cannot serve, and
    /// the maps of hybrid ones, become lights with maps.
    void collect(
        const RenderItems& items, const RenderView& view, gpu::RingBuffer& ring, LightList& lights,
        VolumeList& list);
    /// Call after the shadow maps: switches hybrid lights to the mask.
    static void assign_hybrid_masks(LightList& lights, VolumeList& list);
    /// Forgets all meshes, for other assets.
    void forget() { meshes_.clear(); }

  private:
    struct Candidate {
        std::size_t shadowed = 0;  ///< index into LightList::shadowed
        ShadowVolume settings;
        Vec4 light;  ///< homogeneous
        LightRange range;
        bool served = true;
    };
    struct Caster {
        std::uint32_t light = 0;
        std::uint32_t state = 0;  ///< prism, z_fail, mirrored: pipeline state bits
        std::uint32_t mesh = 0;
        bool caps = true;
        layout::VolumeInstance instance;
    };

    void find_candidates(const World& world, const LightList& lights);
    void find_casters(const RenderItems& items, const RenderView& view);
    /// Adds an item to the lights that it casts volumes for.
    void add_item(
        const RenderItems& items, const RenderItemBlock& block, std::uint32_t i,
        const RenderView& view, const Frustum& frustum);
    void add_caster(
        Candidate& candidate, const RenderView& view, const Frustum& frustum, const Assets& assets,
        const MeshInstance& surface, const Affine& world_from_mesh, const Bounds& box);
    void refuse(Candidate& candidate, const std::string& why);
    void write_draws(const Assets& assets, gpu::RingBuffer& ring, VolumeList& list);

    ShadowMeshPool meshes_;
    std::vector<Candidate> candidates_;
    std::vector<Caster> casters_;
    std::vector<DrawCommand> commands_;
    std::set<std::string> reported_;
};

/// Number of volume polygons over each pixel, in x: RGBA32F, named "aov.volume_layers". Counts
/// everything that is drawn, hidden or not (shadow.density-view); 0 without volumes.
[[nodiscard]] TextureId draw_volume_layers(FrameGraph& graph, const ViewData& view);

}  // namespace limn
