#pragma once

#include "ecs/base/result.h"
#include "render/effect.h"
#include "render/frame_data.h"
#include "render/render_view.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

namespace gpu {
class Device;
class Texture;
}  // namespace gpu
class FrameGraph;
class World;

// Draws a frame: runs the list of effects (image.h) over every view that the frame needs, in one
// frame graph. Reads the world, never changes it:
//
//     Result<RendererPtr> renderer = create_renderer(device);
//     const FrameOutput frame = render_frame(**renderer, world, make_render_view(world, camera));
//     gpu::ByteImage png = gpu::read_bytes(*frame.display);
//
// Of the world it reads the resources Assets, Environment, Exposure, Rendering and FrameTime, what
// the effects read, and the entities with WorldTransform and MeshInstance or a light. Without an
// Environment the surroundings are black. Assets are uploaded on first use; a change to another
// World, or other Assets, is detected.

/// Chosen once, at creation.
struct RenderSettings {
    float anisotropy = 8.0f;  ///< of texture filters, clamped to what the device supports
    bool full_float =
        false;  ///< 32-bit float radiance on a GPU, too; a software OpenGL always has it
    int environment_size = 256;  ///< of the reflected surroundings [px], a power of two, 16 .. 1024
    std::span<const EffectEntry> image =
        {};  ///< empty: standard_image(); must outlive the renderer
};

/// Names of the arbitrary output variables that can be requested in addition to the image, in this
/// order:
///   depth     distance along the view axis [m]; kNoDepth where there is no surface (1 channel)
///   normal    of the shaded surface, world space, unit; 0 where there is no surface (3)
///   albedo    base color, linear (3)
///   velocity  motion since the previous frame [px], right and down as image rows run; the
///             sky has it, too (2)
///   emission  radiance of the surface's own light (3)
///   shadow_texels  texels per pixel of the finest shadow map that contains the point: below
///                  1, texels are visible (1)
///   volume_layers  polygons of shadow volumes over each pixel, hidden or not (1)
[[nodiscard]] const std::vector<std::string_view>& aov_names();
[[nodiscard]] int aov_channels(std::string_view name);  ///< 0: no such AOV
inline constexpr float kNoDepth = 1e10f;

struct FrameRequest {
    std::vector<std::string> aovs;  ///< of aov_names(); unknown ones are left out
    bool few_triangles = false;     ///< and instances of each mesh; maps that are kept are drawn so
    bool paced = false;  ///< in a window: work that would stop it for long is spread over frames
};

/// What the mean of samples is taken of.
enum class SampleMean : std::uint8_t {
    Light,  ///< radiance, as a camera's pixel collects it: the truth, and what an EXR stores
    /// What the display shows of it: edges of what is brighter than white are smooth. Samples are
    /// compressed by c / (1 + exposure * largest channel), and their mean is expanded again
    /// (Karis, "High Quality Temporal Supersampling", 2014). With a metered exposure: as Light.
    Displayed,
};

/// Statistics of the main view.
struct FrameStatistics {
    int instances = 0;           ///< with mesh, material and transform
    int visible_instances = 0;   ///< after culling
    int tested_boxes = 0;        ///< against the frustum, of instances and around groups of them
    int draws = 0;               ///< submitted for geometry; a multi-draw counts as one
    std::int64_t triangles = 0;  ///< submitted
    int deformed = 0;            ///< instances whose shape changed and was drawn
    int lights = 0;              ///< lights that are on
    int shadow_views = 0;        ///< in the shadow atlas
    int shadow_views_drawn = 0;  ///< of them, in this frame
    int probe_faces = 0;         ///< of environment probes, drawn for this frame
    int water_reflections = 0;   ///< planar ones, drawn for this frame
    int lit_objects = 0;    ///< drawn for a light, each once per light (LightMethod::LightMajor)
    int programs = 0;       ///< of the device, for whatever it has drawn
    int compiled = 0;       ///< of them, in this frame
    double extract_ms = 0;  ///< CPU time of culling and filling instance and light buffers
};

struct AovOutput {
    std::string name;
    int channels = 0;
    const gpu::Texture* texture = nullptr;  ///< RGBA32F; read the first `channels`
};

/// Textures belong to the renderer and are valid until its next frame. gpu::read_floats and
/// gpu::read_bytes return their rows from top to bottom.
struct FrameOutput {
    const gpu::Texture* display = nullptr;   ///< RGBA8: what a screen or PNG shows, sRGB encoded
    const gpu::Texture* radiance = nullptr;  ///< RGBA16F or RGBA32F: linear light before exposure
    std::vector<AovOutput> aovs;
    FrameStatistics statistics;
};

class Renderer;
struct RendererDeleter {
    void operator()(Renderer* renderer) const;
};
using RendererPtr = std::unique_ptr<Renderer, RendererDeleter>;

/// Creates the effects that every frame uses; fails with the shader compiler's message. The device
/// must outlive the renderer.
[[nodiscard]] Result<RendererPtr>
create_renderer(gpu::Device& device, const RenderSettings& settings = {});

FrameOutput render_frame(
    Renderer& renderer, const World& world, const RenderView& view,
    const FrameRequest& request = {});

/// Marks a cut, for example after an edit of the world: no history is blended into the next frame.
void cut(Renderer& renderer);

/// Called during a warm-up with the number of views drawn and in total.
using WarmUpProgress = std::function<void(int done, int total)>;

/// Compiles the programs that frames of this world need and uses them once, so that no frame has to
/// wait for that: draws small images from `view` and the cameras of the world, from afar, and from
/// positions that effects add (effect.h); also with all lights switched on. Then resets the
/// renderer: no view, history or cache of an earlier frame is left, and the next frame is
/// bit-identical to a renderer's first; only the world's assets stay uploaded. Returns the number
/// of programs used, whether compiled now or before.
///
/// Programs for what appears later (a light that is switched on, a new material, another setting)
/// are compiled when they are first drawn: FrameStatistics::compiled.
int warm_up(
    Renderer& renderer, const World& world, const RenderView& view,
    const WarmUpProgress& progress = {});

/// The mean radiance of `samples` >= 1 images whose pixels are shifted by sample_jitter: anti-
/// aliased edges. Radiance is RGBA32F; AOVs are sampled at pixel centers. One sample equals the
/// image of render_frame.
FrameOutput render_accumulated(
    Renderer& renderer, const World& world, const RenderView& view, int samples,
    const FrameRequest& request = {}, SampleMean mean = SampleMean::Light);

// An image that is the mean of others, at times and positions that the caller chooses; between
// samples the world may advance:
//
//     begin_accumulation(renderer, {1280, 720}, SampleKind::Instant);
//     for (...) { accumulate(renderer, world, view, 1.0f / samples); }
//     FrameOutput truth = finish_accumulation(renderer, world, view);
//
// Glow and glare, which are linear, are applied to the mean; motion blur that keeps a history of
// frames is left out of samples.

void begin_accumulation(
    Renderer& renderer, const IVec2& size, SampleKind kind, SampleMean mean = SampleMean::Light);
/// Adds `weight` times the radiance of `view`, which must have the size that was begun with.
void accumulate(Renderer& renderer, const World& world, const RenderView& view, float weight);
/// Keeps the requested AOVs of this view, sampled at pixel centers, for the output.
void accumulate_aovs(
    Renderer& renderer, const World& world, const RenderView& view, const FrameRequest& request);
/// Tone maps the sum. `view` is the one that the mean stands for. Radiance is RGBA32F.
FrameOutput finish_accumulation(Renderer& renderer, const World& world, const RenderView& view);

/// The passes of the last frame and their times, for profiler and buffer viewer.
[[nodiscard]] FrameGraph& frame_graph(Renderer& renderer);

}  // namespace limn
