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
#include "render/shaders/particle_gpu.h"
#include "render/view_block.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

// Techniques: engine.billboard, engine.trail, particle.depth-of-field, particle.gpu-draw,
//     particle.half-resolution, particle.light-source-render, particle.lit-in-middle,
//     particle.motion-vectors, particle.velocity, particle.weighted-blended

namespace limn {
namespace {

constexpr int kLightGroup = 64;  // invocations of a work group

/// Makes the viewport three times as wide and high as the image, so that quads across its border
/// need no clipping: a single one sends its neighbors through llvmpipe's slow clipper. Returns the
/// extent of the image as a fraction of the viewport's.
float set_wide_viewport(PassContext& context) {
    constexpr int kMaxViewport = 16384;  // that OpenGL 4.5 guarantees
    const IVec2 size = context.size();
    if (3 * std::max(size.x, size.y) > kMaxViewport) {
        return 1;
    }
    context.device().set_viewport(-size.x, -size.y, 3 * size.x, 3 * size.y);
    return 1.0f / 3;
}

/// How a layer is drawn.
struct SpriteLayerRow {
    const char* pass;
    const char* pass_behind;  ///< the pass behind blended surfaces
    float resolution = 1;     ///< as a fraction of the view's
};
constexpr std::array<SpriteLayerRow, kSpriteLayers> kSpriteLayerRows = {{
    {"particles.under water", "particles.under water"},   // Underwater
    {"particles.behind", "particles.veiled behind"},      // Behind
    {"particles.half", "particles.veiled half", 0.5f},    // Half
    {"particles.splats", "particles.splats"},             // Splats
    {"particles", "particles.veiled"},                    // Front
    {"particles.weighted", "particles.veiled weighted"},  // Weighted
}};

const SpriteLayerRow& layer_row(SpriteLayer layer) {
    return kSpriteLayerRows[static_cast<std::size_t>(layer)];
}

/// Whether the draw needs the variant that evaluates light from six sides.
bool is_six_way_draw(const SpriteDraw& draw) {
    return draw.arrays.negative_lights != 0 && draw.shape == SpriteShape::Quad;
}

/// Features of the looks in the layer: unused ones would cost fetches at every pixel.
const SpriteFeatures& features_of(const ParticleScene& scene, SpriteLayer layer) {
    const auto of = [&](LookLayer look_layer) -> const SpriteFeatures& {
        return scene.layer_features[static_cast<std::size_t>(look_layer)];
    };
    switch (layer) {
    case SpriteLayer::Half:
        return of(LookLayer::Half);
    case SpriteLayer::Weighted:
        return of(LookLayer::Weighted);
    case SpriteLayer::Behind:
    case SpriteLayer::Front:
    case SpriteLayer::Splats:
        return of(LookLayer::Full);
    case SpriteLayer::Underwater:
        break;
    }
    return scene.features;
}

/// Variants of a draw that other frames may need, to compile them at the warm-up: with other sizes,
/// other images, or unlit.
std::vector<SpriteDraw> alternatives_of(const SpriteDraw& draw) {
    SpriteDraw other = draw;
    other.shape = draw.shape == SpriteShape::Quad ? SpriteShape::SmallDisc : SpriteShape::Quad;
    SpriteDraw flat = draw;
    flat.arrays.negative_lights = 0;
    SpriteDraw unlit = flat;
    unlit.lit = false;
    return {other, flat, unlit};
}

}  // namespace

Result<ParticleEffect> ParticleEffect::create(gpu::Device& device, const RenderSettings&) {
    ParticleEffect effect{
        SpritePrograms(device), ProgramVariants(device, {.compute = "particle_light.comp"}),
        ProgramVariants::of_meshes(device, "depth_first.frag"), create_particle_splats(device)};
    effect.gpu = LIMN_TRY(GpuParticlePools::create(device));
    // As for materials: trilinear only where that is free.
    const GLenum minify =
        device.caps().software ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR;
    effect.image_sampler =
        gpu::Sampler("particle images", {.minify = minify, .wrap = GL_CLAMP_TO_EDGE});
    effect.finest_sampler =
        gpu::Sampler("finest particle images", {.minify = GL_LINEAR, .wrap = GL_CLAMP_TO_EDGE});
    effect.depth_copy = LIMN_TRY(load_fullscreen(device, "previous_depth.frag"));
    return effect;
}

bool ParticleEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const ParticleLook>().empty();
}

void ParticleEffect::collect(FrameData& frame) {
    collect_particles(frame, gpu, scene);
    const Affine& camera = frame.camera.world_from_camera;
    gpu_view = {
        .back = particle_lag(frame),
        .eye = transform_point(camera, Vec3(0)),
        .forward = transform_vector(camera, Vec3(0, 0, -1)),
        .depth = gpu.collides_with_depth() ? recall_depth(previous_depth, frame) : PreviousDepth{}};
    auto& sprites = frame.data.publish<ParticleSprites>();
    sprites.instances = scene.instances;
    sprites.gpu = &gpu;
    sprites.gpu_view = &gpu_view;
    sprites.looks = scene.looks;
    sprites.arrays = scene.arrays;
    sprites.features = scene.features;
    sprites.look_texels = &look_texels;
    look_texels.upload(*frame.ring, scene.looks);
    ribbon_texels.upload(*frame.ring, scene.ribbons.points);
    billboard_texels.upload(*frame.ring, scene.billboards.quads);
}

bool ParticleEffect::prepare(const FrameData& frame, ViewData& view) {
    auto& particles = view.data.publish<ViewParticles>();
    particles.effect = this;
    list_draws(scene, gpu, frame, view, particles.list);
    particles.texels.upload(*frame.ring, particles.list.instances);
    particles.is_lit = false;
    return !particles.list.draws.empty() || !gpu.pools().empty();
}

void ParticleEffect::draw_shared(FrameGraph& graph, const FrameData&) {
    gpu.update(graph, gpu_view);
}

void ParticlesUnderWaterEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const auto* const particles = view.data.find<ParticleEffect::ViewParticles>();
    if (particles != nullptr && !particles->list.of(SpriteLayer::Underwater).empty()) {
        particles->effect->draw_underwater(graph, view);
    }
}

void ParticleEffect::draw_underwater(FrameGraph& graph, ViewData& view) {
    add_layer(graph, view, SpriteLayer::Underwater, {});
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
    add_layers_above_water(graph, frame, view, {front.veil, true});
}

void ParticleFrontEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    if (const auto* const front = view.data.find<ParticlesInFront>()) {
        front->effect->draw_front(graph, frame, view);
    }
}

void ParticleEffect::draw_front(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    add_layers_above_water(graph, frame, view, {view.data.get<ParticlesInFront>().veil, false});
    if (view.velocity && scene.moving) {
        add_velocity(graph, view);
    }
    if (view.camera.lens.aperture_radius > 0 && scene.focused) {
        add_lens_depth(graph, view);
    }
    if (view.is(kMainViews) && gpu.collides_with_depth()) {
        remember_depth(graph, *depth_copy, view, previous_depth);
    }
}

// ---- layers ----

void ParticleEffect::create_layer_programs(gpu::Device& device) {
    const auto assign = [](auto made, auto& target) {
        if (made) {
            target = *made;
        } else {
            log_error("{}", made.error().message);
        }
    };
    if (scene.has_halves && !layer_programs) {
        assign(create_particle_layer_programs(device), layer_programs);
    }
    if (scene.has_weighted && resolve == nullptr) {
        assign(load_fullscreen(device, "particle_weighted.frag"), resolve);
    }
}

void ParticleEffect::add_layers_above_water(
    FrameGraph& graph, const FrameData& frame, ViewData& view, const Side& side) {
    create_layer_programs(*frame.device);
    for (const SpriteLayer layer :
         {SpriteLayer::Behind, SpriteLayer::Half, SpriteLayer::Splats, SpriteLayer::Front,
          SpriteLayer::Weighted}) {
        add_layer(graph, view, layer, side);
    }
}

void ParticleEffect::add_layer(
    FrameGraph& graph, ViewData& view, SpriteLayer layer, const Side& side) {
    const LayeredDraws& list = view.data.get<ViewParticles>().list;
    if (layer == SpriteLayer::Half) {
        if (scene.has_halves && layer_programs && !is_empty(list.half_window)) {
            const ParticleLayer half =
                begin_particle_layer(graph, *layer_programs, view, list.half_window);
            const Use targets[] = {cleared(half.radiance)};
            add_sprites(graph, view, layer, side, half.depth, targets);
            end_particle_layer(graph, *layer_programs, half, view);
        }
    } else if (layer == SpriteLayer::Weighted) {
        if (scene.has_weighted && resolve != nullptr && !is_empty(list.weighted_bounds)) {
            const WeightedLayers sums = create_weighted_layers(graph, view);
            const Use targets[] = {cleared(sums.sum), cleared(sums.kept, Vec4(1))};
            add_sprites(graph, view, layer, side, view.gbuffer.depth, targets);
            resolve_weighted(graph, *resolve, sums, view);
        }
    } else if (layer == SpriteLayer::Splats) {
        add_splats(graph, view);
    } else if (!list.of(layer).empty()) {
        const Use targets[] = {view.radiance};
        add_sprites(graph, view, layer, side, view.gbuffer.depth, targets);
    }
}

void ParticleEffect::add_pool_reads(FrameGraph& graph, std::vector<Use>& reads) const {
    for (const auto& [entity, pool] : gpu.pools()) {
        reads.emplace_back(
            pool->sorted ? graph.import("sorted particles", pool->sort.instances)
                         : graph.import("particles", pool->instances));
    }
}

void ParticleEffect::add_sprites(
    FrameGraph& graph, ViewData& view, SpriteLayer layer, const Side& side, TextureId depth,
    std::span<const Use> targets) {
    add_light(graph, view);
    std::vector<Use> reads =
        lighting_reads(view, {depth_tested(depth), sampled(depth, layout::kParticleDepthUnit)});
    if (const auto& particles = view.data.get<ViewParticles>(); particles.is_lit) {
        reads.emplace_back(graph.import("particles.light", particles.light));
    }
    if (side.veil) {
        reads.push_back(sampled(*side.veil, layout::kParticleVeilUnit));
    }
    add_pool_reads(graph, reads);
    graph.add_pass(
        side.behind ? layer_row(layer).pass_behind : layer_row(layer).pass,
        std::span<const Use>(reads), targets,
        [this, &view, layer, veiled = side.veil.has_value(), behind = side.behind](
            PassContext& context) { draw_layer(context, view, layer, veiled, behind); });
}

void ParticleEffect::add_splats(FrameGraph& graph, ViewData& view) {
    const std::span<const SpriteDraw> draws =
        view.data.get<ViewParticles>().list.of(SpriteLayer::Splats);
    std::size_t count = 0;
    float brightest = 0;
    std::vector<Use> reads = {sampled(view.gbuffer.depth, layout::kParticleDepthUnit)};
    for (const SpriteDraw& draw : draws) {
        count += draw.pool->count;
        brightest = std::max(brightest, max_light(scene.looks[draw.pool->look]));
        reads.emplace_back(graph.import("particles", draw.pool->instances));
    }
    if (brightest <= 0) {
        return;
    }
    const SplatPrograms of_splats = begin_particle_splats(splats, view, count, brightest);
    const Use writes[] = {graph.import("sums of particles", splats.sums)};
    graph.add_pass(
        layer_row(SpriteLayer::Splats).pass, std::span<const Use>(reads), writes,
        [this, &view, of_splats, draws](PassContext& context) {
            bind_view(context, view);
            look_texels.bind(context.device(), layout::kLooksUnit);
            for (const SpriteDraw& draw : draws) {
                if (draw.count > 0) {
                    draw.pool->texels.bind(context.device(), layout::kParticlesUnit);
                    draw_particle_splats(
                        context, of_splats, splats, *draw.pool, scene.looks[draw.pool->look]);
                }
            }
        });
    add_particle_sums(graph, splats, view);
}

// ---- light of particles that are lit at their centers ----

/// Once per view, before the first draw.
void ParticleEffect::add_light(FrameGraph& graph, ViewData& view) {
    auto& particles = view.data.publish<ViewParticles>();  // as prepare() left it
    const std::size_t count = particles.list.instances.size();
    if (particles.is_lit || !scene.lit_at_center) {
        return;
    }
    particles.is_lit = true;
    if (particles.capacity <= count) {
        particles.capacity = std::bit_ceil(count + 1);
        particles.light = gpu::Buffer(
            "light of particles", particles.capacity * sizeof(Vec4), gpu::BufferUse::GpuOnly);
        particles.light_texels.set(particles.light);
    }
    const std::vector<Use> reads = lighting_reads(view, {});
    const Use writes[] = {graph.import("particles.light", particles.light)};
    graph.add_pass(
        "particles.light", std::span(reads), writes,
        [this, &view](PassContext& context) { evaluate_light(context, view); });
}

void ParticleEffect::evaluate_light(PassContext& context, const ViewData& view) {
    const auto& particles = view.data.get<ViewParticles>();
    const gpu::Program* const program = light_programs.get(view.lighting.variant);
    if (program == nullptr) {
        return;
    }
    const int count = static_cast<int>(particles.list.instances.size());
    gpu::Device& device = context.device();
    bind_lighting(context, view);
    particles.texels.bind(device, layout::kParticlesUnit);
    look_texels.bind(device, layout::kLooksUnit);
    device.bind_storage(layout::kCenterLightBinding, particles.light);
    device.use(*program);
    program->set("count", count);
    device.dispatch(static_cast<std::uint32_t>((count + kLightGroup - 1) / kLightGroup));
}

// ---- velocity and depth of covered pixels ----

void ParticleEffect::add_velocity(FrameGraph& graph, ViewData& view) {
    std::vector<Use> reads = {
        depth_tested(view.gbuffer.depth), sampled(view.gbuffer.depth, layout::kParticleDepthUnit)};
    add_pool_reads(graph, reads);
    const Use writes[] = {view.gbuffer.velocity};
    graph.add_pass(
        "particles.velocity", std::span(reads), writes,
        [this, &view](PassContext& context) { draw_velocity(context, view); });
}

void ParticleEffect::add_lens_depth(FrameGraph& graph, ViewData& view) {
    const TextureId scene_depth = view.gbuffer.depth;
    TextureSpec spec = graph.spec(scene_depth);
    spec.name = "particles.lens depth";
    const TextureId depth = graph.create(spec);
    graph.add_pass(
        "particles.depth behind", {scene_depth}, {image(depth)},
        [scene_depth, depth](PassContext& context) {
            context.texture(scene_depth).copy_to(context.texture(depth));
        });
    std::vector<Use> reads;
    add_pool_reads(graph, reads);
    const Use writes[] = {depth};
    graph.add_pass(
        "particles.lens depth", std::span<const Use>(reads), writes,
        [this, &view](PassContext& context) { draw_lens_depth(context, view); });
    view.data.publish<LensDepth>().depth = depth;
}

// ---- draws ----

Variant ParticleEffect::sprite_variant(
    const ViewData& view, SpriteShape shape, const SpriteFeatures& features) const {
    Variant variant;
    variant.add_if(is_clipped(view), "CLIPPED");
    variant.add_if(scene.soft, "SOFT");
    if (shape == SpriteShape::Quad) {
        features.add_to(variant);
        variant.add_if(scene.has_ribbons, "RIBBONS");
        variant.add_if(scene.has_billboards, "BILLBOARDS");
    }
    return variant;
}

void ParticleEffect::draw_layer(
    PassContext& context, const ViewData& view, SpriteLayer layer, bool veiled, bool behind) {
    const LayeredDraws& list = view.data.get<ViewParticles>().list;
    const bool is_weighted = layer == SpriteLayer::Weighted;
    gpu::PipelineState state = kWeightedState;
    if (!is_weighted) {
        state.blend = gpu::kBlendPremultiplied;
        state.second_blend = {};
    }
    state.clip = is_clipped(view);
    bind_lighting(context, view);
    const float resolution = layer_row(layer).resolution;
    draw_sprites(context, view, list.of(layer), resolution, [&](const SpriteDraw& draw) {
        const SpriteShape shape = draw.shape;
        Variant variant = view.lighting.variant;
        variant.add_if(draw.lit && shape != SpriteShape::SmallDisc, "LIT");
        variant.add_if(scene.lit_at_center && shape == SpriteShape::Quad, "LIT_CENTER");
        variant.add_if(is_six_way_draw(draw), "SIX_WAY");
        variant.add_if(is_weighted, "WEIGHTED");
        variant.add_if(veiled, "VEILED");
        variant.add_if(layer == SpriteLayer::Underwater, "IN_WATER");
        variant.add(sprite_variant(view, shape, features_of(scene, layer)));
        const gpu::Program* const program = programs.find(SpritePass::Color, shape, variant);
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{program, state});
            program->set("behind", behind ? 1 : 0);
        }
        if (program != nullptr && is_weighted) {
            program->set("weight_range", weight_range(list.weighted_bounds, view.camera));
        }
        return program;
    });
}

void ParticleEffect::draw_velocity(PassContext& context, const ViewData& view) {
    // Between steps, particles are drawn on straight lines along the velocity at the step's end.
    const float step = particle_step(*view.frame);
    const float back = particle_lag(*view.frame);
    const RenderView& camera = view.camera;
    const float time = std::min(
        (camera.alpha - camera.previous_alpha) * step, static_cast<float>(view.frame->time));
    const bool crosses = time + back > 0.999f * step;  // the beginning of the step
    const float bend = crosses ? step * (back + time - 0.5f * step) : 0.0f;
    bind_view(context, view);
    const auto draws = view.data.get<ViewParticles>().list.above_water();
    draw_sprites(context, view, draws, 1, [&](const SpriteDraw& draw) {
        const gpu::Program* const program = programs.find(
            SpritePass::Velocity, draw.shape, sprite_variant(view, draw.shape, scene.features));
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
    const auto draws = view.data.get<ViewParticles>().list.above_water();
    draw_sprites(context, view, draws, 1, [&](const SpriteDraw& draw) {
        const gpu::Program* const program = programs.find(
            SpritePass::LensDepth, draw.shape, sprite_variant(view, draw.shape, scene.features));
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{program, {.cull = GL_NONE}});
        }
        return program;
    });
}

void ParticleEffect::bind_images(
    gpu::Device& device, const ViewData& view, const ParticleArrays& arrays, bool magnified) const {
    const ImagePool& pool = view.frame->materials->images();
    const gpu::Sampler& sampler = magnified ? finest_sampler : image_sampler;
    if (scene.features.images) {
        device.bind_texture(layout::kSpriteImagesUnit, pool.array(arrays.images), &sampler);
    }
    if (scene.features.motions) {
        device.bind_texture(
            layout::kSpriteMotionsUnit, pool.array(arrays.motions), &finest_sampler);
    }
    if (arrays.negative_lights != 0) {
        device.bind_texture(
            layout::kNegativeLightsUnit, pool.array(arrays.negative_lights), &sampler);
    }
}

/// Calls `use(draw)` to bind the program of a draw; it returns the program, or null.
template <typename Use>
void ParticleEffect::draw_sprites(
    PassContext& context, const ViewData& view, std::span<const SpriteDraw> draws, float resolution,
    Use&& use) {
    gpu::Device& device = context.device();
    const float framed = set_wide_viewport(context);
    const auto& particles = view.data.get<ViewParticles>();
    if (particles.is_lit) {
        particles.light_texels.bind(device, layout::kCenterLightUnit);
    }
    look_texels.bind(device, layout::kLooksUnit);
    ribbon_texels.bind(device, layout::kRibbonPointsUnit);
    billboard_texels.bind(device, layout::kBillboardQuadsUnit);
    const gpu::Program* program = nullptr;
    std::optional<SpriteDraw> last;
    const auto draw_one = [&](const SpriteDraw& draw) {
        const bool same_program = last && last->shape == draw.shape && last->lit == draw.lit
                                  && is_six_way_draw(*last) == is_six_way_draw(draw);
        if (!last || last->pool != draw.pool) {
            const GpuParticlePool* const pool = draw.pool;
            (pool == nullptr ? particles.texels
             : pool->sorted  ? pool->sort.texels
                             : pool->texels)
                .bind(device, layout::kParticlesUnit);
        }
        program = same_program ? program : use(draw);
        last = draw;
        if (program == nullptr) {
            return;
        }
        program->set("first", draw.first);
        program->set("framed", framed);
        program->set("resolution", resolution);
        bind_images(device, view, draw.arrays, draw.magnified);
        draw_shape(device, draw.shape, draw.count);
    };
    for (const SpriteDraw& draw : draws) {
        draw_one(draw);
        if (view.frame->warm_up && draw.pool == nullptr && draw.shape != SpriteShape::Point) {
            for (const SpriteDraw& other : alternatives_of(draw)) {
                draw_one(other);
            }
        }
    }
}

}  // namespace limn
