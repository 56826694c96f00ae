#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/texture.h"
#include "render/light/light_list.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_list.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace limn {

// Soft shadows of particles on surfaces and on each other, by Fourier opacity maps (Jansen and
// Bavoil 2010): see lib/fourier_opacity.glsl.
//
// Reads    ParticleSprites: looks with `shadow`, moved by the CPU or the GPU; the lights
// Writes   opacity maps, once a frame for all views; what lighting binds
// Order    before lighting
// Shaders  particle_shadow.vert, particle_shadow.frag, particle_shadow_fit.comp;
//          lib/particle_shadow.glsl in lit shaders
//
// Only one light is shadowed: the first directional one, or without any the first spot with a
// Shadow. The map is fitted to the casters. Each particle is a slab that faces the light, as thick
// as its diameter; the tint of the shadow is the mean along each ray.

/// Bounding sphere of a caster [m].
struct ShadowBall {
    Vec3 center;
    float radius = 0;
};

/// Interval along an axis [m]; empty if low > high.
struct ShadowRange {
    float low = INFINITY;
    float high = -INFINITY;
};

/// The view from which the maps are drawn.
struct ParticleShadowView {
    std::array<Vec4, layout::kParticleShadowTexels> record{};
    Vec3 right = {1, 0, 0};               ///< unit, along the map's s
    Vec3 up = {0, 1, 0};                  ///< unit, along its t
    Vec3 axis = {0, 0, -1};               ///< unit, where the light goes
    Vec3 origin = {0, 0, 0};              ///< of depths
    float spot_range = -1;                ///< of a spot [m]; < 0: the sun
    std::array<ShadowRange, 3> ranges{};  ///< of s (the sun's), t (likewise) and depth
};

/// Consecutive casters with images in the same texture arrays.
struct ShadowCasters {
    ParticleArrays arrays{};
    int first = 0;
    int count = 0;
};

/// Casters that the GPU moves.
struct GpuShadowCaster {
    const GpuParticlePool* pool = nullptr;
    ParticleArrays arrays{};
};

/// The view of directional light `record` that travels along `axis` (unit), fitted to the balls.
[[nodiscard]] ParticleShadowView
view_from_sun(std::uint32_t record, const Vec3& axis, std::span<const ShadowBall> balls);
/// The view of a spot: its whole cone, with the range of depths fitted to the balls.
[[nodiscard]] ParticleShadowView
view_from_spot(const ShadowedLight& spot, std::span<const ShadowBall> balls);

struct ParticleShadowEffect {
    ProgramVariants programs;
    const gpu::Program* find_ranges = nullptr;
    const gpu::Program* write_record = nullptr;
    gpu::Texture maps;
    gpu::Buffer ranges;         ///< of casters on the GPU, as particle_shadow_fit.comp has them
    gpu::Buffer fitted_record;  ///< to these
    BufferTexture record = BufferTexture("particle shadow", GL_RGBA32F);
    BufferTexture fitted = BufferTexture("fitted particle shadow", GL_RGBA32F);
    BufferTexture texels = BufferTexture("particles that cast shadows", GL_R32UI);

    // Of the frame.
    std::vector<ParticleInstance> casters = {};
    std::vector<ShadowBall> balls = {};
    std::vector<ShadowCasters> runs = {};
    std::vector<GpuShadowCaster> gpu_casters = {};
    ParticleShadowView view = {};
    int light = 0;  ///< PARTICLE_SHADOWS; 0: none to shadow

    [[nodiscard]] static Result<ParticleShadowEffect>
    create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void request_views(FrameData& frame);  // requests none: called after all collect()
    bool prepare(const FrameData& frame, ViewData& view);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);

  private:
    void fit_to_gpu_casters(FrameGraph& graph, const ParticleSprites& sprites);
    void draw_casters(PassContext& context, const FrameData& frame);
};

}  // namespace limn
