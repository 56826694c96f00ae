#include "render/passes/particle_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/beam.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/lighting.h"
#include "render/material_pool.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limn {
namespace {

constexpr unsigned kImagesUnit = 0;
constexpr unsigned kParticlesUnit = 2;
constexpr unsigned kLooksUnit = 3;
constexpr unsigned kSceneDepthUnit = 4;
constexpr unsigned kRibbonsUnit = 8;
constexpr std::uint32_t kSortPasses = 4;    // a frame, of an amortized sort (Latta 2004)
constexpr std::uint32_t kMaxLooks = 65536;  // that an instance can name

float max_width(const ParticleLook& look) {
    float factor = look.size_curve.empty() ? 1.0f : 0.0f;
    for (const CurveKey& key : look.size_curve) {
        factor = std::max(factor, key.value);
    }
    return look.size * factor;
}

/// Where an entity is seen; none without a transform.
std::optional<Vec3> place_of(const World& world, Entity entity, float alpha) {
    const auto* const now = world.find<WorldTransform>(entity);
    const auto* const before = world.find<PreviousWorldTransform>(entity);
    if (now == nullptr) {
        return std::nullopt;
    }
    const Affine& from = before != nullptr ? before->world : now->world;
    return transform_point(mix_affine(from, now->world, alpha), Vec3(0));
}

/// Passes of a sort on the GPU a frame, 0: all; none for particles that need no order.
std::optional<std::uint32_t> sort_passes(const ParticleLook& look) {
    if (look.sort == ParticleSort::Births || look.cover <= 0) {
        return std::nullopt;
    }
    return look.sort == ParticleSort::Amortized ? kSortPasses : 0;
}

constexpr Bounds kAnywhere = {Vec3(-INFINITY), Vec3(INFINITY)};

/// Where it may be seen.
Bounds bounds_of(const ParticleInstance& instance, const LookRecord& look) {
    const float facing = look[2].w;
    const bool is_quad = facing == static_cast<float>(ParticleFacing::Camera)
                         || facing == static_cast<float>(ParticleFacing::Ground);
    const Vec3& p = instance.position;
    const float reach = reach_of(instance, look);
    const bool is_finite = std::isfinite(p.x + p.y + p.z + reach);
    return is_quad && is_finite ? Bounds{p - reach, p + reach} : kAnywhere;
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

Vec3 camera_velocity(const World& world, Entity camera, float step) {
    const auto* const now = world.find<WorldTransform>(camera);
    const auto* const previous = world.find<PreviousWorldTransform>(camera);
    if (now == nullptr || previous == nullptr || step <= 0 || is_cut(previous->world, now->world)) {
        return Vec3(0);
    }
    return (transform_point(now->world, Vec3(0)) - transform_point(previous->world, Vec3(0)))
           / step;
}

void order_by_distance(
    const std::vector<ParticleInstance>& instances, std::span<const std::optional<Vec3>> places,
    const Vec3& eye, const Vec3& forward, DistanceOrder& order) {
    order.keys.resize(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const std::uint32_t look = instances[i].look_and_share >> 16;
        const Vec3 place =
            look < places.size() && places[look] ? *places[look] : instances[i].position;
        order.keys[i] = depth_key(glm::dot(place - eye, forward));
    }
    order.indices.resize(instances.size());
    std::iota(order.indices.begin(), order.indices.end(), 0u);
    sort_by_depth(order.keys, order.indices, order.scratch);
}

Result<ParticleEffect> ParticleEffect::create(gpu::Device& device, const RenderSettings&) {
    ParticleEffect effect{
        ProgramVariants(device, {.vertex = "particle.vert", .fragment = "particle.frag"})};
    effect.gpu = LIMN_TRY(GpuParticlePools::create(device));
    return effect;
}

bool ParticleEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const ParticleLook>().empty();
}

std::uint32_t ParticleEffect::add_look(
    const FrameData& frame, const ParticleLook& look, std::optional<Vec3> place) {
    const bool has_image = frame.assets->images.size() > look.image.index;
    const ImageLayer image = has_image ? frame.materials->images().find(look.image) : ImageLayer{};
    looks.push_back(make_look_record(look, has_image ? static_cast<int>(image.layer) : -1));
    arrays.push_back(image.array);
    places.push_back(place);
    halves.push_back(look.resolution == ParticleResolution::Half ? 1 : 0);
    has_halves = has_halves || halves.back() != 0;
    lit = lit || look.lit > 0;
    images = images || has_image;
    return static_cast<std::uint32_t>(looks.size() - 1);
}

void ParticleEffect::collect_ribbons(const FrameData& frame, float back, float step) {
    const World& world = *frame.world;
    const auto add_segments = [&](const ParticleLook& look) {
        has_ribbons = true;
        const std::uint32_t index = add_look(frame, look);
        looks[index][2].w = static_cast<float>(layout::kFacingRibbon);
        for (const std::uint32_t before : ribbons.segments) {
            const Vec3 middle =
                0.5f * (ribbons.points[before + 1].position + ribbons.points[before + 2].position);
            instances.push_back(
                {.position = middle, .look_and_share = index << 16, .velocity_and_age = before});
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

void ParticleEffect::collect(FrameData& frame) {
    const World& world = *frame.world;
    const float step = particle_step(frame);
    const float back = particle_lag(frame);
    const Vec3 eye_velocity = camera_velocity(world, frame.camera.entity, step);
    looks.clear();
    arrays.clear();
    places.clear();
    halves.clear();
    instances.clear();
    ribbons.clear();
    lit = images = has_ribbons = has_halves = false;
    const float alpha = frame.camera.alpha;
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
                append_particles(
                    particles, add_look(frame, look, place), back, instances,
                    look.camera_streak * eye_velocity);
            }
        });
    gpu.begin_frame(world);
    world.query<const ParticleLook, const ParticleEmitter, const GpuParticles>().each(
        [&](Entity entity, const ParticleLook& look, const ParticleEmitter& emitter,
            const GpuParticles& particles) {
            if (looks.size() < kMaxLooks) {
                gpu.add(
                    frame, entity, emitter, particles, add_look(frame, look), sort_passes(look));
            }
        });
    gpu.forget_unused();
    collect_ribbons(frame, back, step);
    if (frame.warm_up && instances.empty() && !looks.empty()) {
        instances.emplace_back();  // drawn with size 0 or transparent: compiles the program
    }

    const Affine& camera = frame.camera.world_from_camera;
    order_by_distance(
        instances, places, transform_point(camera, Vec3(0)),
        transform_vector(camera, Vec3(0, 0, -1)), order);
    sorted.clear();
    runs.clear();
    if (has_halves) {
        half_bounds = {};
        append_runs(true);
        for (const auto& [entity, pool] : gpu.pools()) {
            grow(half_bounds, halves[pool->look] != 0 ? kAnywhere : Bounds{});
        }
    }
    half_runs = runs.size();
    append_runs(false);
    auto& sprites = frame.data.publish<ParticleSprites>();
    sprites.instances = instances;
    sprites.looks = looks;
    sprites.arrays = arrays;
    sprites.look_texels = &look_texels;
    particle_texels.upload(*frame.ring, sorted);
    look_texels.upload(*frame.ring, looks);
    ribbon_texels.upload(*frame.ring, ribbons.points);
}

/// Of the looks of this resolution, from back to front.
void ParticleEffect::append_runs(bool half) {
    const std::size_t first_run = runs.size();
    for (const std::uint32_t i : order.indices) {
        const std::uint32_t look = instances[i].look_and_share >> 16;
        if ((halves[look] != 0) != half) {
            continue;
        }
        // Discs fit any array.
        const bool is_disc = looks[look][3].w < 0;
        if (runs.size() == first_run || (!is_disc && runs.back().array != arrays[look])) {
            runs.push_back(
                {.array = arrays[look], .first = static_cast<int>(sorted.size()), .count = 0});
        }
        ++runs.back().count;
        sorted.push_back(instances[i]);
        if (half) {
            grow(half_bounds, bounds_of(instances[i], looks[look]));
        }
    }
}

void ParticleEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    const Affine& camera = frame.camera.world_from_camera;
    gpu.update(
        graph, particle_lag(frame), transform_point(camera, Vec3(0)),
        transform_vector(camera, Vec3(0, 0, -1)));
}

void ParticleEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    if (runs.empty() && gpu.pools().empty()) {
        return;
    }
    const auto add_pass = [&](const char* name, TextureId depth, const Use& target, bool half) {
        std::vector<Use> reads =
            lighting_reads(view, {depth_tested(depth), sampled(depth, kSceneDepthUnit)});
        for (const auto& [entity, pool] : gpu.pools()) {
            reads.emplace_back(
                pool->sorted ? graph.import("sorted particles", pool->sort.instances)
                             : graph.import("particles", pool->instances));
        }
        const Use writes[] = {target};
        graph.add_pass(name, std::span(reads), writes, [this, half, &view](PassContext& context) {
            draw_sprites(context, view, half);
        });
    };
    if (has_halves && !layer_programs) {
        Result<ParticleLayerPrograms> made = create_particle_layer_programs(*frame.device);
        if (made) {
            layer_programs = *made;
        } else {
            log_error("{}", made.error().message);
        }
    }
    if (has_halves && layer_programs && !is_empty(half_bounds)) {
        const ParticleLayer layer = begin_particle_layer(graph, *layer_programs, view, half_bounds);
        add_pass("particles.half", layer.depth, cleared(layer.radiance), true);
        end_particle_layer(graph, *layer_programs, layer, view);
    }
    add_pass("particles", view.gbuffer.depth, view.radiance, false);
}

/// Those that are drawn at half the resolution, or all others.
void ParticleEffect::draw_sprites(PassContext& context, const ViewData& view, bool half) {
    const bool clipped = is_clipped(view);
    Variant variant = view.lighting.variant;
    variant.add_if(clipped, "CLIPPED");
    variant.add_if(lit, "LIT");
    variant.add_if(images, "IMAGES");
    variant.add_if(has_ribbons, "RIBBONS");
    const gpu::Program* const program = programs.get(variant);
    if (program == nullptr) {
        return;
    }
    gpu::Device& device = context.device();
    device.use(gpu::Pipeline{
        program,
        {.depth = {.write = false},
         .blend = gpu::kBlendPremultiplied,
         .cull = GL_NONE,
         .clip = clipped}});
    bind_lighting(context, view);
    particle_texels.bind(device, kParticlesUnit);
    look_texels.bind(device, kLooksUnit);
    ribbon_texels.bind(device, kRibbonsUnit);
    const auto bind_images = [&](std::uint32_t array) {
        if (images) {
            device.bind_texture(kImagesUnit, view.frame->materials->images().array(array));
        }
    };
    for (std::size_t i = half ? 0 : half_runs; i < (half ? half_runs : runs.size()); ++i) {
        program->set("first", runs[i].first);
        bind_images(runs[i].array);
        device.draw(GL_TRIANGLE_STRIP, 0, 4, runs[i].count);
    }
    program->set("first", 0);
    for (const auto& [entity, pool] : gpu.pools()) {
        const std::uint32_t count = pool->sorted ? pool->sort.count : pool->count;
        if (count > 0 && (halves[pool->look] != 0) == half) {
            bind_images(arrays[pool->look]);
            (pool->sorted ? pool->sort.texels : pool->texels).bind(device, kParticlesUnit);
            device.draw(GL_TRIANGLE_STRIP, 0, 4, static_cast<int>(count));
        }
    }
}

}  // namespace limn
