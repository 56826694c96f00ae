#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/material/image_pool.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/layered_draws.h"
#include "render/particles/particle_layer.h"
#include "render/particles/particle_scene.h"
#include "render/particles/particle_splats.h"
#include "render/particles/sprite_programs.h"

#include <optional>
#include <span>
#include <vector>

namespace limn {

// Draws the particles of all emitters, back to front, as quads that are lit at their corners or
// once (engine.billboard, particle.gpu-draw, particle.light-source-render); and segments of ribbons
// among them, as quads with common corners (engine.trail).
//
// Reads    depth, light clusters, environment, InstanceList; ParticlePool, Trail, Beam, Billboard
//          with ParticleLook
// Writes   radiance; velocity and LensDepth, where they cover more than their look states
// Order    Underwater before water; what is behind blended surfaces before these; the rest after
//          them and before the lens
// Shaders  particle.vert and particle_point.vert (sprite_programs.h) with particle.frag,
//          particle_velocity.frag and particle_focus.frag; particle_light.comp,
//          particle_weighted.frag, particle_splat.comp, particle_splat_add.comp; layout in
//          particle_gpu.h
//
// A look's `cover` is a factor on the opacity of premultiplied colors, so that fire that adds light
// and smoke that hides it are sorted together, and batched into one draw call unless images differ
// in size or format. Each view has a culled list of draws (layered_draws.h); particles on the GPU
// are culled by emitter. Particles at half the resolution are sorted among themselves, in one image
// (particle_layer.h); full-resolution ones in front of its median are drawn after it. Weighted
// ones (particle_weighted.h) are one image in front of all that are sorted. If blended surfaces are
// visible, all layers above water are drawn twice: pixels behind the nearest blended surface before
// the surfaces, and the others after all of them; so particles between two of these surfaces are
// visible through both. Ribbons, billboards and sprites share a program so that they can be
// batched: otherwise every few segments of a ribbon among sparks would be a draw call.

struct ParticleEffect {
    struct ViewParticles {
        LayeredDraws list{};
        BufferTexture texels = BufferTexture("particles in view", GL_R32UI);  ///< of its instances
        gpu::Buffer light{};       ///< a vec4 per instance, written for those lit at their centers
        std::size_t capacity = 0;  ///< of `light`
        bool is_lit = false;       ///< the pass that writes it has been added
        BufferTexture light_texels = BufferTexture("light of particles", GL_RGBA32F);
        ParticleEffect* effect = nullptr;
    };

    /// Which side of the blended surfaces is drawn.
    struct Side {
        std::optional<TextureId> veil{};  ///< depth of the nearest blended surface; none: all
        bool behind = false;
    };

    SpritePrograms programs;
    ProgramVariants light_programs;
    ProgramVariants veil_programs;  ///< depth of blended surfaces
    ParticleSplats splats;
    ParticleScene scene = {};
    GpuParticlePools gpu = {};
    GpuParticleView gpu_view = {};
    std::optional<ParticleLayerPrograms> layer_programs = {};  ///< created with the first half one
    const gpu::Program* resolve = nullptr;  ///< of weighted ones, created with the first
    const gpu::Program* depth_copy = nullptr;
    gpu::Sampler image_sampler = {};
    gpu::Sampler finest_sampler = {};  ///< without mip levels
    DepthMemory previous_depth = {};   ///< kept while some particles on the GPU collide with it
    BufferTexture look_texels = BufferTexture("particle looks", GL_RGBA32F);
    BufferTexture ribbon_texels = BufferTexture("ribbon points", GL_RGBA32F);
    BufferTexture billboard_texels = BufferTexture("billboards", GL_RGBA32F);

    [[nodiscard]] static Result<ParticleEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
    /// The layer Underwater.
    void draw_underwater(FrameGraph& graph, ViewData& view);
    /// All layers above water, behind blended surfaces.
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    /// The rest, after the blended surfaces.
    void draw_front(FrameGraph& graph, const FrameData& frame, ViewData& view);

  private:
    void create_layer_programs(gpu::Device& device);
    void add_layers_above_water(
        FrameGraph& graph, const FrameData& frame, ViewData& view, const Side& side);
    void add_layer(FrameGraph& graph, ViewData& view, SpriteLayer layer, const Side& side);
    void add_sprites(
        FrameGraph& graph, ViewData& view, SpriteLayer layer, const Side& side, TextureId depth,
        std::span<const Use> targets);
    void add_splats(FrameGraph& graph, ViewData& view);
    void add_light(FrameGraph& graph, ViewData& view);
    void evaluate_light(PassContext& context, const ViewData& view);
    void add_velocity(FrameGraph& graph, ViewData& view);
    void add_lens_depth(FrameGraph& graph, ViewData& view);
    void add_pool_reads(FrameGraph& graph, std::vector<Use>& reads) const;

    [[nodiscard]] Variant
    sprite_variant(const ViewData& view, SpriteShape shape, const SpriteFeatures& features) const;
    void draw_layer(
        PassContext& context, const ViewData& view, SpriteLayer layer, bool veiled, bool behind);
    void draw_velocity(PassContext& context, const ViewData& view);
    void draw_lens_depth(PassContext& context, const ViewData& view);
    template <typename Use>
    void draw_sprites(
        PassContext& context, const ViewData& view, std::span<const SpriteDraw> draws,
        float resolution, Use&& use);
    void bind_images(
        gpu::Device& device, const ViewData& view, const ParticleArrays& arrays,
        bool magnified) const;
};

/// Published by ParticleEffect::draw().
struct ParticlesInFront {
    ParticleEffect* effect = nullptr;
    std::optional<TextureId> veil{};  ///< depth of the nearest blended surface, if one is visible
};

/// Particles in water, visible from above: brightened by what the water pass will absorb between
/// them and the ground. None are visible in water without ground.
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
