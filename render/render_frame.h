#pragma once

#include "ecs/base/result.h"
#include "render/render_view.h"

#include <cstdint>
#include <memory>
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

// The image as a list of passes (render_frame.cpp). Reads the world, never changes it:
//
//     Result<std::unique_ptr<Renderer>> renderer = create_renderer(device);
//     const FrameOutput frame = render_frame(**renderer, world, make_render_view(world, camera));
//     gpu::ByteImage png = gpu::read_bytes(*frame.display);
//
// Of the world it reads the resources Assets, Environment, Exposure, Rendering and FrameTime and
// the entities with WorldTransform and MeshInstance or a light. No Environment means none: black,
// and only lights light. What was loaded into Assets is uploaded the first time it is seen; another
// World, or another Assets, is noticed.

/// Chosen once.
struct RenderSettings {
    float anisotropy = 8.0f;  ///< of texture filters, clamped to what the device has
    bool full_float = false;  ///< radiance in 32-bit floats on a GPU, too; without one it always is
    int environment_size = 256;  ///< of the reflected surroundings [px], a power of two, 16 .. 1024
};

/// Names of what can be had beside the picture, in this order:
///   depth     distance along the view axis [m]; kNoDepth where nothing is (1 channel)
///   normal    of the shaded surface, world space, unit; 0 where nothing is (3)
///   albedo    base color, linear (3)
///   velocity  motion since the moment before [px], right and down, as image rows run; of the sky,
///             too (2)
///   emission  radiance of the surface's own light (3)
///   shadow_texels  of the finest shadow map that holds the point, under the pixel: if less than 1,
///                  they show (1)
///   volume_layers  polygons of shadow volumes over each pixel, hidden or not (1)
[[nodiscard]] const std::vector<std::string_view>& aov_names();
[[nodiscard]] int aov_channels(std::string_view name);  ///< 0: no such AOV
inline constexpr float kNoDepth = 1e10f;

/// What to make of this frame.
struct FrameRequest {
    std::vector<std::string> aovs;  ///< of aov_names(); unknown ones are left out
};

struct FrameStatistics {
    int instances = 0;           ///< with mesh, material and transform
    int visible_instances = 0;   ///< after culling
    int draws = 0;               ///< submitted for geometry; a multi-draw counts as one
    std::int64_t triangles = 0;  ///< submitted
    int deformed = 0;            ///< instances whose shape changed and was drawn
    int lights = 0;              ///< that shine
    int shadow_views = 0;        ///< in the shadow atlas
    int shadow_views_drawn = 0;  ///< of them, in this frame
    int probe_faces = 0;         ///< that probes looked at anew
    int water_reflections = 0;   ///< drawn for this frame
    int lit_objects = 0;         ///< drawn for a light, each once a light (LightMethod::LightMajor)
    double extract_ms = 0;       ///< CPU time of culling and filling instance and light buffers
};

struct AovOutput {
    std::string name;
    int channels = 0;
    const gpu::Texture* texture = nullptr;  ///< RGBA32F; read the first `channels`
};

/// Textures belong to the renderer and are good until its next frame. gpu::read_floats and
/// gpu::read_bytes give their rows from top to bottom.
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

/// Loads every shader; fails with the compiler's message. The device must outlive the renderer.
[[nodiscard]] Result<RendererPtr>
create_renderer(gpu::Device& device, const RenderSettings& settings = {});

/// Draws one picture.
FrameOutput render_frame(
    Renderer& renderer, const World& world, const RenderView& view,
    const FrameRequest& request = {});

/// The mean radiance of `samples` >= 1 pictures whose pixels are shifted by sample_jitter: edges
/// become smooth. Radiance is RGBA32F; AOVs are those of the picture in the middle. One sample is
/// the picture of render_frame.
FrameOutput render_accumulated(
    Renderer& renderer, const World& world, const RenderView& view, int samples,
    const FrameRequest& request = {});

// A picture that is the mean of others, of moments and places that the caller chooses; between them
// the world may move on:
//
//     begin_accumulation(renderer, {1280, 720}, SampleKind::Instant);
//     for (...) { accumulate(renderer, world, view, 1.0f / samples); }
//     FrameOutput truth = finish_accumulation(renderer, world, view);

/// What a picture shows that becomes part of a mean. Glow and glare, which are the same for the
/// mean, are left to that; ways to blur motion that keep pictures (keeps_pictures) are left out.
enum class SampleKind : std::uint8_t {
    Played,   ///< a whole picture: moving things blurred, distant things out of focus
    Instant,  ///< one moment, through one point of the lens: what the mean itself shall blur
};

void begin_accumulation(Renderer& renderer, const IVec2& size, SampleKind kind);
/// Adds `weight` times the picture of `view`, which has the size that was begun with.
void accumulate(Renderer& renderer, const World& world, const RenderView& view, float weight);
/// Keeps what is asked for of this picture, from the middle of its pixels, for the output.
void accumulate_aovs(
    Renderer& renderer, const World& world, const RenderView& view, const FrameRequest& request);
/// Develops the sum. `view` is that of the moment the picture stands for. Radiance is RGBA32F.
FrameOutput finish_accumulation(Renderer& renderer, const World& world, const RenderView& view);

/// Its passes and their times, for profiler and buffer viewer.
[[nodiscard]] FrameGraph& frame_graph(Renderer& renderer);

}  // namespace limn
