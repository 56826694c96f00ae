#pragma once

#include "render/instance_list.h"
#include "render/light_list.h"
#include "render/shadow/shadow_casters.h"
#include "render/shadow/shadow_view.h"

#include <map>
#include <vector>

namespace limn {

// All shadow maps of a frame: which views there are, where each lies in the one atlas, and which of
// them must be drawn again. A view keeps its place and its depths as long as neither its light nor
// a caster in it changes; a light that is gone gives its places back.
//
//     collector.collect(world, view, meshes, materials, shapes, assets, ring, scene.lights,
//         scene.shadows);

/// A view to be drawn in this frame.
struct ShadowDraw {
    AtlasRect place;
    bool clamp_depth = false;
    gpu::RingSlice view_block;  ///< layout::ViewBlock
    InstanceList casters;
};

/// A view that belongs to no light: of what lies below the surface of a water, as light comes down
/// that flat water bends, or above it, as light goes up that it mirrors.
struct WaterShadow {
    Entity water;
    std::uint64_t part = 0;  ///< tells apart those of the same water, 0 .. 7
    ShadowView view;
    int record = -1;  ///< index into ShadowList::records; -1: the atlas is full
};

struct ShadowList {
    std::vector<WaterShadow> waters;  ///< asked for before collect(), which sets their records
    std::vector<layout::ShadowViewRecord> records;
    std::vector<ShadowDraw> due;
    bool cubes = false;     ///< some light has six faces
    bool cascades = false;  ///< some light has cascades
    bool soft = false;      ///< some filter that lights is wider than 2x2
    int atlas_size = 0;     ///< side [texels]; 0: no shadow maps
    int unserved = 0;       ///< lights that found no room in the atlas: they cast no shadow
};

/// A Shadow whose numbers can be used, whatever was asked for: resolution a power of two.
[[nodiscard]] Shadow make_sane(const Shadow& shadow);

/// Keeps its memory, and what it knows of the maps, from frame to frame.
class ShadowCollector {
  public:
    /// Sets LightRecord::shadow and LightList::shadows of the lights that are served.
    void collect(
        const World& world, const RenderView& view, const MeshPool& meshes,
        const MaterialPool& materials, DeformedList& shapes, std::uint64_t assets,
        gpu::RingBuffer& ring, LightList& lights, ShadowList& list);

  private:
    /// A view that has a place, by light and number.
    struct Kept {
        AtlasRect place;
        Mat4 clip_from_world{0.0f};  ///< as it was drawn
        std::uint64_t signature = 0;
        bool drawn = false;
        bool used = false;  ///< in this frame
    };
    using KeptKey = std::pair<std::uint64_t, int>;
    /// The views of a light in this frame, at first_view of views_.
    struct LightViews {
        const ShadowedLight* light = nullptr;  ///< or
        WaterShadow* water = nullptr;
        std::uint64_t key = 0;
        Shadow settings;  ///< sane
        float kind = 0;   ///< layout::kShadow*
        std::size_t first_view = 0;
        std::size_t count = 0;
        Vec4 splits = Vec4(INFINITY);
        bool placed = false;
    };

    void want_views(const RenderView& view, const LightList& lights, ShadowList& list);
    void want_cascades(const RenderView& view, LightViews& wanted);
    [[nodiscard]] bool want_perspective(const RenderView& view, LightViews& wanted);
    void place_views();
    [[nodiscard]] bool place_light(LightViews& wanted);
    void release_light(const LightViews& wanted);
    [[nodiscard]] Kept& kept(const LightViews& wanted, std::size_t number);
    void write_records(LightList& lights, ShadowList& list);

    InstanceCollector collector_;
    ShadowAtlas atlas_{1};
    std::map<KeptKey, Kept> kept_;
    std::vector<ShadowView> views_;
    std::vector<LightViews> wanted_;
    std::vector<CasterVolume> volumes_;
    std::vector<std::uint64_t> signatures_;
    bool reported_ = false;
};

}  // namespace limn
