#include "render/passes/particle_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/beam.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/instance_list.h"
#include "render/lens_depth.h"
#include "render/lighting.h"
#include "render/material_pool.h"
#include "render/particle_weighted.h"
#include "render/surface_draws.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <utility>

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
constexpr std::uint32_t kSortPasses = 4;    // a frame, of an amortized sort (Latta 2004)
constexpr float kMaxPoint = 4;              // [px] across, above which a disc is drawn as a quad
constexpr std::uint32_t kMaxLooks = 65536;  // that an instance can name
constexpr Bounds kAnywhere = {Vec3(-INFINITY), Vec3(INFINITY)};

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

/// As an entity is seen; none without a transform.
std::optional<Affine> pose_of(const World& world, Entity entity, float alpha) {
    const auto* const now = world.find<WorldTransform>(entity);
    const auto* const before = world.find<PreviousWorldTransform>(entity);
    if (now == nullptr) {
        return std::nullopt;
    }
    return mix_affine(before != nullptr ? before->world : now->world, now->world, alpha);
}

std::optional<Vec3> place_of(const World& world, Entity entity, float alpha) {
    const std::optional<Affine> pose = pose_of(world, entity, alpha);
    return pose ? std::optional(transform_point(*pose, Vec3(0))) : std::nullopt;
}

/// What only adds light needs no weights.
LookLayer layer_of(const ParticleLook& look) {
    return look.sort == ParticleSort::Weighted && look.cover > 0 ? LookLayer::Weighted
           : look.resolution == ParticleResolution::Half         ? LookLayer::Half
                                                                 : LookLayer::Full;
}

/// Passes of a sort on the GPU a frame, 0: all; none for particles that need no order.
std::optional<std::uint32_t> sort_passes(const ParticleLook& look) {
    if (look.sort == ParticleSort::Births || look.sort == ParticleSort::Weighted
        || look.cover <= 0) {
        return std::nullopt;
    }
    return look.sort == ParticleSort::Amortized ? kSortPasses : 0;
}

/// One for `stride` particles: their area in one.
ParticleLook enlarged(ParticleLook look, std::uint32_t stride) {
    const float factor = std::sqrt(static_cast<float>(stride));
    look.size *= factor;
    look.size_spread *= factor;
    look.stretch *= factor;
    return look;
}

void append_births_of(
    const World& world, Entity emitter, const Trail& trail, float back, float alpha,
    RibbonList& ribbons) {
    const auto* const pool = world.find<ParticlePool>(emitter);
    const auto* const settings = world.find<ParticleEmitter>(emitter);
    if (pool == nullptr) {
        return;
    }
    const bool grows = settings != nullptr && settings->active && settings->rate > 0;
    const std::optional<Vec3> head = place_of(world, emitter, alpha);
    append_births(trail, *pool, back, grows && head ? &*head : nullptr, ribbons);
}

}  // namespace

float particle_step(const FrameData& frame) {
    const auto* const time = frame.world->find_resource<FrameTime>();
    return time != nullptr ? time->step : FrameTime{}.step;
}

float particle_lag(const FrameData& frame) {
    return (1.0f - frame.camera.alpha) * particle_step(frame);
}

Vec3 entity_velocity(const World& world, Entity entity, float step) {
    const auto* const now = world.find<WorldTransform>(entity);
    const auto* const previous = world.find<PreviousWorldTransform>(entity);
    if (now == nullptr || previous == nullptr || step <= 0 || is_cut(previous->world, now->world)) {
        return Vec3(0);
    }
    return (transform_point(now->world, Vec3(0)) - transform_point(previous->world, Vec3(0)))
           / step;
}

Result<ParticleEffect> ParticleEffect::create(gpu::Device& device, const RenderSettings&) {
    ParticleEffect effect{
        ProgramVariants(device, {.vertex = "particle.vert", .fragment = "particle.frag"}),
        ProgramVariants(device, {.vertex = "particle.vert", .fragment = "particle_velocity.frag"}),
        ProgramVariants(device, {.vertex = "particle.vert", .fragment = "particle_focus.frag"}),
        ProgramVariants::of_meshes(device, "depth_first.frag")};
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

std::uint32_t ParticleEffect::add_look(
    const FrameData& frame, const ParticleLook& look, std::optional<Vec3> place) {
    const bool has_image = frame.assets->images.size() > look.image.index;
    const ImageLayer image = has_image ? frame.materials->images().find(look.image) : ImageLayer{};
    const ImageLayer motion = frame.materials->images().find(look.motion);
    const ImageLayer negative = frame.materials->images().find(look.negative_light);
    const bool has_motion = has_image && motion.array != 0;
    const bool is_six_way = has_image && negative.array != 0;
    const auto layer_if = [](bool has, const ImageLayer& its) {
        return has ? static_cast<int>(its.layer) : -1;
    };
    looks.push_back(make_look_record(
        look, {.image = layer_if(has_image, image),
               .motion = layer_if(has_motion, motion),
               .negative_light = layer_if(is_six_way, negative)}));
    arrays.push_back(
        {.images = image.array,
         .motions = has_motion ? motion.array : 0,
         .negative_lights = is_six_way ? negative.array : 0});
    places.push_back(place);
    extents.push_back(make_look_extent(look));
    extents.back().texels = 0;
    if (has_image) {
        const ImageData& its = frame.assets->images[look.image.index];
        extents.back().texels = std::max(
            static_cast<float>(its.width) / static_cast<float>(look.columns),
            static_cast<float>(its.height) / static_cast<float>(look.rows));
    }
    layers.push_back(layer_of(look));
    has_halves = has_halves || layers.back() == LookLayer::Half;
    has_weighted = has_weighted || layers.back() == LookLayer::Weighted;
    lit = lit || look.lit > 0;
    features.images = features.images || has_image;
    features.flipbooks = features.flipbooks || look.columns > 1 || look.rows > 1;
    features.motions = features.motions || has_motion;
    features.six_way = features.six_way || is_six_way;
    soft = soft || look.softness > 0;
    moving = moving || moves_pixels(looks.back());
    focused = focused || look.velocity_cover < 1;
    return static_cast<std::uint32_t>(looks.size() - 1);
}

/// What bends the ways of an emitter's particles, gusts apart.
void ParticleEffect::add_pull(const World& world, Entity emitter, std::uint32_t look) {
    if (const auto* const motion = world.find<ParticleMotion>(emitter)) {
        constexpr float kGravity = 9.81f;  // [m/s^2]
        const Vec3 at_rest = Vec3(0, -kGravity * motion->gravity, 0) + motion->drag * motion->wind;
        looks[look][layout::kLookMotion + 1] = Vec4(at_rest, motion->drag);
    }
}

void ParticleEffect::collect_ribbons(const FrameData& frame, float back, float step) {
    const World& world = *frame.world;
    const auto add_segments = [&](const ParticleLook& look) {
        has_ribbons = true;
        const std::uint32_t index = add_look(frame, look);
        looks[index][2].w = static_cast<float>(layout::kFacingRibbon);
        looks[index][layout::kLookMotion].x = -1;  // its image goes on beyond the frame
        looks[index][layout::kLookMotion].w = -1;
        extents[index] = {};
        for (const std::uint32_t before : ribbons.segments) {
            const Vec3 middle =
                0.5f * (ribbons.points[before + 1].position + ribbons.points[before + 2].position);
            instances.push_back(
                {.position = middle, .look_and_share = index << 16, .velocity_xy = before});
        }
        ribbons.segments.clear();
    };
    world.query<const Trail, const ParticleLook, Optional<const TrailState>>().each(
        [&](Entity entity, const Trail& trail, const ParticleLook& look, const TrailState* state) {
            if (looks.size() >= kMaxLooks) {
                return;
            }
            ribbons.width = max_width(look);
            const Entity followed = trail.emitter.is_null() ? entity : trail.emitter;
            if (trail.path == TrailPath::Births) {
                append_births_of(world, followed, trail, back, frame.camera.alpha, ribbons);
            } else if (state != nullptr) {
                append_trail(trail, *state, back, step, ribbons);
            }
            add_segments(look);
        });
    world.query<const Beam, const ParticleLook, const BeamState>().each(
        [&](Entity entity, const Beam& beam, const ParticleLook& look, const BeamState& state) {
            if (looks.size() < kMaxLooks) {
                ribbons.width = max_width(look);
                append_beam(beam, state, entity, frame.camera.alpha, frame.time, ribbons);
                add_segments(look);
            }
        });
}

void ParticleEffect::collect_billboards(const FrameData& frame, float back) {
    const auto add_once = [&](const ParticleLook& look) {
        const std::uint32_t index = add_look(frame, look);
        looks[index][2].w = static_cast<float>(layout::kFacingBillboard);
        looks[index][layout::kLookMore + 1].w = 0;  // no life to fade at the end of
        const bool is_repeated = index > 0 && looks[index] == looks[index - 1]
                                 && arrays[index] == arrays[index - 1]
                                 && extents[index].culling == extents[index - 1].culling;
        if (!is_repeated) {
            extents[index].radius = extents[index].stretch = 0;
            return index;
        }
        looks.pop_back();
        arrays.pop_back();
        layers.pop_back();
        places.pop_back();
        extents.pop_back();
        return index - 1;
    };
    const World& world = *frame.world;
    world.query<const Billboard, const ParticleLook>().each([&](Entity entity,
                                                                const Billboard& billboard,
                                                                const ParticleLook& look) {
        const std::optional<Affine> pose = pose_of(world, entity, frame.camera.alpha);
        const std::size_t first = billboards.quads.size();
        const Vec3 velocity = entity_velocity(world, entity, particle_step(frame));
        const std::uint32_t random = entity.index * 0x9e3779b9u;
        if (!pose || looks.size() + 2 > kMaxLooks) {
            return;
        }
        const double time = std::max(billboard.time - static_cast<double>(back), 0.0);
        append_billboard(billboard, look, *pose, time, random, billboards);
        for (std::size_t i = first; i < billboards.quads.size(); ++i) {
            const BillboardPlace& place = billboards.places[i];
            BillboardQuad& quad = billboards.quads[i];
            quad.velocity = velocity;
            ParticleLook its = look;
            if (place.is_section) {
                its.image = billboard.section;
                its.columns = its.rows = 1;
            }
            its.culling = ParticleCulling::Particles;
            const std::uint32_t index = add_once(its);
            extents[index].radius = std::max(
                extents[index].radius,
                glm::length(quad.right) + glm::length(quad.up) + look.cull_margin);
            instances.push_back(
                {.position = place.position,
                 .look_and_share = index << 16 | static_cast<std::uint32_t>(place.share * 65535.0f),
                 .velocity_xy = static_cast<std::uint32_t>(i),
                 .velocity_z_age = std::bit_cast<std::uint32_t>(std::max(place.opacity, 0.0f)),
                 .random = random});
        }
    });
    has_billboards = !billboards.quads.empty();
}

/// For a warm-up, whose image nobody sees: a particle for each program that some look needs.
void ParticleEffect::append_one_of_each() {
    std::set<std::pair<LookLayer, bool>> made;
    for (std::uint32_t i = 0; i < looks.size(); ++i) {
        if (made.emplace(layers[i], is_point(looks[i])).second) {
            auto& its = layers[i] == LookLayer::Weighted ? weighted : instances;
            its.emplace_back().look_and_share = i << 16;
        }
    }
}

void ParticleEffect::collect(FrameData& frame) {
    const World& world = *frame.world;
    const float step = particle_step(frame);
    const float back = particle_lag(frame);
    const Vec3 eye_velocity = entity_velocity(world, frame.camera.entity, step);
    looks.clear();
    arrays.clear();
    places.clear();
    layers.clear();
    instances.clear();
    weighted.clear();
    ribbons.clear();
    billboards.quads.clear();
    billboards.places.clear();
    extents.clear();
    waters.clear();
    world.query<const Water, const WorldTransform>().each(
        [&](const Water& water, const WorldTransform& its) {
            waters.push_back({&water, water_frame(its.world)});
        });
    features = {};
    lit = soft = moving = focused = has_ribbons = has_billboards = has_halves = has_weighted =
        false;
    const float alpha = frame.camera.alpha;
    const auto shape_in_world = [&](Entity entity) {
        const auto* const emitter = world.find<ParticleEmitter>(entity);
        const std::optional<Affine> pose = pose_of(world, entity, alpha);
        return emitter != nullptr && pose ? shape_bounds(*emitter, *pose) : Bounds{};
    };
    world.query<const ParticleLook, const ParticlePool, Optional<const Trail>>().each(
        [&](Entity entity, const ParticleLook& look, const ParticlePool& particles,
            const Trail* trail) {
            const bool is_ribbon =
                trail != nullptr && trail->path == TrailPath::Births && trail->emitter.is_null();
            if (looks.size() < kMaxLooks && !is_ribbon) {
                std::optional<Vec3> place;
                if (look.sort == ParticleSort::Births) {
                    place = place_of(world, entity, alpha);
                }
                const std::uint32_t index = add_look(frame, look, place);
                auto& its = layers[index] == LookLayer::Weighted ? weighted : instances;
                const std::size_t first = its.size();
                add_pull(world, entity, index);
                append_particles(particles, index, back, its, look.camera_streak * eye_velocity);
                if (look.culling == ParticleCulling::Bounds) {
                    extents[index].group = bounds_of(std::span(its).subspan(first));
                } else if (look.culling == ParticleCulling::Emitter) {
                    extents[index].group = shape_in_world(entity);
                }
            }
        });
    const auto* const rendering = world.find_resource<Rendering>();
    const std::uint32_t stride =
        particle_stride(rendering != nullptr ? rendering->particle_share : 1);
    gpu.begin_frame(world);
    world
        .query<
            const ParticleLook, const ParticleEmitter, const GpuParticles,
            Optional<const ParticleCollision>>()
        .each([&](Entity entity, const ParticleLook& look, const ParticleEmitter& emitter,
                  const GpuParticles& particles, const ParticleCollision* collision) {
            if (looks.size() < kMaxLooks) {
                const std::uint32_t index = add_look(frame, enlarged(look, stride));
                add_pull(world, entity, index);
                gpu.add(
                    frame, entity, emitter, particles, index, sort_passes(look), collision, stride);
                if (look.culling == ParticleCulling::Emitter) {
                    extents[index].group = shape_in_world(entity);
                }
                const std::optional<Affine> pose = pose_of(world, entity, alpha);
                if (layers[index] == LookLayer::Weighted && pose) {
                    extents[index].ways = bounds_of_ways(emitter, *pose);
                }
            }
        });
    gpu.forget_unused();
    collect_ribbons(frame, back, step);
    collect_billboards(frame, back);
    if (frame.warm_up) {
        append_one_of_each();
    }

    const Affine& camera = frame.camera.world_from_camera;
    gpu_view = {
        .back = back,
        .eye = transform_point(camera, Vec3(0)),
        .forward = transform_vector(camera, Vec3(0, 0, -1)),
        .seen = gpu.meets_depth() ? recall_depth(seen_depth, frame) : SeenDepth{}};
    order_by_distance(instances, places, gpu_view.eye, gpu_view.forward, order);
    sorted.clear();
    for (const std::uint32_t i : order.indices) {
        sorted.push_back(instances[i]);
    }
    sorted.insert(sorted.end(), weighted.begin(), weighted.end());
    instances.insert(instances.end(), weighted.begin(), weighted.end());
    auto& sprites = frame.data.publish<ParticleSprites>();
    sprites.instances = instances;
    sprites.gpu = &gpu;
    sprites.gpu_view = &gpu_view;
    sprites.looks = looks;
    sprites.arrays = arrays;
    sprites.features = features;
    sprites.look_texels = &look_texels;
    look_texels.upload(*frame.ring, looks);
    ribbon_texels.upload(*frame.ring, ribbons.points);
    billboard_texels.upload(*frame.ring, billboards.quads);
}

bool ParticleEffect::prepare(const FrameData& frame, ViewData& view) {
    auto& seen = view.data.publish<ViewParticles>();
    seen.instances.clear();
    seen.runs.clear();
    seen.half_bounds = {};
    seen.weighted_bounds = {};
    seen.half_begin = 0;
    seen.effect = this;
    const Frustum frustum = make_frustum(view.camera.clip_from_world);
    cull_particles(sorted, extents, frustum, visible);
    if (frame.warm_up) {
        visible.assign(sorted.size(), 1);
    }
    std::size_t middle = 0;
    if (has_halves) {
        middle = middle_half();
        append_runs(view.camera, LookLayer::Full, 0, middle, seen);
        seen.half_begin = seen.runs.size();
        append_runs(view.camera, LookLayer::Half, 0, sorted.size(), seen);
        for (const auto& [entity, pool] : gpu.pools()) {
            grow(seen.half_bounds, layers[pool->look] == LookLayer::Half ? kAnywhere : Bounds{});
        }
    }
    seen.half_end = seen.runs.size();
    append_runs(view.camera, LookLayer::Full, middle, sorted.size(), seen);
    seen.weighted_begin = seen.runs.size();
    append_runs(
        view.camera, LookLayer::Weighted, sorted.size() - weighted.size(), sorted.size(), seen);
    for (const auto& [entity, pool] : gpu.pools()) {
        grow(
            seen.weighted_bounds,
            layers[pool->look] == LookLayer::Weighted ? extents[pool->look].ways : Bounds{});
    }
    append_under_water(frame, view, seen);
    seen.texels.upload(*frame.ring, seen.instances);
    return !seen.runs.empty() || !gpu.pools().empty();
}

/// Of those that are visible and drawn at half the resolution, the index of the middle one in the
/// order; 0 without one.
std::size_t ParticleEffect::middle_half() const {
    const auto is_seen_half = [&](std::size_t i) {
        return visible[i] != 0 && layers[sorted[i].look_and_share >> 16] == LookLayer::Half;
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        count += is_seen_half(i) ? 1 : 0;
    }
    std::size_t rank = count / 2;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (is_seen_half(i) && rank-- == 0) {
            return i;
        }
    }
    return 0;
}

/// Discs fit any arrays.
bool ParticleEffect::fits(const ParticleRun& run, std::uint32_t look) const {
    const bool is_disc = looks[look][3].w < 0;
    const Vec4& its = looks[look][layout::kLookMotion];
    const bool is_still = its.x < 0;
    const bool is_flat = its.w < 0;
    return (run.shape == SpriteShape::Point) == is_point(looks[look])
           && (is_disc || run.arrays.images == arrays[look].images)
           && (is_still || run.arrays.motions == arrays[look].motions)
           && (is_flat || run.arrays.negative_lights == arrays[look].negative_lights);
}

void ParticleEffect::append_instance(
    const RenderView& camera, std::size_t index, float scale, std::size_t first_run,
    ViewParticles& seen) {
    const ParticleInstance& instance = sorted[index];
    const std::uint32_t look = instance.look_and_share >> 16;
    if (seen.runs.size() == first_run || !fits(seen.runs.back(), look)) {
        seen.runs.push_back(
            {.arrays = arrays[look],
             .shape = is_point(looks[look]) ? SpriteShape::Point : SpriteShape::SmallDisc,
             .magnified = true,
             .first = static_cast<int>(seen.instances.size()),
             .count = 0});
    }
    ParticleRun& run = seen.runs.back();
    const float texels = extents[look].texels;
    const float pixels = scale * least_pixels(instance, looks[look], camera);
    const bool is_small_disc =
        texels == 0 && looks[look][2].y == 0 && pixels > 0 && pixels <= kMaxPoint;
    run.magnified = run.magnified && (texels == 0 || pixels > 0.999f * texels);
    if (run.shape == SpriteShape::SmallDisc && !is_small_disc) {
        run.shape = SpriteShape::Quad;
    }
    ++run.count;
    seen.instances.push_back(instance);
}

/// Those of this layer in [first, last) that are visible, from back to front.
void ParticleEffect::append_runs(
    const RenderView& camera, LookLayer layer, std::size_t first, std::size_t last,
    ViewParticles& seen) {
    const float scale = layer == LookLayer::Half ? 0.5f : 1.0f;
    const std::size_t first_run = seen.runs.size();
    for (std::size_t i = first; i < last; ++i) {
        const std::uint32_t look = sorted[i].look_and_share >> 16;
        if (visible[i] == 0 || layers[look] != layer) {
            continue;
        }
        append_instance(camera, i, scale, first_run, seen);
        if (layer == LookLayer::Half) {
            grow(seen.half_bounds, bounds_of(sorted[i], looks[look]));
        } else if (layer == LookLayer::Weighted) {
            grow(seen.weighted_bounds, {sorted[i].position, sorted[i].position});
        }
    }
}

/// Below the rest level of some water, wherever its waves are.
bool ParticleEffect::is_under_water(const Vec3& place) const {
    return std::any_of(waters.begin(), waters.end(), [&](const WaterBody& body) {
        const Vec3 local = body.frame.local(place);
        return local.y < 0 && is_inside(*body.water, {local.x, local.z});
    });
}

/// Whatever their layer, at full resolution; none where the camera is in the water, too.
void ParticleEffect::append_under_water(
    const FrameData& frame, const ViewData& view, ViewParticles& seen) {
    seen.under_begin = seen.runs.size();
    if (waters.empty() || is_clipped(view)
        || is_under_water(transform_point(view.camera.world_from_camera, Vec3(0)))) {
        return;
    }
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (visible[i] != 0 && (frame.warm_up || is_under_water(sorted[i].position))) {
            append_instance(view.camera, i, 1, seen.under_begin, seen);
        }
    }
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
    const auto* const seen = view.data.find<ParticleEffect::ViewParticles>();
    if (seen != nullptr && seen->under_begin < seen->runs.size()) {
        seen->effect->draw_under_water(graph, view);
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
    FrameGraph& graph, ViewData& view, const char* name, TextureId depth,
    std::span<const Use> targets, Part part, const std::optional<TextureId>& veil, bool behind) {
    std::vector<Use> reads =
        lighting_reads(view, {depth_tested(depth), sampled(depth, kSceneDepthUnit)});
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
    const auto& seen = view.data.get<ViewParticles>();
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
    if (has_halves && layer_programs && !is_empty(seen.half_bounds)) {
        const ParticleLayer layer =
            begin_particle_layer(graph, *layer_programs, view, seen.half_bounds);
        add_pass(
            "particles.half", "particles.veiled half", layer.depth, {cleared(layer.radiance)},
            Part::Half);
        end_particle_layer(graph, *layer_programs, layer, view);
    }
    add_pass("particles", "particles.veiled", view.gbuffer.depth, {view.radiance}, Part::Front);
    if (has_weighted && resolve != nullptr && !is_empty(seen.weighted_bounds)) {
        const WeightedLayers mixed = create_weighted_layers(graph, view);
        add_pass(
            "particles.weighted", "particles.veiled weighted", view.gbuffer.depth,
            {cleared(mixed.sum), cleared(mixed.kept, Vec4(1))}, Part::Weighted);
        resolve_weighted(graph, *resolve, mixed, view);
    }
}

void ParticleEffect::draw_front(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    add_layers(graph, frame, view, false);
    if (view.velocity && moving) {
        std::vector<Use> reads = {
            depth_tested(view.gbuffer.depth), sampled(view.gbuffer.depth, kSceneDepthUnit)};
        add_pool_reads(graph, reads);
        const Use writes[] = {view.gbuffer.velocity};
        graph.add_pass(
            "particles.velocity", std::span(reads), writes,
            [this, &view](PassContext& context) { draw_velocity(context, view); });
    }
    if (view.camera.lens.aperture_radius > 0 && focused) {
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
    if (has_halves && !layer_programs) {
        assign(create_particle_layer_programs(device), layer_programs);
    }
    if (has_weighted && resolve == nullptr) {
        assign(load_fullscreen(device, "particle_weighted.frag"), resolve);
    }
}

Variant ParticleEffect::sprite_variant(const ViewData& view, SpriteShape shape) const {
    Variant variant;
    variant.add_if(is_clipped(view), "CLIPPED");
    variant.add_if(soft, "SOFT");
    if (shape != SpriteShape::Quad) {
        variant.add("POINTS");
        return variant;
    }
    features.add_to(variant);
    variant.add_if(has_ribbons, "RIBBONS");
    variant.add_if(has_billboards, "BILLBOARDS");
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
    draw_runs(context, view, Part::All, [&](SpriteShape shape) {
        Variant variant("VELOCITY");
        variant.add(sprite_variant(view, shape));
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
    draw_runs(context, view, Part::All, [&](SpriteShape shape) {
        Variant variant("FOCUS");
        variant.add(sprite_variant(view, shape));
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
    draw_runs(context, view, part, [&](SpriteShape shape) {
        Variant variant = view.lighting.variant;
        variant.add_if(lit && shape != SpriteShape::SmallDisc, "LIT");
        variant.add_if(features.six_way && shape == SpriteShape::Quad, "SIX_WAY");
        variant.add_if(is_weighted, "WEIGHTED");
        variant.add_if(veiled, "VEILED");
        variant.add(sprite_variant(view, shape));
        const gpu::Program* const program = programs.get(variant);
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{program, state});
            program->set("behind", behind ? 1 : 0);
        }
        if (program != nullptr && is_weighted) {
            const auto& seen = view.data.get<ViewParticles>();
            program->set("weight_range", weight_range(seen.weighted_bounds, view.camera));
        }
        return program;
    });
}

/// `use(shape)` uses the program for it and returns it, or null.
template <typename Use>
void ParticleEffect::draw_runs(PassContext& context, const ViewData& view, Part part, Use&& use) {
    gpu::Device& device = context.device();
    const float framed = set_wide_viewport(context);
    const auto& seen = view.data.get<ViewParticles>();
    seen.texels.bind(device, kParticlesUnit);
    look_texels.bind(device, kLooksUnit);
    ribbon_texels.bind(device, kRibbonsUnit);
    billboard_texels.bind(device, kBillboardsUnit);
    const auto bind_images = [&](const ParticleArrays& its, bool magnified) {
        const ImagePool& pool = view.frame->materials->images();
        const gpu::Sampler& sampler = magnified ? finest_sampler : image_sampler;
        if (features.images) {
            device.bind_texture(kImagesUnit, pool.array(its.images), &sampler);
        }
        if (features.motions) {
            device.bind_texture(kMotionsUnit, pool.array(its.motions), &finest_sampler);
        }
        if (features.six_way) {
            device.bind_texture(kNegativeLightsUnit, pool.array(its.negative_lights), &sampler);
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
    std::optional<SpriteShape> shape;
    const auto draw_run = [&](const ParticleRun& run) {
        program = shape == run.shape ? program : use(run.shape);
        shape = run.shape;
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
        }
    }
    const Frustum frustum = make_frustum(view.camera.clip_from_world);
    for (const auto& [entity, pool] : gpu.pools()) {
        const std::uint32_t count = pool->sorted ? pool->sort.count : pool->count;
        const LookLayer layer = layers[pool->look];
        const Part its = layer == LookLayer::Half       ? Part::Half
                         : layer == LookLayer::Weighted ? Part::Weighted
                                                        : Part::Front;
        if (count > 0 && (its == part || part == Part::All)
            && is_group_in_view(extents[pool->look], frustum)) {
            (pool->sorted ? pool->sort.texels : pool->texels).bind(device, kParticlesUnit);
            draw_run(
                {.arrays = arrays[pool->look],
                 .shape = is_point(looks[pool->look]) ? SpriteShape::Point : SpriteShape::Quad,
                 .count = static_cast<int>(count)});
        }
    }
}

}  // namespace limn
