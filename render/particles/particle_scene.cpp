#include "render/particles/particle_scene.h"

#include "ecs/base/gravity.h"
#include "ecs/components/beam.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/frame_data.h"
#include "render/material/material_pool.h"
#include "render/particles/gpu_particle_pools.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <span>
#include <tuple>

// Techniques: engine.billboard, engine.space-dust, engine.trail, particle.distance-sort

namespace limn {
namespace {

constexpr std::uint32_t kSortPasses = 4;    // per frame of an amortized sort (Latta 2004)
constexpr std::uint32_t kMaxLooks = 65536;  // that 16 bits of an instance can index

/// The transform of an entity in this frame; none without one.
std::optional<Affine> pose_of(const World& world, Entity entity, float alpha) {
    const auto* const now = world.find<WorldTransform>(entity);
    const auto* const before = world.find<PreviousWorldTransform>(entity);
    if (now == nullptr) {
        return std::nullopt;
    }
    return world_at(world.find_resource<StepJumps>(), entity, *now, before, {alpha, alpha});
}

std::optional<Vec3> position_of(const World& world, Entity entity, float alpha) {
    const std::optional<Affine> pose = pose_of(world, entity, alpha);
    return pose ? std::optional(transform_point(*pose, Vec3(0))) : std::nullopt;
}

/// Looks that only add light need no weights.
LookLayer layer_of(const ParticleLook& look) {
    return look.sort == ParticleSort::Weighted && look.cover > 0 ? LookLayer::Weighted
           : look.resolution == ParticleResolution::Half         ? LookLayer::Half
                                                                 : LookLayer::Full;
}

/// Passes per frame of a sort on the GPU, 0: all; none for particles that need no order.
std::optional<std::uint32_t> sort_passes(const ParticleLook& look) {
    if (look.sort == ParticleSort::Births || look.sort == ParticleSort::Weighted
        || look.cover <= 0) {
        return std::nullopt;
    }
    return look.sort == ParticleSort::Amortized ? kSortPasses : 0;
}

/// The look of one particle that stands for `stride`: with their total area.
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
    const std::optional<Vec3> head = position_of(world, emitter, alpha);
    append_births(trail, *pool, back, grows && head ? &*head : nullptr, ribbons);
}

void clear_insets(LookRecord& record) {
    std::fill_n(record.begin() + layout::kLookInsets, layout::kMaxInsetFrames / 4, Vec4(0));
}

/// Lights the look at the corners instead of the center. Insets are cleared, because light is
/// interpolated between the corners of the whole quad.
void light_at_corners(LookRecord& record) {
    record[layout::kLookFocus].y = 0;
    const bool is_six_way = record[layout::kLookMotion].w >= 0;
    if (is_lit_at_corners(record) && !is_six_way) {
        clear_insets(record);
    }
}

void set_insets(const std::vector<float>& insets, LookRecord& record) {
    for (std::size_t i = 0; i < insets.size(); ++i) {
        record[layout::kLookInsets + i / 4][static_cast<int>(i % 4)] = insets[i];
    }
    const bool moves_in_frame = record[layout::kLookMotion].x >= 0;
    if (moves_in_frame) {
        clear_insets(record);
    }
    if (!is_lit_at_center(record)) {
        light_at_corners(record);
    }
}

std::uint32_t add_look(
    const FrameData& frame, const ParticleLook& look, ParticleScene& scene,
    std::optional<Vec3> position = std::nullopt) {
    const bool has_image = frame.assets->images.size() > look.image.index;
    const ImageLayer image = has_image ? frame.materials->images().find(look.image) : ImageLayer{};
    const ImageLayer motion = frame.materials->images().find(look.motion);
    const ImageLayer negative = frame.materials->images().find(look.negative_light);
    const bool has_motion = has_image && motion.array != 0;
    const bool is_six_way = has_image && negative.array != 0;
    const auto layer_if = [](bool has, const ImageLayer& layer) {
        return has ? static_cast<int>(layer.layer) : -1;
    };
    scene.looks.push_back(make_look_record(
        look, {.image = layer_if(has_image, image),
               .motion = layer_if(has_motion, motion),
               .negative_light = layer_if(is_six_way, negative)}));
    scene.arrays.push_back(
        {.images = image.array,
         .motions = has_motion ? motion.array : 0,
         .negative_lights = is_six_way ? negative.array : 0});
    scene.positions.push_back(position);
    scene.extents.push_back(make_look_extent(look));
    scene.extents.back().texels = 0;
    if (has_image) {
        const ImageData& pixels = frame.assets->images[look.image.index];
        scene.extents.back().texels = std::max(
            static_cast<float>(pixels.width) / static_cast<float>(look.columns),
            static_cast<float>(pixels.height) / static_cast<float>(look.rows));
        set_insets(
            scene.insets.find(pixels, look.image, look.columns, look.rows), scene.looks.back());
    }
    scene.layers.push_back(layer_of(look));
    scene.has_halves = scene.has_halves || scene.layers.back() == LookLayer::Half;
    scene.has_weighted = scene.has_weighted || scene.layers.back() == LookLayer::Weighted;
    scene.lit_at_center = scene.lit_at_center || is_lit_at_center(scene.looks.back());
    const SpriteFeatures features = {
        .images = has_image,
        .flipbooks = look.frames != ParticleFrames::Pick && (look.columns > 1 || look.rows > 1),
        .motions = has_motion,
        .six_way = is_six_way};
    scene.features |= features;
    scene.layer_features[static_cast<std::size_t>(scene.layers.back())] |= features;
    scene.soft = scene.soft || look.softness > 0;
    scene.moving = scene.moving || moves_pixels(scene.looks.back());
    scene.focused = scene.focused || look.velocity_cover < 1;
    return static_cast<std::uint32_t>(scene.looks.size() - 1);
}

/// Records the acceleration that bends the paths of an emitter's particles, without gusts.
void add_pull(const World& world, Entity emitter, std::uint32_t look, ParticleScene& scene) {
    if (const auto* const motion = world.find<ParticleMotion>(emitter)) {
        const Vec3 at_rest = Vec3(0, -static_cast<float>(kGravity) * motion->gravity, 0)
                             + motion->drag * motion->wind;
        scene.looks[look][layout::kLookMotion + 1] = Vec4(at_rest, motion->drag);
    }
}

void collect_ribbons(const FrameData& frame, float back, float step, ParticleScene& scene) {
    const World& world = *frame.world;
    const auto add_segments = [&](const ParticleLook& look) {
        scene.has_ribbons = true;
        const std::uint32_t index = add_look(frame, look, scene);
        scene.looks[index][2].w = static_cast<float>(layout::kFacingRibbon);
        scene.looks[index][layout::kLookFocus].y = 0;    // lit at its corners
        scene.looks[index][layout::kLookMotion].x = -1;  // its image goes on beyond the frame
        scene.looks[index][layout::kLookMotion].w = -1;
        scene.extents[index] = {};
        clear_insets(scene.looks[index]);  // its image repeats
        for (const std::uint32_t before : scene.ribbons.segments) {
            const Vec3 center = 0.5f
                                * (scene.ribbons.points[before + 1].position
                                   + scene.ribbons.points[before + 2].position);
            scene.instances.push_back(
                {.position = center, .look_and_life = index << 16, .velocity_xy = before});
        }
        scene.ribbons.segments.clear();
    };
    world.query<const Trail, const ParticleLook, Optional<const TrailState>>().each(
        [&](Entity entity, const Trail& trail, const ParticleLook& look, const TrailState* state) {
            if (scene.looks.size() >= kMaxLooks) {
                return;
            }
            scene.ribbons.width = max_width(look);
            const Entity followed = trail.emitter.is_null() ? entity : trail.emitter;
            if (trail.path == TrailPath::Births) {
                append_births_of(world, followed, trail, back, frame.camera.alpha, scene.ribbons);
            } else if (state != nullptr) {
                append_trail(trail, *state, back, step, scene.ribbons);
            }
            add_segments(look);
        });
    world.query<const Beam, const ParticleLook, const BeamState>().each(
        [&](Entity entity, const Beam& beam, const ParticleLook& look, const BeamState& state) {
            if (scene.looks.size() < kMaxLooks) {
                scene.ribbons.width = max_width(look);
                append_beam(beam, state, entity, frame.camera.alpha, frame.time, scene.ribbons);
                add_segments(look);
            }
        });
}

void collect_billboards(const FrameData& frame, float back, ParticleScene& scene) {
    const auto add_once = [&](const ParticleLook& look) {
        const std::uint32_t index = add_look(frame, look, scene);
        scene.looks[index][2].w = static_cast<float>(layout::kFacingBillboard);
        light_at_corners(scene.looks[index]);
        scene.looks[index][layout::kLookMore + 1].w = 0;  // no life to fade at the end of
        const bool is_repeated =
            index > 0 && scene.looks[index] == scene.looks[index - 1]
            && scene.arrays[index] == scene.arrays[index - 1]
            && scene.extents[index].culling == scene.extents[index - 1].culling;
        if (!is_repeated) {
            scene.extents[index].radius = scene.extents[index].stretch = 0;
            return index;
        }
        scene.looks.pop_back();
        scene.arrays.pop_back();
        scene.layers.pop_back();
        scene.positions.pop_back();
        scene.extents.pop_back();
        return index - 1;
    };
    const World& world = *frame.world;
    world.query<const Billboard, const ParticleLook>().each([&](Entity entity,
                                                                const Billboard& billboard,
                                                                const ParticleLook& look) {
        const std::optional<Affine> pose = pose_of(world, entity, frame.camera.alpha);
        const std::size_t first = scene.billboards.quads.size();
        const Vec3 velocity = entity_velocity(world, entity, particle_step(frame));
        const std::uint32_t random = entity.index * 0x9e3779b9u;
        if (!pose || scene.looks.size() + 2 > kMaxLooks) {
            return;
        }
        const double time = std::max(billboard.time - static_cast<double>(back), 0.0);
        append_billboard(billboard, look, *pose, time, random, scene.billboards);
        for (std::size_t i = first; i < scene.billboards.quads.size(); ++i) {
            const BillboardShading& shading = scene.billboards.shadings[i];
            BillboardQuad& quad = scene.billboards.quads[i];
            quad.velocity = velocity;
            ParticleLook section_look = look;
            if (shading.is_section) {
                section_look.image = billboard.section;
                section_look.columns = section_look.rows = 1;
            }
            section_look.culling = ParticleCulling::Particles;
            const std::uint32_t index = add_once(section_look);
            scene.extents[index].radius = std::max(
                scene.extents[index].radius,
                glm::length(quad.right) + glm::length(quad.up) + look.cull_margin);
            scene.instances.push_back(
                {.position = shading.position,
                 .look_and_life =
                     index << 16 | static_cast<std::uint32_t>(shading.color_at * 65535.0f),
                 .velocity_xy = static_cast<std::uint32_t>(i),
                 .velocity_z_age = std::bit_cast<std::uint32_t>(std::max(shading.opacity, 0.0f)),
                 .random = random});
        }
    });
    scene.has_billboards = !scene.billboards.quads.empty();
}

/// For a warm-up, whose image is not shown: appends a particle for each program that a look needs.
void append_one_of_each(ParticleScene& scene) {
    std::set<std::tuple<LookLayer, bool, bool, bool>> made;
    for (std::uint32_t i = 0; i < scene.looks.size(); ++i) {
        const bool is_six_way = scene.arrays[i].negative_lights != 0;
        const LookRecord& look = scene.looks[i];
        const bool is_new =
            made.emplace(scene.layers[i], is_point(look), is_six_way, is_lit_at_corners(look))
                .second;
        if (is_new) {
            auto& target =
                scene.layers[i] == LookLayer::Weighted ? scene.weighted : scene.instances;
            target.emplace_back().look_and_life = i << 16;
        }
    }
}

void clear(ParticleScene& scene) {
    scene.looks.clear();
    scene.arrays.clear();
    scene.positions.clear();
    scene.layers.clear();
    scene.instances.clear();
    scene.weighted.clear();
    scene.ribbons.clear();
    scene.billboards.quads.clear();
    scene.billboards.shadings.clear();
    scene.extents.clear();
    scene.waters.clear();
    scene.features = {};
    scene.layer_features = {};
    scene.lit_at_center = scene.soft = scene.moving = scene.focused = false;
    scene.has_ribbons = scene.has_billboards = scene.has_halves = scene.has_weighted = false;
}

Bounds shape_in_world(const World& world, Entity entity, float alpha) {
    const auto* const emitter = world.find<ParticleEmitter>(entity);
    const std::optional<Affine> pose = pose_of(world, entity, alpha);
    return emitter != nullptr && pose ? shape_bounds(*emitter, *pose) : Bounds{};
}

void collect_pools(const FrameData& frame, float back, float step, ParticleScene& scene) {
    const World& world = *frame.world;
    const float alpha = frame.camera.alpha;
    const Vec3 eye_velocity = entity_velocity(world, frame.camera.entity, step);
    world.query<const ParticleLook, const ParticlePool, Optional<const Trail>>().each(
        [&](Entity entity, const ParticleLook& look, const ParticlePool& particles,
            const Trail* trail) {
            const bool is_ribbon =
                trail != nullptr && trail->path == TrailPath::Births && trail->emitter.is_null();
            if (scene.looks.size() < kMaxLooks && !is_ribbon) {
                std::optional<Vec3> position;
                if (look.sort == ParticleSort::Births) {
                    position = position_of(world, entity, alpha);
                }
                const std::uint32_t index = add_look(frame, look, scene, position);
                auto& target =
                    scene.layers[index] == LookLayer::Weighted ? scene.weighted : scene.instances;
                const std::size_t first = target.size();
                add_pull(world, entity, index, scene);
                append_particles(particles, index, back, target, look.camera_streak * eye_velocity);
                if (look.culling == ParticleCulling::Bounds) {
                    scene.extents[index].group = bounds_of(std::span(target).subspan(first));
                } else if (look.culling == ParticleCulling::Emitter) {
                    scene.extents[index].group = shape_in_world(world, entity, alpha);
                }
            }
        });
}

/// Particles that the GPU moves: only their looks are added to the scene.
void collect_gpu_pools(FrameData& frame, GpuParticlePools& gpu, ParticleScene& scene) {
    const World& world = *frame.world;
    const float alpha = frame.camera.alpha;
    const auto* const rendering = world.find_resource<Rendering>();
    const std::uint32_t stride =
        particle_stride(rendering != nullptr ? rendering->particle_share : 1);
    gpu.begin_frame(world);
    world
        .query<
            const ParticleLook, const ParticleEmitter, const GpuParticles,
            Optional<const ParticleCollision>, Optional<const ParticleBalls>>()
        .each([&](Entity entity, const ParticleLook& look, const ParticleEmitter& emitter,
                  const GpuParticles& particles, const ParticleCollision* collision,
                  const ParticleBalls* balls) {
            if (scene.looks.size() < kMaxLooks) {
                const std::uint32_t index = add_look(frame, enlarged(look, stride), scene);
                light_at_corners(scene.looks[index]);
                add_pull(world, entity, index, scene);
                gpu.add(
                    frame, entity, emitter, particles, index, sort_passes(look), collision, stride,
                    balls, frame.paced);
                if (look.culling == ParticleCulling::Emitter) {
                    scene.extents[index].group = shape_in_world(world, entity, alpha);
                }
                const std::optional<Affine> pose = pose_of(world, entity, alpha);
                if (scene.layers[index] == LookLayer::Weighted && pose) {
                    scene.extents[index].travel = travel_bounds(emitter, *pose);
                }
            }
        });
    gpu.drop_unused();
}

void order(const RenderView& camera, ParticleScene& scene) {
    const Affine& pose = camera.world_from_camera;
    order_by_distance(
        scene.instances, scene.positions, transform_point(pose, Vec3(0)),
        transform_vector(pose, Vec3(0, 0, -1)), scene.order);
    scene.sorted.clear();
    for (const std::uint32_t i : scene.order.indices) {
        scene.sorted.push_back(scene.instances[i]);
    }
    scene.sorted.insert(scene.sorted.end(), scene.weighted.begin(), scene.weighted.end());
    scene.instances.insert(scene.instances.end(), scene.weighted.begin(), scene.weighted.end());
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

void collect_particles(FrameData& frame, GpuParticlePools& gpu, ParticleScene& scene) {
    const World& world = *frame.world;
    const float step = particle_step(frame);
    const float back = particle_lag(frame);
    clear(scene);
    scene.insets.use_assets(frame.assets_identity);
    world.query<const Water, const WorldTransform>().each(
        [&](const Water& water, const WorldTransform& transform) {
            scene.waters.push_back({&water, water_frame(transform.world)});
        });
    collect_pools(frame, back, step, scene);
    collect_gpu_pools(frame, gpu, scene);
    collect_ribbons(frame, back, step, scene);
    collect_billboards(frame, back, scene);
    if (frame.warm_up) {
        append_one_of_each(scene);
    }
    order(frame.camera, scene);
}

}  // namespace limn
