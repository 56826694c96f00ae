#include "render/particles/layered_draws.h"

#include "render/frame_data.h"
#include "render/geometry/instance_list.h"
#include "render/geometry/render_items.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_scene.h"
#include "render/particles/particle_splats.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

// Techniques: particle.visibility

namespace limn {
namespace {

constexpr float kMaxPoint = 4;     // diameter above which a disc is drawn as a quad [px]
constexpr float kHighestWave = 5;  // above the rest level of water [m]

std::uint32_t look_of(const ParticleInstance& instance) {
    return instance.look_and_life >> 16;
}

/// Among the visible instances at half the resolution, the index of the median in the order; 0
/// if there are none.
std::size_t find_median_half(const ParticleScene& scene, const std::vector<std::uint8_t>& visible) {
    const auto is_visible_half = [&](std::size_t i) {
        return visible[i] != 0 && scene.layers[look_of(scene.sorted[i])] == LookLayer::Half;
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < scene.sorted.size(); ++i) {
        count += is_visible_half(i) ? 1 : 0;
    }
    std::size_t rank = count / 2;
    for (std::size_t i = 0; i < scene.sorted.size(); ++i) {
        if (is_visible_half(i) && rank-- == 0) {
            return i;
        }
    }
    return 0;
}

/// Whether an instance of this look can join the draw. Discs fit any texture arrays.
bool can_join(const ParticleScene& scene, const SpriteDraw& draw, std::uint32_t look) {
    const bool is_disc = scene.looks[look][3].w < 0;
    const Vec4& motion = scene.looks[look][layout::kLookMotion];
    const bool has_motion_map = motion.x >= 0;
    const bool is_six_way = motion.w >= 0;
    const ParticleArrays& arrays = scene.arrays[look];
    return draw.pool == nullptr && (draw.shape == SpriteShape::Point) == is_point(scene.looks[look])
           && (is_disc || draw.arrays.images == arrays.images)
           && (!has_motion_map || draw.arrays.motions == arrays.motions)
           && (!is_six_way || draw.arrays.negative_lights == arrays.negative_lights);
}

/// Appends an instance to the last draw, or to a new one.
void append_instance(
    const ParticleScene& scene, const RenderView& camera, SpriteLayer layer, std::uint32_t index,
    LayeredDraws& list) {
    const ParticleInstance& instance = scene.sorted[index];
    const std::uint32_t look = look_of(instance);
    const LookRecord& record = scene.looks[look];
    if (list.draws.empty() || list.draws.back().layer != layer
        || !can_join(scene, list.draws.back(), look)) {
        list.draws.push_back(
            {.layer = layer,
             .shape = is_point(record) ? SpriteShape::Point : SpriteShape::SmallDisc,
             .arrays = scene.arrays[look],
             .magnified = true,
             .first = static_cast<int>(list.instances.size())});
    }
    SpriteDraw& draw = list.draws.back();
    const float scale = layer == SpriteLayer::Half ? 0.5f : 1.0f;
    const float texels = scene.extents[look].texels;
    const float pixels = scale * min_diameter(instance, record, camera);
    const bool is_small_disc = texels == 0 && record[2].y == 0 && pixels > 0 && pixels <= kMaxPoint;
    draw.magnified = draw.magnified && (texels == 0 || pixels > 0.999f * texels);
    if (draw.shape == SpriteShape::SmallDisc && !is_small_disc) {
        draw.shape = SpriteShape::Quad;
    }
    draw.lit = draw.lit || is_lit_at_corners(record);
    ++draw.count;
    list.instances.push_back(instance);
}

/// Pixels of the view within which an instance may be visible.
LightBounds
window_of(const RenderView& view, const ParticleInstance& instance, const LookRecord& look) {
    const bool is_bounded = std::isfinite(bounds_of(instance, look).min.x);
    return light_bounds(
        view, instance.position, is_bounded ? corner_radius(instance, look) : INFINITY);
}

/// Below the rest level of some water, wherever its waves are.
bool is_under_water(std::span<const DrawnWater> waters, const Vec3& position) {
    return std::any_of(waters.begin(), waters.end(), [&](const DrawnWater& body) {
        const Vec3 local = body.frame.local(position);
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

/// Whether the ray eye + t to, t >= `near`, intersects the box.
bool intersects(const Bounds& box, const Vec3& eye, const Vec3& to, float near) {
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

/// Whether the ground may be behind a particle.
bool may_be_before_ground(
    const Bounds& ground, const Vec3& eye, const ParticleInstance& instance,
    const LookExtent& extent) {
    const Vec3 to = instance.position - eye;
    const float away = glm::length(to);
    const float radius = extent.radius + extent.stretch * glm::length(Vec3(instance.motion()));
    if (extent.culling != ParticleCulling::Particles || !(away > radius)) {
        return true;
    }
    // Grown by the radius of the particle's projection at the far end of the ground.
    const Vec3 farthest = glm::max(glm::abs(ground.min - eye), glm::abs(ground.max - eye));
    const float width = radius * glm::length(farthest) / std::sqrt(square(away) - square(radius));
    return intersects({ground.min - width, ground.max + width}, eye, to, 1 - radius / away);
}

/// Which particles are visible through water from above: those in it, and only in front of the
/// ground, since water without ground behind it hides all that is in it. None if the camera is in
/// the water, too.
class UnderwaterTest {
  public:
    UnderwaterTest(const ParticleScene& scene, const FrameData& frame, const ViewData& view)
        : scene_(scene), warm_up_(frame.warm_up),
          eye_(transform_point(view.camera.world_from_camera, Vec3(0))) {
        if (!scene.waters.empty() && !is_clipped(view) && !is_under_water(scene.waters, eye_)) {
            ground_ = find_ground(*frame.items, scene.waters);
            can_see_ = !is_empty(ground_) || warm_up_;
        }
    }

    /// Whether any may be visible.
    [[nodiscard]] bool can_see() const { return can_see_; }
    [[nodiscard]] bool can_see(const ParticleInstance& instance) const {
        return can_see_
               && (warm_up_
                   || (is_under_water(scene_.waters, instance.position)
                       && may_be_before_ground(
                           ground_, eye_, instance, scene_.extents[look_of(instance)])));
    }

  private:
    const ParticleScene& scene_;
    bool warm_up_;
    Vec3 eye_;
    Bounds ground_{};
    bool can_see_ = false;
};

/// Sorts the visible instances into layers. They stay in order: from back to front, but for
/// weighted ones.
void sort_into_layers(
    const ParticleScene& scene, const UnderwaterTest& underwater, LayeredDraws& list) {
    for (std::size_t layer = 0; layer < kSpriteLayers; ++layer) {
        list.indices[layer].clear();
        list.underwater[layer].clear();
    }
    const std::size_t median = scene.has_halves ? find_median_half(scene, list.visible) : 0;
    for (std::uint32_t i = 0; i < scene.sorted.size(); ++i) {
        if (list.visible[i] == 0) {
            continue;
        }
        const LookLayer look_layer = scene.layers[look_of(scene.sorted[i])];
        const SpriteLayer layer = look_layer == LookLayer::Half       ? SpriteLayer::Half
                                  : look_layer == LookLayer::Weighted ? SpriteLayer::Weighted
                                  : i < median                        ? SpriteLayer::Behind
                                                                      : SpriteLayer::Front;
        list.indices[static_cast<std::size_t>(layer)].push_back(i);
        if (underwater.can_see(scene.sorted[i])) {
            list.underwater[static_cast<std::size_t>(layer)].push_back(i);
        }
    }
}

/// Layer of a pool above water.
SpriteLayer
layer_of_pool(const ParticleScene& scene, const GpuParticlePool& pool, bool has_splats) {
    switch (scene.layers[pool.look]) {
    case LookLayer::Half:
        return SpriteLayer::Half;
    case LookLayer::Weighted:
        return SpriteLayer::Weighted;
    case LookLayer::Full:
        break;
    }
    return has_splats && can_be_splats(pool, scene.looks[pool.look]) ? SpriteLayer::Splats
                                                                     : SpriteLayer::Front;
}

SpriteDraw
draw_of_pool(const ParticleScene& scene, const GpuParticlePool& pool, SpriteLayer layer) {
    const LookRecord& look = scene.looks[pool.look];
    return {
        .layer = layer,
        .shape = is_point(look) ? SpriteShape::Point : SpriteShape::Quad,
        .arrays = scene.arrays[pool.look],
        .lit = is_lit_at_corners(look),
        .count = static_cast<int>(pool.sorted ? pool.sort.count : pool.count),
        .pool = &pool};
}

/// Splats are composited without regard to blended surfaces: with one in view, points are
/// rasterized.
bool can_show_splats(const ViewData& view) {
    return view.is(kMainViews) && !is_clipped(view)
           && view.data.get<InstanceList>().blended.empty();
}

void find_half_window(
    const ParticleScene& scene, const GpuParticlePools& gpu, const FrameData& frame,
    const RenderView& camera, LayeredDraws& list) {
    const auto is_half = [&](const auto& pool) {
        return scene.layers[pool.second->look] == LookLayer::Half;
    };
    list.half_window = {};
    if (scene.has_halves
        && (frame.warm_up || std::any_of(gpu.pools().begin(), gpu.pools().end(), is_half))) {
        list.half_window = {0, 0, camera.width, camera.height, 0, 1};
        return;
    }
    for (const std::uint32_t i : list.indices[static_cast<std::size_t>(SpriteLayer::Half)]) {
        const ParticleInstance& instance = scene.sorted[i];
        grow(list.half_window, window_of(camera, instance, scene.looks[look_of(instance)]));
    }
}

void find_weighted_bounds(
    const ParticleScene& scene, const GpuParticlePools& gpu, LayeredDraws& list) {
    list.weighted_bounds = {};
    for (const std::uint32_t i : list.indices[static_cast<std::size_t>(SpriteLayer::Weighted)]) {
        grow(list.weighted_bounds, {scene.sorted[i].position, scene.sorted[i].position});
    }
    for (const auto& [entity, pool] : gpu.pools()) {
        if (scene.layers[pool->look] == LookLayer::Weighted) {
            grow(list.weighted_bounds, scene.extents[pool->look].travel);
        }
    }
}

}  // namespace

void list_draws(
    const ParticleScene& scene, const GpuParticlePools& gpu, const FrameData& frame,
    const ViewData& view, LayeredDraws& list) {
    const Frustum frustum = make_frustum(view.camera.clip_from_world);
    cull_particles(scene.sorted, scene.extents, frustum, list.visible);
    if (frame.warm_up) {
        list.visible.assign(scene.sorted.size(), 1);
    }
    const UnderwaterTest underwater(scene, frame, view);
    sort_into_layers(scene, underwater, list);
    find_half_window(scene, gpu, frame, view.camera, list);
    find_weighted_bounds(scene, gpu, list);

    list.draws.clear();
    list.instances.clear();
    const auto append_instances = [&](SpriteLayer layer, std::span<const std::uint32_t> indices) {
        for (const std::uint32_t i : indices) {
            append_instance(scene, view.camera, layer, i, list);
        }
    };
    const bool has_splats = can_show_splats(view);
    const auto append_pools = [&](SpriteLayer layer, bool only_add_light) {
        const bool is_underwater = layer == SpriteLayer::Underwater;
        for (const auto& [entity, pool] : gpu.pools()) {
            const bool is_in_layer = is_underwater
                                         ? underwater.can_see()
                                         : layer_of_pool(scene, *pool, has_splats) == layer;
            const bool only_adds = scene.looks[pool->look][2].z == 0;
            const SpriteDraw draw = draw_of_pool(scene, *pool, layer);
            // Programs of splats are compiled at the warm-up, even if no particle is born yet.
            const bool is_visible =
                draw.count > 0 && is_group_in_view(scene.extents[pool->look], frustum);
            if (is_in_layer && only_adds == only_add_light
                && (is_visible || (frame.warm_up && layer == SpriteLayer::Splats))) {
                list.draws.push_back(draw);
            }
        }
    };
    for (std::size_t i = 0; i < kSpriteLayers; ++i) {
        const auto layer = static_cast<SpriteLayer>(i);
        list.begin[i] = list.draws.size();
        append_pools(layer, true);
        if (layer == SpriteLayer::Underwater) {
            // One layer after another, as above water: sorted together, draws would alternate
            // between images and programs.
            for (const std::vector<std::uint32_t>& indices : list.underwater) {
                append_instances(layer, indices);
            }
        } else {
            append_instances(layer, list.indices[i]);
        }
        append_pools(layer, false);
    }
    list.begin[kSpriteLayers] = list.draws.size();
}

}  // namespace limn
