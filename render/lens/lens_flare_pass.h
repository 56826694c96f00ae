#pragma once

#include "ecs/components/lens_flare.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/disk_visibility.h"

#include <vector>

namespace limn {

// Lens flare: what the surfaces of the lens reflect of the lights in view (engine.lens-flare).
//
// Reads    radiance, depth; LightList, LensFlare of the camera
// Writes   radiance, a new texture
// Order    after depth of field, which blurs what is before the lens, not what is within it; before
//          glow
// Shaders  disk_visibility.frag, lens_flare.vert, lens_flare.frag, glow_add.frag
//
// A ghost is a sprite at half resolution. A pixel p of it is light that met the aperture stop at
// scale p + offset, both from the ABCD matrices of the ghost (lens_ghosts.h); where that is outside
// the polygon of the stop, at any of its passages, or outside the front surface, there is none. Its
// irradiance on the sensor is that at the front of the lens times the ratio of the areas and the
// ghost's strength; as the scene's radiance L gives the irradiance pi L / (4 N^2), it is drawn with
// the radiance that would expose the sensor as much. The finite size of a light softens the edges
// and conserves the light of the ghost.
//
// A light counts as far as the samples of a disk about it are behind nothing in the depth buffer,
// and within the image, all on the GPU. Blended surfaces and particles hide nothing.

/// A light as the lens sees it.
struct FlareLight {
    Vec2 tangent = {0, 0};  ///< its place in the image, as tangent of the angle to the view axis
    Vec3 illuminance = {0, 0, 0};  ///< at the camera [lx]
};

/// Layout of lens_flare.vert: six texels. Lengths in the image are tangents of angles.
struct FlareSprite {
    Vec2 center = {0, 0};
    float radius = 0;  ///< of a circle about all of it
    float light = 0;   ///< number of its light
    Vec3 radiance = {0, 0, 0};
    float softness = 0;  ///< half of the width of its edge
    /// Where a ray meets a rim, in units of its radius: x * p + (y, z). w: FlareShape of the rim,
    /// or -1 for none.
    Vec4 rims[4] = {{0, 0, 0, -1}, {0, 0, 0, -1}, {0, 0, 0, -1}, {0, 0, 0, -1}};
};

static_assert(sizeof(FlareSprite) == 96);

/// The sprites of one light. `tangent_y` is that of half the field of view, `height` that of the
/// image [px].
[[nodiscard]] std::vector<FlareSprite>
make_flare_sprites(const LensFlare& flare, const FlareLight& light, float tangent_y, int height);

struct LensFlareEffect {
    const gpu::Program* visibility = nullptr;
    const gpu::Program* sprite = nullptr;
    const gpu::Program* add = nullptr;
    LensFlare flare = {};
    std::vector<DiskSource> sources = {};
    std::vector<FlareSprite> sprites = {};
    BufferTexture source_records = BufferTexture("flare sources", GL_RGBA32F);
    BufferTexture sprite_records = BufferTexture("flare sprites", GL_RGBA32F);

    static Result<LensFlareEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData&, ViewData& view);
};

}  // namespace limn
