#pragma once

#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "render/gpu/ring_buffer.h"
#include "render/instance_list.h"
#include "render/light_list.h"
#include "render/shaders/shadow_volume_gpu.h"
#include "render/shadow/light_bounds.h"
#include "render/shadow/shadow_mesh_pool.h"

#include <set>
#include <vector>

namespace limn {

// Which lights have stencil volumes in this frame, and the draws that count them. A light with the
// method volume or hybrid gets a layer of the screen's mask; it gets a map instead, and the log
// says so once, if kMaxVolumeLights others come before it or if a caster in its reach cannot have a
// volume: a mesh that is not closed or changes its shape, or a material with holes
// (shadow.selection). What only needs
// to be asked of casters near the light is asked of those (shadow.caster-cull); of these, casters
// whose volume lies beside the picture are left out, those outside of the picture are not.
//
// Closed casters whose volume cannot hold the eye count by z-pass, from the eye, where an endless
// volume needs no caps; the others by z-fail, from behind.

inline constexpr int kMaxVolumeLights = 8;

/// Draws in one state.
struct VolumeRun {
    bool prisms = false;  ///< a volume a triangle
    bool z_fail = false;
    bool mirrored = false;  ///< front faces turn clockwise
    std::uint32_t first_command = 0;
    std::uint32_t command_count = 0;
};

struct VolumeLight {
    std::uint32_t record = 0;     ///< index into LightList::records
    bool hybrid = false;          ///< a map decides away from its edges
    Vec4 map = {0, 0, 0, 0};      ///< LightRecord::shadow of that map
    LightBounds bounds;           ///< what it reaches in the picture
    gpu::RingSlice block;         ///< layout::VolumeBlock
    std::uint32_t first_run = 0;  ///< of VolumeList::runs
    std::uint32_t run_count = 0;
};

/// Light i has layer i of the mask.
struct VolumeList {
    std::vector<VolumeLight> lights;
    std::vector<VolumeRun> runs;
    gpu::RingSlice commands;
    gpu::RingSlice instances;    ///< layout::VolumeInstance
    int casters = 0;             ///< volumes drawn, of all lights
    std::int64_t triangles = 0;  ///< submitted
    int unserved = 0;            ///< lights that have maps instead
    ShadowMeshPool* meshes = nullptr;
};

/// What ShadowMethod::Auto means for a light with, or without, a ShadowVolume beside it
/// (shadow.selection): who says what its volumes are like wants volumes, all others the maps that
/// every caster suits.
[[nodiscard]] ShadowMethod choose_shadow_method(ShadowMethod wanted, bool has_volume);

/// Whether what a caster in `box` shades can hold a point of the ball. Never false if it does.
[[nodiscard]] bool
shade_may_hold(const Bounds& box, const Vec4& light, const Vec3& middle, float radius);

/// Whether the caster and all that it shades lie outside of the picture. Never true if not.
[[nodiscard]] bool shade_is_outside(const Bounds& box, const Vec4& light, const Frustum& frustum);

/// Keeps its memory, and what it reported, from frame to frame.
class VolumeCollector {
  public:
    /// Before the maps: takes over lights with the method volume, sets their LightRecord::shadow
    /// and removes them from LightList::shadowed; makes those it cannot serve, and the maps of
    /// hybrid ones, lights with maps.
    void collect(
        const World& world, const RenderView& view, const DeformedList& shapes,
        gpu::RingBuffer& ring, LightList& lights, VolumeList& list);
    /// After the maps: hybrid lights read the mask, too.
    static void take_over_hybrids(LightList& lights, VolumeList& list);
    /// Other assets: meshes are examined anew.
    void forget() { meshes_.clear(); }

  private:
    struct Candidate {
        std::size_t shadowed = 0;  ///< index into LightList::shadowed
        ShadowVolume settings;
        Vec4 light;  ///< homogeneous
        LightReach reach;
        bool served = true;
    };
    struct Caster {
        std::uint32_t light = 0;
        std::uint32_t state = 0;  ///< prism, z_fail, mirrored: what is drawn together
        std::uint32_t mesh = 0;
        bool caps = true;
        layout::VolumeInstance instance;
    };

    void find_candidates(const World& world, const LightList& lights);
    void find_casters(const World& world, const RenderView& view, const DeformedList& shapes);
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

}  // namespace limn
