#pragma once

#include "render/frame_data.h"
#include "render/geometry/instance_list.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/light_list.h"
#include "render/shadow/shadow_casters.h"
#include "render/shadow/shadow_view.h"

#include <map>
#include <span>
#include <tuple>
#include <vector>

namespace limn {

// All shadow maps of a frame: their views, their rectangles in the shared atlas, and which of them
// must be redrawn. A view keeps its rectangle and its cached depths as long as neither its light
// nor a caster in it changes; a removed light releases its rectangles.
//
//     collector.collect(frame, view, water_requests, lights, shadows);

/// A view to be redrawn in this frame.
struct ShadowDraw {
    AtlasRect rect;
    bool clamp_depth = false;
    gpu::RingSlice view_block;  ///< layout::ViewBlock
    InstanceList casters;
};

/// A view that belongs to a water instead of a light: below its surface along sunlight refracted by
/// flat water, or above it along reflected sunlight.
struct WaterShadow {
    Entity water;
    std::uint64_t part = 0;  ///< key among the views of the same water, 0 .. 7
    ShadowView view;
    int record = -1;  ///< index into ShadowList::records; -1: the atlas is full
};

/// Requests of the waters of a view, published before its shadows are collected.
struct WaterShadows {
    std::vector<WaterShadow> requests;
};

/// The kinds of shadows that shaders must support: the definitions of lib/shadow.glsl.
struct ShadowKinds {
    bool maps = false;      ///< some light, or water, has a map
    bool masks = false;     ///< some light has shadow volumes
    bool cubes = false;     ///< some light has six faces
    bool cascades = false;  ///< some light has cascades
    bool soft = false;      ///< some map used for lighting has a filter wider than 2x2
    bool contact = false;   ///< and some of these have the contact-hardening one
};

struct ShadowList {
    std::vector<WaterShadow> waters;  ///< as requested, with their records
    std::vector<layout::ShadowViewRecord> records;
    std::vector<ShadowDraw> due;
    ShadowKinds kinds;   ///< of the maps of this view; ShadowEffect adds those of the whole level
    int atlas_size = 0;  ///< side [texels]; 0: no shadow maps
    int unserved = 0;    ///< lights that do not fit into the atlas: they cast no shadow
};

/// The shadow maps of a view, published when they are declared in the frame graph.
struct ShadowMaps {
    const ShadowList* list = nullptr;
    const BufferTexture* records = nullptr;  ///< layout::ShadowViewRecord
    TextureId atlas;
};

/// Clamps all settings to valid ranges; rounds the resolution up to a power of two.
[[nodiscard]] Shadow sanitize(const Shadow& shadow);

/// Reuses its memory, and caches the maps, from frame to frame.
class ShadowCollector {
  public:
    /// Call once a frame, before its views. Maps that a frame does not use stay until their space
    /// is needed.
    void begin_frame();
    /// Sets LightRecord::shadow and LightList::shadows for the lights that got maps. Views of
    /// different kinds have cascades of their own; successive views of one kind reuse the same.
    void collect(
        const FrameData& frame, const ViewData& view, std::span<const WaterShadow> waters,
        LightList& lights, ShadowList& list);

  private:
    /// A cached map, keyed by light, by the kind of the view if it depends on that, and by number.
    struct CachedMap {
        AtlasRect rect;
        Mat4 clip_from_world{0.0f};  ///< as last drawn
        std::uint64_t signature = 0;
        bool drawn = false;
        bool used = false;  ///< in this frame
    };
    using CachedMapKey = std::tuple<std::uint64_t, std::uint32_t, int>;
    /// The views of a light in this frame, at first_view of views_.
    struct LightViews {
        const ShadowedLight* light = nullptr;  ///< either this or `water`
        WaterShadow* water = nullptr;
        std::uint64_t key = 0;
        std::uint32_t view_kind = 0;  ///< 0: the same maps for all views
        Shadow settings;              ///< clamped
        float kind = 0;               ///< layout::kShadow*
        std::size_t first_view = 0;
        std::size_t count = 0;
        Vec4 splits = Vec4(INFINITY);
        bool allocated = false;
    };

    void request_views(
        const RenderView& camera, ViewKind kind, const LightList& lights, ShadowList& list);
    void request_cascades(const RenderView& view, LightViews& request);
    [[nodiscard]] bool request_perspective(const RenderView& view, LightViews& request);
    [[nodiscard]] CachedMapKey key_of_map(const LightViews& request, std::size_t number) const;
    void allocate_views();
    /// Frees the maps that this frame has not used; false if there are none.
    bool evict_unused();
    [[nodiscard]] bool allocate_light(LightViews& request);
    void release_light(const LightViews& request);
    [[nodiscard]] CachedMap& cached_map(const LightViews& request, std::size_t number);
    void write_records(LightList& lights, ShadowList& list);

    InstanceCollector collector_;
    ShadowAtlas atlas_{1};
    std::map<CachedMapKey, CachedMap> maps_;
    std::vector<ShadowView> views_;
    std::vector<LightViews> requests_;
    std::vector<CasterVolume> volumes_;
    std::vector<std::uint64_t> signatures_;
    bool reported_ = false;
};

}  // namespace limn
