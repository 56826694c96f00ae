#include "render/particles/particle_runs.h"

#include "render/frame_data.h"
#include "render/geometry/render_items.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_draws.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

// Techniques: particle.visibility

namespace limn {
namespace {

constexpr float kMaxPoint = 4;     // [px] across, above which a disc is drawn as a quad
constexpr float kHighestWave = 5;  // above the rest level of water [m]

/// Of those that are visible and drawn at half the resolution, the index of the middle one in the
/// order; 0 without one.
std::size_t middle_half(const ParticleDraws& draws, const std::vector<std::uint8_t>& visible) {
    const auto is_seen_half = [&](std::size_t i) {
        return visible[i] != 0
               && draws.layers[draws.sorted[i].look_and_share >> 16] == LookLayer::Half;
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < draws.sorted.size(); ++i) {
        count += is_seen_half(i) ? 1 : 0;
    }
    std::size_t rank = count / 2;
    for (std::size_t i = 0; i < draws.sorted.size(); ++i) {
        if (is_seen_half(i) && rank-- == 0) {
            return i;
        }
    }
    return 0;
}

/// Discs fit any arrays.
bool fits(const ParticleDraws& draws, const ParticleRun& run, std::uint32_t look) {
    const bool is_disc = draws.looks[look][3].w < 0;
    const Vec4& motion = draws.looks[look][layout::kLookMotion];
    const bool is_still = motion.x < 0;
    const bool is_flat = motion.w < 0;
    return (run.shape == SpriteShape::Point) == is_point(draws.looks[look])
           && (is_disc || run.arrays.images == draws.arrays[look].images)
           && (is_still || run.arrays.motions == draws.arrays[look].motions)
           && (is_flat || run.arrays.negative_lights == draws.arrays[look].negative_lights);
}

void append_instance(
    const ParticleDraws& draws, const RenderView& camera, std::size_t index, float scale,
    std::size_t first_run, ParticlesInView& seen) {
    const ParticleInstance& instance = draws.sorted[index];
    const std::uint32_t look = instance.look_and_share >> 16;
    if (seen.runs.size() == first_run || !fits(draws, seen.runs.back(), look)) {
        seen.runs.push_back(
            {.arrays = draws.arrays[look],
             .shape = is_point(draws.looks[look]) ? SpriteShape::Point : SpriteShape::SmallDisc,
             .magnified = true,
             .first = static_cast<int>(seen.instances.size()),
             .count = 0});
    }
    ParticleRun& run = seen.runs.back();
    const float texels = draws.extents[look].texels;
    const float pixels = scale * least_pixels(instance, draws.looks[look], camera);
    const bool is_small_disc =
        texels == 0 && draws.looks[look][2].y == 0 && pixels > 0 && pixels <= kMaxPoint;
    run.magnified = run.magnified && (texels == 0 || pixels > 0.999f * texels);
    if (run.shape == SpriteShape::SmallDisc && !is_small_disc) {
        run.shape = SpriteShape::Quad;
    }
    run.lit = run.lit || is_lit_at_corners(draws.looks[look]);
    ++run.count;
    seen.instances.push_back(instance);
}

/// Pixels of the view within which it may be seen.
LightBounds
window_of(const RenderView& view, const ParticleInstance& instance, const LookRecord& look) {
    const bool has_reach = std::isfinite(bounds_of(instance, look).min.x);
    return light_bounds(view, instance.position, has_reach ? reach_of(instance, look) : INFINITY);
}

/// Those of this layer in [first, last) that are visible, from back to front.
void append_runs(
    const ParticleDraws& draws, const RenderView& camera, LookLayer layer, std::size_t first,
    std::size_t last, ParticlesInView& seen) {
    const float scale = layer == LookLayer::Half ? 0.5f : 1.0f;
    const std::size_t first_run = seen.runs.size();
    for (std::size_t i = first; i < last; ++i) {
        const std::uint32_t look = draws.sorted[i].look_and_share >> 16;
        if (seen.visible[i] == 0 || draws.layers[look] != layer) {
            continue;
        }
        append_instance(draws, camera, i, scale, first_run, seen);
        if (layer == LookLayer::Half) {
            grow(seen.half_window, window_of(camera, draws.sorted[i], draws.looks[look]));
        } else if (layer == LookLayer::Weighted) {
            grow(seen.weighted_bounds, {draws.sorted[i].position, draws.sorted[i].position});
        }
    }
}

/// Below the rest level of some water, wherever its waves are.
bool is_under_water(std::span<const DrawnWater> waters, const Vec3& place) {
    return std::any_of(waters.begin(), waters.end(), [&](const DrawnWater& body) {
        const Vec3 local = body.frame.local(place);
        return local.y < 0 && is_inside(*body.water, {local.x, local.z});
    });
}

/// A box about all that is opaque and may be in some water.
Bounds find_ground(const RenderItems& items, std::span<const DrawnWater> waters) {
    float highest = -INFINITY;
    for (const DrawnWater& body : waters) {
        highest = std::max(highest, body.frame.origin.y + kHighestWave);
    }
    Bounds ground;
    for (std::size_t b = 0; b < items.block_count(); ++b) {
        const RenderItemBlock& block = items.block(b);
        for (std::uint32_t i = 0; i < block.size(); ++i) {
            const Bounds box = block.box(i);
            if (block.is_drawable(i) && !is_blended(block.keys[i]) && box.min.y < highest) {
                grow(ground, box);
            }
        }
    }
    ground.max.y = std::min(ground.max.y, highest);
    return ground;
}

/// Whether the ray eye + t to, t >= `near`, meets the box.
bool meets(const Bounds& box, const Vec3& eye, const Vec3& to, float near) {
    float far = INFINITY;
    for (int i = 0; i < 3; ++i) {
        if (to[i] == 0) {
            far = eye[i] >= box.min[i] && eye[i] <= box.max[i] ? far : -INFINITY;
            continue;
        }
        const float a = (box.min[i] - eye[i]) / to[i];
        const float b = (box.max[i] - eye[i]) / to[i];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

/// Whether some of the ground may be behind a particle.
bool is_before(
    const Bounds& ground, const Vec3& eye, const ParticleInstance& instance,
    const LookExtent& extent) {
    const Vec3 to = instance.position - eye;
    const float away = glm::length(to);
    const float radius = extent.radius + extent.stretch * glm::length(Vec3(instance.motion()));
    if (extent.culling != ParticleCulling::Particles || !(away > radius)) {
        return true;
    }
    // As wide as what it hides at the far end of the ground.
    const Vec3 farthest = glm::max(glm::abs(ground.min - eye), glm::abs(ground.max - eye));
    const float width = radius * glm::length(farthest) / std::sqrt(square(away) - square(radius));
    return meets({ground.min - width, ground.max + width}, eye, to, 1 - radius / away);
}

/// At full resolution; none where the camera is in the water, too, and only before the ground,
/// since water hides all that is behind it where there is none. Layers are drawn one after the
/// other, as above the water: sorted among each other, they would take turns in binding images and
/// programs, a draw for every few particles.
void append_under_water(
    const ParticleDraws& draws, const FrameData& frame, const ViewData& view, std::size_t middle,
    ParticlesInView& seen) {
    seen.under_begin = seen.runs.size();
    seen.above_water = false;
    const Vec3 eye = transform_point(view.camera.world_from_camera, Vec3(0));
    if (draws.waters.empty() || is_clipped(view) || is_under_water(draws.waters, eye)) {
        return;
    }
    const Bounds ground = find_ground(*frame.items, draws.waters);
    if (is_empty(ground) && !frame.warm_up) {
        return;
    }
    seen.above_water = true;
    const auto is_seen = [&](const ParticleInstance& instance, std::uint32_t look) {
        return is_under_water(draws.waters, instance.position)
               && is_before(ground, eye, instance, draws.extents[look]);
    };
    const auto append = [&](LookLayer layer, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const ParticleInstance& instance = draws.sorted[i];
            const std::uint32_t look = instance.look_and_share >> 16;
            if (seen.visible[i] != 0 && draws.layers[look] == layer
                && (frame.warm_up || is_seen(instance, look))) {
                append_instance(draws, view.camera, i, 1, seen.under_begin, seen);
            }
        }
    };
    append(LookLayer::Full, 0, middle);
    append(LookLayer::Half, 0, draws.sorted.size());
    append(LookLayer::Full, middle, draws.sorted.size());
    append(LookLayer::Weighted, 0, draws.sorted.size());
}

}  // namespace

void select_particles(
    const ParticleDraws& draws, const GpuParticlePools& gpu, const FrameData& frame,
    const ViewData& view, ParticlesInView& seen) {
    seen.instances.clear();
    seen.runs.clear();
    seen.half_window = {};
    seen.weighted_bounds = {};
    seen.half_begin = 0;
    const Frustum frustum = make_frustum(view.camera.clip_from_world);
    cull_particles(draws.sorted, draws.extents, frustum, seen.visible);
    if (frame.warm_up) {
        seen.visible.assign(draws.sorted.size(), 1);
    }
    std::size_t middle = 0;
    if (draws.has_halves) {
        middle = middle_half(draws, seen.visible);
        append_runs(draws, view.camera, LookLayer::Full, 0, middle, seen);
        seen.half_begin = seen.runs.size();
        append_runs(draws, view.camera, LookLayer::Half, 0, draws.sorted.size(), seen);
        const auto is_half = [&](const auto& pool) {
            return draws.layers[pool.second->look] == LookLayer::Half;
        };
        if (frame.warm_up || std::any_of(gpu.pools().begin(), gpu.pools().end(), is_half)) {
            seen.half_window = {0, 0, view.camera.width, view.camera.height, 0, 1};
        }
    }
    seen.half_end = seen.runs.size();
    append_runs(draws, view.camera, LookLayer::Full, middle, draws.sorted.size(), seen);
    seen.weighted_begin = seen.runs.size();
    append_runs(
        draws, view.camera, LookLayer::Weighted, draws.sorted.size() - draws.weighted.size(),
        draws.sorted.size(), seen);
    for (const auto& [entity, pool] : gpu.pools()) {
        grow(
            seen.weighted_bounds, draws.layers[pool->look] == LookLayer::Weighted
                                      ? draws.extents[pool->look].ways
                                      : Bounds{});
    }
    append_under_water(draws, frame, view, middle, seen);
}

}  // namespace limn
