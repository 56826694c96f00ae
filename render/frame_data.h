#pragma once

#include "ecs/base/check.h"
#include "ecs/base/math.h"
#include "render/geometry/gbuffer.h"
#include "render/gpu/ring_buffer.h"
#include "render/graph/frame_graph.h"
#include "render/render_view.h"
#include "render/shaders/view_gpu.h"
#include "render/typed_store.h"
#include "render/variant.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

namespace gpu {
class Device;
class Texture;
}  // namespace gpu
struct Assets;
class DeformedList;
class MaterialPool;
class MeshPool;
class RenderItems;
class World;

// The data of a frame, by lifetime:
//
//     FrameData   once a frame, whatever the number of views: uploaded assets, lights, bodies of
//                 water, deformed shapes
//     ViewData    once a view: visible instances, clusters, shadow views, uniform blocks; and the
//                 graph textures that the view is drawn into
//
// Both have a store that effects publish plain structs in and read others' from, by type: an effect
// may include another's header only for such a struct, and never writes what another published.

/// What a view is for; effects choose the kinds that they take part in (EffectEntry::views).
enum ViewKind : std::uint32_t {
    kCameraView = 1u << 0,  ///< the image that is asked for
    kSampleView = 1u << 1,  ///< one sample of an accumulated image
    kMeanView = 1u << 2,    ///< accumulated radiance that is prepared for display: nothing is drawn
    kProbeView = 1u << 3,   ///< a face of an environment probe, drawn without probes
    kMirrorView = 1u << 4,  ///< the reflection in a planar water surface, drawn without water

    kMainViews = kCameraView | kSampleView,               ///< through the requested camera
    kSceneViews = kMainViews | kProbeView | kMirrorView,  ///< all that draw the scene
    kFilmViews = kCameraView | kMeanView,                 ///< those that become a displayed image
};

/// How the image of a view is used.
enum class SampleKind : std::uint8_t {
    Played,   ///< a complete frame, with motion blur and depth of field
    Instant,  ///< one instant through one point of the lens: averaging samples blurs
};

/// An additional view that this frame needs before the main one.
struct ExtraView {
    ViewKind kind = kProbeView;
    RenderView camera;
    std::string_view name = {};  ///< scope of its passes in timings
    int index = 0;               ///< by which the effect that requested it identifies its views
};

struct FrameData {
    const World* world = nullptr;
    const Assets* assets = nullptr;
    std::uint64_t assets_identity = 0;
    bool assets_replaced = false;  ///< other assets than in the last frame: caches are invalid
    gpu::Device* device = nullptr;
    gpu::RingBuffer* ring = nullptr;  ///< uploads of this frame
    MeshPool* meshes = nullptr;
    MaterialPool* materials = nullptr;
    DeformedList* shapes = nullptr;
    RenderItems* items = nullptr;  ///< what is drawn; read after every collect()
    GLenum radiance_format = GL_RGBA16F;
    GLenum velocity_format = GL_RG16F;

    ViewKind kind = kCameraView;  ///< of the main view
    SampleKind sample = SampleKind::Played;
    RenderView camera;                ///< of the main view; collect() may jitter it
    std::uint64_t number = 0;         ///< counts the frames of the renderer
    double time = 0;                  ///< simulated time shown [s]
    std::optional<float> since_last;  ///< simulated time since the previous frame [s]; none: a cut
    std::span<const std::string> aovs;  ///< requested
    bool velocity = false;              ///< the main view needs motion vectors; set in collect()
    bool attributes = false;            ///< the main view needs its G-buffer; set in collect()
    bool material_ids = false;          ///< and the material of each pixel; set in collect()
    bool warm_up = false;               ///< drawn to compile programs, not for display (warm_up())
    bool paced = false;                 ///< as FrameRequest::paced
    bool all_lights = false;            ///< of a warm-up: every light counts as on
    std::vector<ExtraView> views;       ///< filled in request_views()

    TypedStore data;
};

/// Inputs of lighting shaders besides the surface itself. Effects that light, shadow or occlude
/// contribute definitions and bindings in prepare(), and the resources that passes must declare in
/// draw().
struct LightingInputs {
    struct Binding {
        void (*bind)(PassContext&, const void*);
        const void* data;
    };
    Variant variant;
    std::vector<Use> reads;
    std::vector<Binding> bindings;

    /// `bind(context, data)` is called whenever a lit pass begins; `data` must live until then.
    template <auto bind, typename T>
    void add_binding(const T& data) {
        bindings.push_back(
            {[](PassContext& context, const void* published) {
                 bind(context, *static_cast<const T*>(published));
             },
             &data});
    }
    void clear() {
        variant = {};
        reads.clear();
        bindings.clear();
    }
};

struct ViewData {
    const FrameData* frame = nullptr;
    ViewKind kind = kCameraView;
    RenderView camera;
    int index = 0;          ///< ExtraView::index
    bool velocity = false;  ///< motion vectors are drawn
    bool attributes = false;
    bool material_ids = false;
    bool spreads = false;  ///< subsurface light is drawn to `scattered`; set in prepare()
    gpu::RingSlice block;  ///< layout::ViewBlock
    /// Blocks of effects, indexed by binding - kEffectBlocks.
    std::array<gpu::RingSlice, layout::kMaxEffectBlocks> effect_blocks;
    LightingInputs lighting;

    Gbuffer gbuffer;
    TextureId radiance;   ///< the image so far; effects replace it
    TextureId scattered;  ///< subsurface light without albedo, alpha 1 on such surfaces,
                          ///< with mip levels; valid() after lighting if `spreads`
    TextureId display;    ///< RGBA8, at the end of kFilmViews

    TypedStore data;

    [[nodiscard]] bool is(std::uint32_t kinds) const { return (kind & kinds) != 0; }
    /// Uploads a uniform block for all programs of this view; in prepare(). `binding` is the one in
    /// its shaders, at least kEffectBlocks.
    template <typename Block>
    void publish_block(unsigned binding, const Block& values) {
        static_assert(sizeof(Block) <= layout::kEffectBlockBytes);
        LIMN_CHECK(binding - layout::kEffectBlocks < layout::kMaxEffectBlocks);
        effect_blocks[binding - layout::kEffectBlocks] = frame->ring->push_value(values);
    }
    /// Size of what is drawn [px].
    [[nodiscard]] IVec2 size() const { return {camera.width, camera.height}; }
};

}  // namespace limn
