#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/material/image_pool.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_draws.h"
#include "render/particles/particle_layer.h"
#include "render/particles/particle_runs.h"
#include "render/particles/particle_splats.h"

#include <optional>
#include <span>
#include <vector>

namespace limn {

// Draws the particles of all emitters, back to front, as quads that are lit at their corners or
// once (engine.billboard, particle.gpu-draw, particle.light-source-render); and segments of ribbons
// among them, as quads that share their corners (engine.trail).
//
// Reads    depth, light clusters, environment, InstanceList; ParticlePool, Trail, Beam, Billboard
//          with ParticleLook
// Writes   radiance; velocity and LensDepth, where they cover more than their look states
// Order    what is in water before it, what is behind blended surfaces before these, the rest after
//          them and before the lens
// Shaders  particle_light.comp, particle.vert, particle.frag, particle_velocity.frag,
// particle_focus.frag, particle_weighted.frag, particle_splat.comp, particle_splat_add.comp; layout
// in particle_gpu.h
//
// A look's `cover` is a factor on the opacity of premultiplied colors, so that fire that adds light
// and smoke that hides it are drawn in one order, and in one draw unless images differ in size or
// format. Sorted by distance of their centers. Where blended surfaces are seen, each pixel of a
// particle is drawn before them if the nearest of them hides it, and is seen through all of them:
// also through one that is behind it. Looks of half the resolution are sorted among themselves, in
// a layer (particle_layer.h) behind all others. Each view leaves out what it does not see; of
// particles on the GPU, emitters whose shape alone counts. Looks that are weighted instead of
// sorted (particle_weighted.h) are one layer before all others. Where blended surfaces are seen
// there are two of each layer, one on each side of these. Points on the GPU that only add light are
// drawn after all others, by compute (particle_splats.h), where no blended surface is seen.

struct ParticleEffect {
    /// What is drawn at half the resolution, and what the middle one of it hides or is hidden by;
    /// what is weighted; what is drawn once more, before the water that it is in.
    enum class Part { Behind, Half, Front, Weighted, UnderWater, All };

    struct ViewParticles {
        ParticlesInView seen{};
        BufferTexture texels = BufferTexture("particles in view", GL_R32UI);  ///< of its instances
        gpu::Buffer light{};       ///< vec4 of each instance, of those that are lit in the middle
        std::size_t capacity = 0;  ///< of `light`
        bool is_lit = false;       ///< the pass that writes it has been added
        BufferTexture light_texels = BufferTexture("light of particles", GL_RGBA32F);
        ParticleEffect* effect = nullptr;
    };

    ProgramVariants programs;
    ProgramVariants light_programs;
    ProgramVariants velocity_programs;
    ProgramVariants focus_programs;
    ProgramVariants veil_programs;  ///< depth of blended surfaces
    ParticleSplats splats;
    ParticleDraws draws = {};
    GpuParticlePools gpu = {};  ///< drawn after the others
    GpuParticleView gpu_view = {};
    std::optional<ParticleLayerPrograms> layer_programs = {};  ///< created with the first half one
    const gpu::Program* resolve = nullptr;  ///< of weighted ones, created with the first
    const gpu::Program* depth_copy = nullptr;
    gpu::Sampler image_sampler = {};
    gpu::Sampler finest_sampler = {};  ///< without mip levels
    DepthMemory seen_depth = {};       ///< while some on the GPU meet what the camera sees
    BufferTexture look_texels = BufferTexture("particle looks", GL_RGBA32F);
    BufferTexture ribbon_texels = BufferTexture("ribbon points", GL_RGBA32F);
    BufferTexture billboard_texels = BufferTexture("billboards", GL_RGBA32F);

    [[nodiscard]] static Result<ParticleEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
    /// What is seen through water.
    void draw_under_water(FrameGraph& graph, ViewData& view);
    /// What is behind blended surfaces.
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    /// The rest, after these.
    void draw_front(FrameGraph& graph, const FrameData& frame, ViewData& view);

  private:
    void add_layers(FrameGraph& graph, const FrameData& frame, ViewData& view, bool behind);
    void add_light(FrameGraph& graph, ViewData& view);
    void evaluate_light(PassContext& context, const ViewData& view);
    void add_sprites(
        FrameGraph& graph, ViewData& view, const char* name, TextureId depth,
        std::span<const Use> targets, Part part, const std::optional<TextureId>& veil = {},
        bool behind = false);
    void create_layer_programs(gpu::Device& device);
    [[nodiscard]] bool has_splats(const ViewData& view) const;
    [[nodiscard]] bool are_splats(const GpuParticlePool& pool) const;
    void add_splats(FrameGraph& graph, ViewData& view);
    void add_pool_reads(FrameGraph& graph, std::vector<Use>& reads) const;
    [[nodiscard]] Variant sprite_variant(const ViewData& view, SpriteShape shape, Part part) const;
    void
    draw_sprites(PassContext& context, const ViewData& view, Part part, bool veiled, bool behind);
    void draw_velocity(PassContext& context, const ViewData& view);
    void add_lens_depth(FrameGraph& graph, ViewData& view);
    void draw_lens_depth(PassContext& context, const ViewData& view);
    template <typename Use>
    void draw_runs(PassContext& context, const ViewData& view, Part part, Use&& use);
};

/// Published by ParticleEffect::draw().
struct ParticlesInFront {
    ParticleEffect* effect = nullptr;
    std::optional<TextureId> veil{};  ///< depth of the nearest blended surface, if one may be seen
};

/// From above the water, brighter by what the water pass absorbs between it and the ground. Not in
/// water without ground.
struct ParticlesUnderWaterEffect {
    [[nodiscard]] static Result<ParticlesUnderWaterEffect>
    create(gpu::Device&, const RenderSettings&) {
        return ParticlesUnderWaterEffect{};
    }
    static bool is_used(const FrameData& frame) { return ParticleEffect::is_used(frame); }
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

struct ParticleFrontEffect {
    [[nodiscard]] static Result<ParticleFrontEffect> create(gpu::Device&, const RenderSettings&) {
        return ParticleFrontEffect{};
    }
    static bool is_used(const FrameData& frame) { return ParticleEffect::is_used(frame); }
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
