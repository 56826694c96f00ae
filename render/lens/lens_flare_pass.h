#pragma once

#include "ecs/components/lens_flare.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/disk_visibility.h"

#include <vector>

namespace limn {

// Lens flare: reflections of the lights in view on the surfaces of the lens (engine.lens-flare).
//
// Reads    radiance, depth; LightList, LensFlare of the camera
// Writes   radiance, a new texture
// Order    after depth of field, which blurs the scene, not reflections within the lens; before
// glow Shaders  disk_visibility.frag, lens_flare.vert, lens_flare.frag, glow_add.frag
//
// A ghost is a sprite at half resolution. Light in its pixel p has passed the aperture stop at
// scale p + offset, both from the ABCD matrices of the ghost (lens_ghosts.h); there is none where
// that is outside the polygon of the stop, at any of its passages, or outside the front surface.
// Its irradiance on the sensor is that at the front of the lens times the ratio of the areas and
// the ghost's strength; as the scene's radiance L gives the irradiance pi L / (4 N^2), it is drawn
// with the radiance that would expose the sensor as much. The finite size of a light softens the
// edges and conserves the light of the ghost.
//
// A light is visible by the fraction of the samples of a disk around it that pass the depth test
// and lie within the image, all on the GPU. Blended surfaces and particles do not occlude it.

/// A light in the view of the lens.
struct FlareLight {
    Vec2 tangent = {0, 0};  ///< its position in the image: tangent of the angle to the view axis
    Vec3 illuminance = {0, 0, 0};  ///< at the camera [lx]
};

/// Layout of lens_flare.vert: six texels. Lengths in the image are tangents of angles.
struct FlareSprite {
    Vec2 center = {0, 0};
    float radius = 0;  ///< of a circle around all of it
    float light = 0;   ///< index of its light
    Vec3 radiance = {0, 0, 0};
    float softness = 0;  ///< half of the width of its edge
    /// Where a ray crosses the plane of a rim, in units of its radius: x * p + (y, z). w:
    /// FlareShape of the rim, or -1 for none.
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
