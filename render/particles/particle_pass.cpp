#include "render/particles/particle_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/particles.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/geometry/instance_list.h"
#include "render/geometry/surface_draws.h"
#include "render/gpu/device.h"
#include "render/lens/lens_depth.h"
#include "render/light/lighting.h"
#include "render/material/material_pool.h"
#include "render/particles/particle_weighted.h"
#include "render/view_block.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>

// Techniques: engine.billboard, engine.trail, particle.depth-of-field, particle.gpu-draw,
//     particle.half-resolution, particle.light-source-render, particle.lit-in-middle,
//     particle.motion-vectors, particle.velocity, particle.weighted-blended

namespace limn {
namespace {

constexpr unsigned kImagesUnit = 0;
constexpr unsigned kMotionsUnit = 1;
constexpr unsigned kParticlesUnit = 2;
constexpr unsigned kLooksUnit = 3;
constexpr unsigned kSceneDepthUnit = 4;
constexpr unsigned kRibbonsUnit = 8;
constexpr unsigned kVeilUnit = 23;
constexpr unsigned kNegativeLightsUnit = 27;
constexpr unsigned kBillboardsUnit = 26;
constexpr unsigned kMiddleLightUnit = 28;
constexpr unsigned kMiddleLightBinding = 0;
constexpr int kLightGroup = 64;  // invocations of a work group

/// Surrounds the image with as much on each side, so that quads which its border cuts are not
/// clipped: one of them would send its neighbors through llvmpipe's slow clipper. Returns the
/// extent of the image as a share of the viewport's.
float set_wide_viewport(PassContext& context) {
    constexpr int kMaxViewport = 16384;  // that every OpenGL 4.5 has
    const IVec2 size = context.size();
    if (3 * std::max(size.x, size.y) > kMaxViewport) {
        return 1;
    }
    context.device().set_viewport(-size.x, -size.y, 3 * size.x, 3 * size.y);
    return 1.0f / 3;
}

/// Others would evaluate the six sides in vain.
bool is_six_way(const ParticleRun& run) {
    return run.arrays.negative_lights != 0 && run.shape == SpriteShape::Quad;
}

using Part = ParticleEffect::Part;

/// Of the looks that may be among what is drawn: others would cost each of its pixels fetches.
const SpriteFeatures& features_of(const ParticleDraws& draws, Part part) {
    const auto of = [&](LookLayer layer) -> const SpriteFeatures& {
        return draws.layer_features[static_cast<std::size_t>(layer)];
    };
    switch (part) {
    case Part::Half:
        return of(LookLayer::Half);
    case Part::Weighted:
        return of(LookLayer::Weighted);
    case Part::Behind:
    case Part::Front:
        return of(LookLayer::Full);
    case Part::UnderWater:
    case Part::All:
        break;
    }
    return draws.features;
}

}  // namespace

Result<ParticleEffect> ParticleEffect::create(gpu::Device& device, const RenderSettings&) {
    ParticleEffect effect{
        ProgramVariants(device, {.vertex = "particle.vert", .fragment = "particle.frag"}),
        ProgramVariants(device, {.compute = "particle_light.comp"}),
        ProgramVariants(device, {.vertex = "particle.vert", .fragment = "particle_velocity.frag"}),
        ProgramVariants(device, {.vertex = "particle.vert", .fragment = "particle_focus.frag"}),
        ProgramVariants::of_meshes(device, "depth_first.frag"),
        create_particle_splats(device)};
    effect.gpu = LIMN_TRY(GpuParticlePools::create(device));
    // As of materials: between mip levels only where that costs nothing.
    const GLenum minify =
        device.caps().software ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR;
    effect.image_sampler =
        gpu::Sampler("particle images", {.minify = minify, .wrap = GL_CLAMP_TO_EDGE});
    effect.finest_sampler =
        gpu::Sampler("finest particle images", {.minify = GL_LINEAR, .wrap = GL_CLAMP_TO_EDGE});
    effect.depth_copy = LIMN_TRY(load_fullscreen(device, "seen_depth.frag"));
    return effect;
}

bool ParticleEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const ParticleLook>().empty();
}

void ParticleEffect::collect(FrameData& frame) {
    collect_particle_draws(frame, gpu, draws);
    const Affine& camera = frame.camera.world_from_camera;
    gpu_view = {
        .back = particle_lag(frame),
        .eye = transform_point(camera, Vec3(0)),
        .forward = transform_vector(camera, Vec3(0, 0, -1)),
        .seen = gpu.meets_depth() ? recall_depth(seen_depth, frame) : SeenDepth{}};
    auto& sprites = frame.data.publish<ParticleSprites>();
    sprites.instances = draws.instances;
    sprites.gpu = &gpu;
    sprites.gpu_view = &gpu_view;
    sprites.looks = draws.looks;
    sprites.arrays = draws.arrays;
    sprites.features = draws.features;
    sprites.look_texels = &look_texels;
    look_texels.upload(*frame.ring, draws.looks);
    ribbon_texels.upload(*frame.ring, draws.ribbons.points);
    billboard_texels.upload(*frame.ring, draws.billboards.quads);
}

bool ParticleEffect::prepare(const FrameData& frame, ViewData& view) {
    auto& particles = view.data.publish<ViewParticles>();
    particles.effect = this;
    select_particles(draws, gpu, frame, view, particles.seen);
    particles.texels.upload(*frame.ring, particles.seen.instances);
    particles.is_lit = false;
    return !particles.seen.runs.empty() || !gpu.pools().empty();
}

void ParticleEffect::draw_shared(FrameGraph& graph, const FrameData&) {
    gpu.update(graph, gpu_view);
}

void ParticleEffect::draw_under_water(FrameGraph& graph, ViewData& view) {
    const Use targets[] = {view.radiance};
    add_sprites(
        graph, view, "particles.under water", view.gbuffer.depth, targets, Part::UnderWater);
}

void ParticlesUnderWaterEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const auto* const particles = view.data.find<ParticleEffect::ViewParticles>();
    if (particles == nullptr) {
        return;
    }
    const ParticlesInView& seen = particles->seen;
    if (seen.under_begin < seen.runs.size()
        || (seen.above_water && !particles->effect->gpu.pools().empty())) {
        particles->effect->draw_under_water(graph, view);
    }
}

void ParticleEffect::add_pool_reads(FrameGraph& graph, std::vector<Use>& reads) const {
    for (const auto& [entity, pool] : gpu.pools()) {
        reads.emplace_back(
            pool->sorted ? graph.import("sorted particles", pool->sort.instances)
                         : graph.import("particles", pool->instances));
    }
}

/// Once a view, before any are drawn.
void ParticleEffect::add_light(FrameGraph& graph, ViewData& view) {
    auto& drawn = view.data.publish<ViewParticles>();  // as prepare() left it
    const std::size_t count = drawn.seen.instances.size();
    if (drawn.is_lit || !draws.lit_in_middle) {
        return;
    }
    drawn.is_lit = true;
    if (drawn.capacity <= count) {
        drawn.capacity = std::bit_ceil(count + 1);
        drawn.light = gpu::Buffer(
            "light of particles", drawn.capacity * sizeof(Vec4), gpu::BufferUse::GpuOnly);
        drawn.light_texels.set(drawn.light);
    }
    const std::vector<Use> reads = lighting_reads(view, {});
    const Use writes[] = {graph.import("particles.light", drawn.light)};
    graph.add_pass(
        "particles.light", std::span(reads), writes,
        [this, &view](PassContext& context) { evaluate_light(context, view); });
}

void ParticleEffect::evaluate_light(PassContext& context, const ViewData& view) {
    const auto& drawn = view.data.get<ViewParticles>();
    const gpu::Program* const program = light_programs.get(view.lighting.variant);
    if (program == nullptr) {
        return;
    }
    const int count = static_cast<int>(drawn.seen.instances.size());
    gpu::Device& device = context.device();
    bind_lighting(context, view);
    drawn.texels.bind(device, kParticlesUnit);
    look_texels.bind(device, kLooksUnit);
    device.bind_storage(kMiddleLightBinding, drawn.light);
    device.use(*program);
    program->set("count", count);
    device.dispatch(static_cast<std::uint32_t>((count + kLightGroup - 1) / kLightGroup));
}

void ParticleEffect::add_sprites(
    FrameGraph& graph, ViewData& view, const char* name, TextureId depth,
    std::span<const Use> targets, Part part, const std::optional<TextureId>& veil, bool behind) {
    add_light(graph, view);
    std::vector<Use> reads =
        lighting_reads(view, {depth_tested(depth), sampled(depth, kSceneDepthUnit)});
    if (const auto& drawn = view.data.get<ViewParticles>(); drawn.is_lit) {
        reads.emplace_back(graph.import("particles.light", drawn.light));
    }
    if (veil) {
        reads.push_back(sampled(*veil, kVeilUnit));
    }
    add_pool_reads(graph, reads);
    graph.add_pass(
        name, std::span<const Use>(reads), targets,
        [this, &view, part, veiled = veil.has_value(), behind](PassContext& context) {
            draw_sprites(context, view, part, veiled, behind);
        });
}

void ParticleEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    auto& front = view.data.publish<ParticlesInFront>();
    front.effect = this;
    front.veil.reset();
    const std::vector<DrawRun>& blended = view.data.get<InstanceList>().blended;
    if (blended.empty()) {
        return;
    }
    front.veil = create_target(graph, "particles.veil", GL_DEPTH_COMPONENT32F, view.size());
    const std::vector<Use> meshes = mesh_reads(graph, *view.frame);
    const Use veil[] = {cleared(*front.veil)};
    graph.add_pass(
        "particles.veil", std::span<const Use>(meshes), veil,
        [this, &view, &blended](PassContext& context) {
            bind_view(context, view);
            draw_depths(context, view, blended, veil_programs);
        });
    add_layers(graph, frame, view, true);
}

void ParticleFrontEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    if (const auto* const front = view.data.find<ParticlesInFront>()) {
        front->effect->draw_front(graph, frame, view);
    }
}

/// What is behind the blended surfaces, if some may be seen, or the rest.
void ParticleEffect::add_layers(
    FrameGraph& graph, const FrameData& frame, ViewData& view, bool behind) {
    const ParticlesInView& seen = view.data.get<ViewParticles>().seen;
    const std::optional<TextureId> veil = view.data.get<ParticlesInFront>().veil;
    const auto add_pass = [&](const char* name, const char* veiled, TextureId depth,
                              std::initializer_list<Use> targets, Part part) {
        add_sprites(
            graph, view, behind ? veiled : name, depth, std::span(targets.begin(), targets.size()),
            part, veil, behind);
    };
    create_layer_programs(*frame.device);
    if (seen.half_begin > 0) {
        add_pass(
            "particles.behind", "particles.veiled behind", view.gbuffer.depth, {view.radiance},
            Part::Behind);
    }
    if (draws.has_halves && layer_programs && !is_empty(seen.half_window)) {
        const ParticleLayer layer =
            begin_particle_layer(graph, *layer_programs, view, seen.half_window);
        add_pass(
            "particles.half", "particles.veiled half", layer.depth, {cleared(layer.radiance)},
            Part::Half);
        end_particle_layer(graph, *layer_programs, layer, view);
    }
    add_pass("particles", "particles.veiled", view.gbuffer.depth, {view.radiance}, Part::Front);
    if (draws.has_weighted && resolve != nullptr && !is_empty(seen.weighted_bounds)) {
        const WeightedLayers mixed = create_weighted_layers(graph, view);
        add_pass(
            "particles.weighted", "particles.veiled weighted", view.gbuffer.depth,
            {cleared(mixed.sum), cleared(mixed.kept, Vec4(1))}, Part::Weighted);
        resolve_weighted(graph, *resolve, mixed, view);
    }
    if (has_splats(view)) {
        add_splats(graph, view);
    }
}

/// What a blended surface hides, points in front of it among them, is drawn by the rasterizer.
bool ParticleEffect::has_splats(const ViewData& view) const {
    return view.is(kMainViews) && !is_clipped(view) && !view.data.get<ParticlesInFront>().veil;
}

bool ParticleEffect::are_splats(const GpuParticlePool& pool) const {
    return draws.layers[pool.look] == LookLayer::Full
           && can_be_splats(pool, draws.looks[pool.look]);
}

void ParticleEffect::add_splats(FrameGraph& graph, ViewData& view) {
    std::size_t count = 0;
    float brightest = 0;
    std::vector<Use> reads = {sampled(view.gbuffer.depth, kSceneDepthUnit)};
    for (const auto& [entity, pool] : gpu.pools()) {
        if (are_splats(*pool)) {
            count += pool->count;
            brightest = std::max(brightest, brightest_of(draws.looks[pool->look]));
            reads.emplace_back(graph.import("particles", pool->instances));
        }
    }
    if (brightest <= 0) {
        return;
    }
    const gpu::Program* const program = begin_particle_splats(splats, view, count, brightest);
    const Use writes[] = {graph.import("sums of particles", splats.sums)};
    graph.add_pass(
        "particles.splats", std::span<const Use>(reads), writes,
        [this, &view, program](PassContext& context) {
            bind_view(context, view);
            look_texels.bind(context.device(), kLooksUnit);
            for (const auto& [entity, pool] : gpu.pools()) {
                if (program != nullptr && pool->count > 0 && are_splats(*pool)) {
                    pool->texels.bind(context.device(), kParticlesUnit);
                    draw_particle_splats(context, *program, splats, *pool);
                }
            }
        });
    add_particle_sums(graph, splats, view);
}

void ParticleEffect::draw_front(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    add_layers(graph, frame, view, false);
    if (view.velocity && draws.moving) {
        std::vector<Use> reads = {
            depth_tested(view.gbuffer.depth), sampled(view.gbuffer.depth, kSceneDepthUnit)};
        add_pool_reads(graph, reads);
        const Use writes[] = {view.gbuffer.velocity};
        graph.add_pass(
            "particles.velocity", std::span(reads), writes,
            [this, &view](PassContext& context) { draw_velocity(context, view); });
    }
    if (view.camera.lens.aperture_radius > 0 && draws.focused) {
        add_lens_depth(graph, view);
    }
    if (view.is(kMainViews) && gpu.meets_depth()) {
        remember_depth(graph, *depth_copy, view, seen_depth);
    }
}

void ParticleEffect::add_lens_depth(FrameGraph& graph, ViewData& view) {
    const TextureId scene = view.gbuffer.depth;
    TextureSpec spec = graph.spec(scene);
    spec.name = "particles.lens depth";
    const TextureId depth = graph.create(spec);
    graph.add_pass(
        "particles.depth behind", {scene}, {image(depth)}, [scene, depth](PassContext& context) {
            context.texture(scene).copy_to(context.texture(depth));
        });
    std::vector<Use> reads;
    add_pool_reads(graph, reads);
    const Use writes[] = {depth};
    graph.add_pass(
        "particles.lens depth", std::span<const Use>(reads), writes,
        [this, &view](PassContext& context) { draw_lens_depth(context, view); });
    view.data.publish<LensDepth>().depth = depth;
}

void ParticleEffect::create_layer_programs(gpu::Device& device) {
    const auto assign = [](auto made, auto& target) {
        if (made) {
            target = *made;
        } else {
            log_error("{}", made.error().message);
        }
    };
    if (draws.has_halves && !layer_programs) {
        assign(create_particle_layer_programs(device), layer_programs);
    }
    if (draws.has_weighted && resolve == nullptr) {
        assign(load_fullscreen(device, "particle_weighted.frag"), resolve);
    }
}

Variant ParticleEffect::sprite_variant(const ViewData& view, SpriteShape shape, Part part) const {
    Variant variant;
    variant.add_if(is_clipped(view), "CLIPPED");
    variant.add_if(draws.soft, "SOFT");
    if (shape != SpriteShape::Quad) {
        variant.add("POINTS");
        return variant;
    }
    features_of(draws, part).add_to(variant);
    variant.add_if(draws.has_ribbons, "RIBBONS");
    variant.add_if(draws.has_billboards, "BILLBOARDS");
    return variant;
}

void ParticleEffect::draw_velocity(PassContext& context, const ViewData& view) {
    // Frames between steps show particles on straight lines, from the velocity of the step's end.
    const float step = particle_step(*view.frame);
    const float back = particle_lag(*view.frame);
    const RenderView& camera = view.camera;
    const float time = std::min(
        (camera.alpha - camera.previous_alpha) * step, static_cast<float>(view.frame->time));
    const bool crosses = time + back > 0.999f * step;  // the beginning of the step
    const float bend = crosses ? step * (back + time - 0.5f * step) : 0.0f;
    bind_view(context, view);
    draw_runs(context, view, Part::All, [&](const ParticleRun& run) {
        Variant variant("VELOCITY");
        variant.add(sprite_variant(view, run.shape, Part::All));
        const gpu::Program* const program = velocity_programs.get(variant);
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{
                program, {.depth = {.write = false}, .cull = GL_NONE, .clip = is_clipped(view)}});
            program->set("since_previous", Vec2(std::max(time, 0.0f), bend));
        }
        return program;
    });
}

void ParticleEffect::draw_lens_depth(PassContext& context, const ViewData& view) {
    bind_view(context, view);
    draw_runs(context, view, Part::All, [&](const ParticleRun& run) {
        Variant variant("FOCUS");
        variant.add(sprite_variant(view, run.shape, Part::All));
        const gpu::Program* const program = focus_programs.get(variant);
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{program, {.cull = GL_NONE}});
        }
        return program;
    });
}

/// What the GPU moves at full resolution is in front.
void ParticleEffect::draw_sprites(
    PassContext& context, const ViewData& view, Part part, bool veiled, bool behind) {
    const bool is_weighted = part == Part::Weighted;
    gpu::PipelineState state = kWeightedState;
    if (!is_weighted) {
        state.blend = gpu::kBlendPremultiplied;
        state.second_blend = {};
    }
    state.clip = is_clipped(view);
    bind_lighting(context, view);
    draw_runs(context, view, part, [&](const ParticleRun& run) {
        const SpriteShape shape = run.shape;
        Variant variant = view.lighting.variant;
        variant.add_if(run.lit && shape != SpriteShape::SmallDisc, "LIT");
        variant.add_if(draws.lit_in_middle && shape == SpriteShape::Quad, "LIT_MIDDLE");
        variant.add_if(is_six_way(run), "SIX_WAY");
        variant.add_if(is_weighted, "WEIGHTED");
        variant.add_if(veiled, "VEILED");
        variant.add_if(part == Part::UnderWater, "IN_WATER");
        variant.add(sprite_variant(view, shape, part));
        const gpu::Program* const program = programs.get(variant);
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{program, state});
            program->set("behind", behind ? 1 : 0);
        }
        if (program != nullptr && is_weighted) {
            const ParticlesInView& seen = view.data.get<ViewParticles>().seen;
            program->set("weight_range", weight_range(seen.weighted_bounds, view.camera));
        }
        return program;
    });
}

/// `use(run)` uses the program for it and returns it, or null.
template <typename Use>
void ParticleEffect::draw_runs(PassContext& context, const ViewData& view, Part part, Use&& use) {
    gpu::Device& device = context.device();
    const float framed = set_wide_viewport(context);
    const auto& drawn = view.data.get<ViewParticles>();
    const ParticlesInView& seen = drawn.seen;
    drawn.texels.bind(device, kParticlesUnit);
    if (drawn.is_lit) {
        drawn.light_texels.bind(device, kMiddleLightUnit);
    }
    look_texels.bind(device, kLooksUnit);
    ribbon_texels.bind(device, kRibbonsUnit);
    billboard_texels.bind(device, kBillboardsUnit);
    const auto bind_images = [&](const ParticleArrays& arrays, bool magnified) {
        const ImagePool& pool = view.frame->materials->images();
        const gpu::Sampler& sampler = magnified ? finest_sampler : image_sampler;
        if (draws.features.images) {
            device.bind_texture(kImagesUnit, pool.array(arrays.images), &sampler);
        }
        if (draws.features.motions) {
            device.bind_texture(kMotionsUnit, pool.array(arrays.motions), &finest_sampler);
        }
        if (arrays.negative_lights != 0) {
            device.bind_texture(kNegativeLightsUnit, pool.array(arrays.negative_lights), &sampler);
        }
    };
    const std::span<const ParticleRun> all(seen.runs);
    const auto runs =
        part == Part::Behind  ? all.first(seen.half_begin)
        : part == Part::Half  ? all.subspan(seen.half_begin, seen.half_end - seen.half_begin)
        : part == Part::Front ? all.subspan(seen.half_end, seen.weighted_begin - seen.half_end)
        : part == Part::Weighted
            ? all.subspan(seen.weighted_begin, seen.under_begin - seen.weighted_begin)
        : part == Part::UnderWater ? all.subspan(seen.under_begin)
                                   : all.first(seen.under_begin);
    const gpu::Program* program = nullptr;
    std::optional<ParticleRun> last;
    const auto draw_run = [&](const ParticleRun& run) {
        const bool is_alike = last && last->shape == run.shape && last->lit == run.lit
                              && is_six_way(*last) == is_six_way(run);
        program = is_alike ? program : use(run);
        last = run;
        if (program == nullptr) {
            return;
        }
        program->set("first", run.first);
        program->set("framed", framed);
        program->set("resolution", part == Part::Half ? 0.5f : 1.0f);
        bind_images(run.arrays, run.magnified);
        if (run.shape == SpriteShape::Quad) {
            device.draw_quads(run.count);
        } else {
            device.draw_points(run.count);
        }
    };
    for (const ParticleRun& run : runs) {
        draw_run(run);
        if (view.frame->warm_up && run.shape != SpriteShape::Point) {
            ParticleRun other = run;
            other.shape =
                run.shape == SpriteShape::Quad ? SpriteShape::SmallDisc : SpriteShape::Quad;
            draw_run(other);
            other = run;
            other.arrays.negative_lights = 0;
            draw_run(other);
            other.lit = false;
            draw_run(other);
        }
    }
    const Frustum frustum = make_frustum(view.camera.clip_from_world);
    for (const auto& [entity, pool] : gpu.pools()) {
        const std::uint32_t count = pool->sorted ? pool->sort.count : pool->count;
        const LookLayer layer = draws.layers[pool->look];
        const Part pool_part = part == Part::UnderWater       ? part
                               : layer == LookLayer::Half     ? Part::Half
                               : layer == LookLayer::Weighted ? Part::Weighted
                                                              : Part::Front;
        const bool is_drawn = pool_part == part || part == Part::All;
        const bool is_splat = part == Part::Front && has_splats(view) && are_splats(*pool);
        if (count > 0 && is_drawn && !is_splat
            && is_group_in_view(draws.extents[pool->look], frustum)) {
            (pool->sorted ? pool->sort.texels : pool->texels).bind(device, kParticlesUnit);
            draw_run(
                {.arrays = draws.arrays[pool->look],
                 .shape =
                     is_point(draws.looks[pool->look]) ? SpriteShape::Point : SpriteShape::Quad,
                 .lit = is_lit_at_corners(draws.looks[pool->look]),
                 .count = static_cast<int>(count)});
        }
    }
}

}  // namespace limn
