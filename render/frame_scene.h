#pragma once

#include "ecs/components/environment.h"
#include "ecs/components/rendering.h"
#include "render/buffer_texture.h"
#include "render/gpu/program.h"
#include "render/gpu/shader_source.h"
#include "render/graph/frame_graph.h"
#include "render/instance_list.h"
#include "render/light_clusters.h"
#include "render/light_objects.h"
#include "render/mesh_pool.h"
#include "render/projector_list.h"
#include "render/shaders/environment_gpu.h"
#include "render/shaders/view_gpu.h"
#include "render/shadow/shadow_list.h"
#include "render/shadow/volume_list.h"

#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace limn {

namespace gpu {
class Buffer;
class Device;
class Texture;
}  // namespace gpu

// What every pass of a frame finds prepared: the world as the GPU sees it. The bindings are the
// same in all shaders; bind_view() and bind_lighting() make them.

/// Uniform blocks.
inline constexpr unsigned kViewBinding = 0;
inline constexpr unsigned kEnvironmentBinding = 1;
inline constexpr unsigned kSurroundingsBinding = 5;
inline constexpr unsigned kProbesBinding = 6;
/// Texture units; 0 .. 4 are the material's own.
inline constexpr unsigned kGbufferUnit = 5;
inline constexpr unsigned kDepthUnit = 6;
inline constexpr unsigned kReflectionUnit = 7;
inline constexpr unsigned kSpecularAlbedoUnit = 8;
inline constexpr unsigned kLightsUnit = 9;
inline constexpr unsigned kLightIndicesUnit = 10;
inline constexpr unsigned kLightCellsUnit = 11;
inline constexpr unsigned kMaterialsUnit = 12;
inline constexpr unsigned kSurfaceMaterialsUnit = 13;
inline constexpr unsigned kVelocityUnit = 14;
inline constexpr unsigned kShadowAtlasUnit = 15;
inline constexpr unsigned kShadowViewsUnit = 16;
inline constexpr unsigned kShadowMasksUnit = 17;
inline constexpr unsigned kProjectorImagesUnit = 18;
inline constexpr unsigned kProjectorsUnit = 19;
inline constexpr unsigned kWaterLightsUnit = 20;
inline constexpr unsigned kCausticMapsUnit = 21;

/// The surroundings of this frame, and what was made of them.
struct SceneEnvironment {
    Environment settings;
    layout::EnvironmentBlock block{};
    const gpu::Texture* reflection = nullptr;  ///< lib/reflection_map.glsl
    const gpu::Buffer* irradiance = nullptr;   ///< layout::Irradiance of each layer
    const gpu::Texture* cube = nullptr;        ///< of a Panorama
    const gpu::Texture* specular_albedo = nullptr;
};

/// The lists of the light clusters; not valid() where no light is placed.
struct ClusterLists {
    BufferId cells;    ///< begin and length of each cell's list
    BufferId indices;  ///< the lists, one after the other, of indices into the light records
};

struct FrameScene {
    MeshPool* meshes = nullptr;
    const MaterialPool* materials = nullptr;
    DeformedList* shapes = nullptr;
    InstanceList instances;
    LightList lights;
    ClusterLights clusters;
    ClusterLists lists;
    LightMethod method = LightMethod::Clustered;
    bool per_vertex = false;  ///< with LightMethod::ObjectMajor: lit at vertices
    LightDraws light_draws;   ///< of LightMethod::LightMajor
    ShadowList shadows;
    VolumeList volumes;
    SceneEnvironment environment;
    RenderView view;
    std::optional<float> since_last;  ///< simulated time since the picture before [s]; none: a cut
    GLenum radiance_format = GL_RGBA16F;
    GLenum velocity_format = GL_RG16F;
    gpu::RingSlice view_block;
    gpu::RingSlice environment_block;
    gpu::RingSlice probe_block;  ///< of no size: no probes
    bool for_light = false;  ///< a probe looks or a water: at what lights or is mirrored, without
                             ///< the sun, which does so by itself
    const BufferTexture* light_records = nullptr;
    const BufferTexture* light_indices = nullptr;
    const BufferTexture* light_cells = nullptr;
    const BufferTexture* object_lists = nullptr;   ///< of LightMethod::ObjectMajor: one an instance
    const BufferTexture* object_lights = nullptr;  ///< the lights in those lists
    gpu::RingSlice light_commands;                 ///< those of light_draws
    const BufferTexture* shadow_views = nullptr;
    const BufferTexture* projector_records = nullptr;
    const ProjectorPool* projectors = nullptr;
    const gpu::Texture* shadow_atlas = nullptr;
    bool waters = false;   ///< there is water in which something may lie
    bool mirrors = false;  ///< some of it throws light up
    const BufferTexture* water_lights = nullptr;
    const gpu::Texture* caustic_maps = nullptr;
    TextureId caustics;  ///< those maps as this frame's graph knows them; not valid() without any
    TextureId
        shadow_maps;  ///< the atlas as this frame's graph knows it; not valid() without shadows
    TextureId shadow_masks;  ///< a layer for each of volumes.lights; not valid() without any
};

/// What lib/view.glsl knows of a frame.
[[nodiscard]] layout::ViewBlock
make_view_block(const RenderView& view, const ClusterShape& shape, const LightList& lights);

/// The view's uniform block and, of lit passes, all that lib/lighting.glsl reads.
void bind_view(gpu::Device& device, const FrameScene& scene);
void bind_lighting(gpu::Device& device, const FrameScene& scene);

/// The answers of shadow volumes, where there are any: they are about the opaque surfaces alone.
void bind_shadow_masks(PassContext& context, const FrameScene& scene);

/// Whether the depth of surfaces needs a stencil beside it: for volumes of shadow or of light, or
/// to light each pixel once.
[[nodiscard]] bool needs_stencil(const FrameScene& scene);

/// Whether a plane cuts away part of what is drawn: then surfaces are drawn with the definition
/// CLIPPED and PipelineState::clip.
[[nodiscard]] bool is_clipped(const FrameScene& scene);

/// `reads` and what a pass that lights reads beside them.
[[nodiscard]] std::vector<Use>
lighting_reads(const FrameScene& scene, std::initializer_list<Use> reads);

/// The definitions that lib/lighting.glsl and lib/reflector.glsl want for this scene.
[[nodiscard]] std::vector<gpu::ShaderDefine> lighting_defines(const FrameScene& scene);
/// A number that tells those apart.
[[nodiscard]] std::uint32_t lighting_key(const FrameScene& scene);

/// Programs of one pair of shaders by SurfaceFeature bits; made when first needed. A variant that
/// does not compile is logged once and not drawn.
class SurfacePrograms {
  public:
    SurfacePrograms(gpu::Device& device, std::string vertex, std::string fragment)
        : device_(&device), vertex_(std::move(vertex)), fragment_(std::move(fragment)) {}

    /// `more` is told apart by `more_key`. Null if it does not compile.
    [[nodiscard]] const gpu::Program*
    get(std::uint32_t features, std::uint32_t more_key, const std::vector<gpu::ShaderDefine>& more);
    /// Compiles one now, to know that it can be done.
    [[nodiscard]] Status load(
        std::uint32_t features, std::uint32_t more_key, const std::vector<gpu::ShaderDefine>& more);

  private:
    gpu::Device* device_;
    std::string vertex_;
    std::string fragment_;
    std::unordered_map<std::uint64_t, const gpu::Program*> programs_;
};

/// Draws the runs; `state` gets the winding and sides of each. Programs that light with one light
/// get its index.
void draw_runs(
    gpu::Device& device, const FrameScene& scene, const std::vector<DrawRun>& runs,
    SurfacePrograms& programs, std::uint32_t more_features, std::uint32_t more_key,
    const std::vector<gpu::ShaderDefine>& more, const gpu::PipelineState& state, int light = -1);

/// Draws the objects of lights: `runs` of `scene.light_draws`.
void draw_light_runs(
    gpu::Device& device, const FrameScene& scene, std::span<const LightRun> runs,
    SurfacePrograms& programs, std::uint32_t more_key, const std::vector<gpu::ShaderDefine>& more,
    const gpu::PipelineState& state);

/// Draws the opaque instances for their depth alone, as draw_casters() does, seen sides only.
void draw_depths(gpu::Device& device, const FrameScene& scene, SurfacePrograms& programs);

/// Draws casters for their depth alone, both sides: `programs` get no more features than decide
/// where a surface has holes.
void draw_casters(
    gpu::Device& device, const FrameScene& scene, const InstanceList& casters,
    SurfacePrograms& programs, const gpu::PipelineState& state);

/// Draws the opaque instances for where they are and were, without their materials, seen sides
/// only; needs the velocity of instances. `set` gives each program what it wants.
void draw_motions(
    gpu::Device& device, const FrameScene& scene, SurfacePrograms& programs,
    const gpu::PipelineState& state, const std::function<void(const gpu::Program&)>& set);

}  // namespace limn
