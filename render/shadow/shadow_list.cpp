#include "render/shadow/shadow_list.h"

#include "ecs/base/hash.h"
#include "ecs/base/log.h"
#include "ecs/world.h"
#include "render/material/material_pool.h"
#include "render/shaders/view_gpu.h"
#include "render/shadow/light_bounds.h"
#include "render/shadow/perspective_view.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>

// Techniques: shadow.map, shadow.perspective-map

namespace limn {
namespace {

constexpr int kMinAtlasSize = 1024;
constexpr int kMaxAtlasSize = 8192;
constexpr float kMinNear = 0.02f;  ///< of a view from a light [m]
/// Fraction of a cascade over which it blends into the next one.
constexpr float kCascadeBlend = 0.1f;  // as in lib/shadow.glsl

/// Border texels that the filter of a view may sample.
int guard_of(const Shadow& shadow) {
    switch (shadow.filter) {
    case ShadowFilter::Hard:
    case ShadowFilter::Bilinear:
        return 2;
    case ShadowFilter::Soft:
        return 4;
    case ShadowFilter::ContactHardening:
        return 4 + shadow.resolution / 16;
    }
    return 2;
}

/// The near plane lies outside the light source, inside of which nothing casts a shadow.
float near_of(const Shadow& shadow) {
    return std::max(0.5f * shadow.source_size, kMinNear);
}

/// The part of the camera's view within the light's range; nullopt if it is empty.
std::optional<ViewSlice>
slice_of(const RenderView& view, const ShadowedLight& light, float distance) {
    const Vec2 widest = widest_tangent(view);
    ViewSlice slice = {view.near, view.pullback + distance, -widest, widest};
    if (light.kind == LightKind::Directional) {
        return slice;
    }
    LightRange range = {light.position, light.radius};
    if (light.kind == LightKind::Spot) {
        range.axis = light.axis;
        range.cosine = std::cos(std::clamp(light.outer_angle, 0.0f, 0.5f * kPi));
    }
    const RangeSphere sphere = range_sphere(range);
    const LightBounds bounds = light_bounds(view, sphere.center, sphere.radius);
    if (is_empty(bounds)) {
        return std::nullopt;
    }
    const auto slope = [](int pixel, float jitter, int size, float tangent) {
        const float unjittered = static_cast<float>(pixel) - jitter;
        return (2 * unjittered / static_cast<float>(size) - 1) * tangent;
    };
    const Vec2 jitter = view.jitter;
    slice.low.x = slope(bounds.x - 1, jitter.x, view.width, view.tangent.x);
    slice.low.y = slope(bounds.y - 1, jitter.y, view.height, view.tangent.y);
    slice.high.x = slope(bounds.x + bounds.width + 1, jitter.x, view.width, view.tangent.x);
    slice.high.y = slope(bounds.y + bounds.height + 1, jitter.y, view.height, view.tangent.y);
    slice.near = view.near / std::min(bounds.depth_max, 1.0f);
    slice.far = bounds.depth_min > 0 ? double(view.near) / bounds.depth_min
                                     : double(view.pullback + distance);
    return slice;
}

std::uint64_t key_of(Entity entity) {
    return static_cast<std::uint64_t>(entity.generation) << 32 | entity.index;
}

}  // namespace

Shadow sanitize(const Shadow& shadow) {
    Shadow valid = shadow;
    const auto resolution = static_cast<unsigned>(std::clamp(shadow.resolution, 16, 4096));
    valid.resolution = static_cast<int>(std::bit_ceil(resolution));
    valid.source_size = std::clamp(finite_or(shadow.source_size, 0.0f), 0.0f, 1e6f);
    valid.cascades = std::clamp(shadow.cascades, 1, kMaxCascades);
    valid.distance = finite_or(shadow.distance, 40.0f);
    valid.distance = valid.distance > 0 ? valid.distance : 40.0f;
    valid.detail = std::clamp(finite_or(shadow.detail, 0.0f), 0.0f, 8.0f);
    valid.bias = std::clamp(finite_or(shadow.bias, 1.0f), 0.0f, 8.0f);
    if (valid.method == ShadowMethod::Perspective && valid.filter > ShadowFilter::Soft) {
        valid.filter = ShadowFilter::Soft;  // depth per meter is not constant in such a map
    }
    return valid;
}

void ShadowCollector::request_cascades(const RenderView& view, LightViews& request) {
    const Shadow& settings = request.settings;
    const float far = settings.distance;
    const float near = std::min(std::max(view.near - view.pullback, 0.01f * far), 0.5f * far);
    const auto ends = split_cascades(near, far, settings.cascades);
    float begin = 0;
    for (int i = 0; i < settings.cascades; ++i) {
        const float end = ends[static_cast<std::size_t>(i)];
        views_.push_back(make_cascade_view(
            view, -request.light->axis, view.pullback + begin, view.pullback + end,
            settings.resolution, guard_of(settings)));
        begin = (1 - kCascadeBlend) * end;
    }
    request.kind = layout::kShadowCascades;
    request.splits = {ends[0], ends[1], ends[2], ends[3]};
}

/// False if no such view exists for the light.
bool ShadowCollector::request_perspective(const RenderView& view, LightViews& request) {
    const ShadowedLight& light = *request.light;
    const float distance = request.settings.distance;
    const std::optional<ViewSlice> slice = slice_of(view, light, distance);
    if (!slice) {
        return false;
    }
    const bool sun = light.kind == LightKind::Directional;
    const Vec4 source = sun ? Vec4(-light.axis, 0) : Vec4(light.position, 1);
    const int guard = guard_of(request.settings);
    const auto found =
        make_perspective_view(view, source, *slice, request.settings.resolution, guard);
    if (!found) {
        return false;
    }
    views_.push_back(*found);
    request.kind = layout::kShadowCascades;  // a single one
    if (sun || !std::isfinite(light.radius)) {
        request.splits.x = distance;
    }
    return true;
}

/// Requests every light's views, in the order of the lights.
void ShadowCollector::request_views(
    const RenderView& view, ViewKind kind, const LightList& lights, ShadowList& list) {
    views_.clear();
    requests_.clear();
    for (const ShadowedLight& light : lights.shadowed) {
        LightViews request = {
            .light = &light, .key = key_of(light.entity), .settings = sanitize(light.settings)};
        if (light.kind == LightKind::Directional && (kind & kMainViews) == 0) {
            // Mirrors ripple and probes are small: they do not show the shadows' texels.
            request.settings.resolution = std::max(request.settings.resolution / 2, 16);
        }
        request.first_view = views_.size();
        const Shadow& settings = request.settings;
        const bool perspective =
            settings.method == ShadowMethod::Perspective && request_perspective(view, request);
        const int resolution = settings.resolution;
        const int guard = guard_of(settings);
        if (perspective) {
            // its single view is already there
        } else if (light.kind == LightKind::Directional) {
            request_cascades(view, request);
        } else if (light.kind == LightKind::Spot && light.outer_angle <= kMaxSpotViewAngle) {
            request.kind = layout::kShadowView;
            views_.push_back(make_spot_view(
                light.position, light.axis, light.outer_angle, near_of(settings), resolution, guard,
                light.right));
        } else {
            request.kind = layout::kShadowCube;
            for (int face = 0; face < 6; ++face) {
                views_.push_back(
                    make_cube_view(light.position, face, near_of(settings), resolution, guard));
            }
        }
        request.count = views_.size() - request.first_view;
        request.view_kind = request.kind == layout::kShadowCascades ? kind : 0u;
        for (std::size_t i = request.first_view; i < views_.size(); ++i) {
            views_[i].range = light.radius;
            views_[i].detail = perspective ? 0.0f : settings.detail;
        }
        requests_.push_back(request);
    }
    for (WaterShadow& water : list.waters) {
        water.record = -1;
        constexpr std::uint64_t kWaters = std::uint64_t{1}
                                          << 63;  // distinguishes waters from lights
        LightViews request = {
            .water = &water,
            .key = key_of(water.water) | kWaters | water.part << 60,
            .view_kind = kind,
            .settings = {.filter = ShadowFilter::Bilinear, .resolution = water.view.resolution},
            .kind = layout::kShadowView,
            .first_view = views_.size(),
            .count = 1};
        views_.push_back(water.view);
        requests_.push_back(request);
    }
}

ShadowCollector::CachedMapKey
ShadowCollector::key_of_map(const LightViews& request, std::size_t number) const {
    return {request.key, request.view_kind, static_cast<int>(number)};
}

ShadowCollector::CachedMap&
ShadowCollector::cached_map(const LightViews& request, std::size_t number) {
    return maps_.at(key_of_map(request, number));
}

/// False if the atlas cannot hold all of the light's views.
bool ShadowCollector::allocate_light(LightViews& request) {
    for (std::size_t i = 0; i < request.count; ++i) {
        const int size = request.settings.resolution;
        const auto [found, fresh] = maps_.try_emplace(key_of_map(request, i), CachedMap{});
        CachedMap& view = found->second;
        view.used = true;
        if (!fresh && view.rect.size == size) {
            continue;
        }
        if (!fresh) {
            atlas_.release(view.rect);
        }
        const std::optional<AtlasRect> rect = atlas_.allocate(size);
        if (!rect) {
            maps_.erase(found);
            return false;
        }
        view = {.rect = *rect, .used = true};
    }
    request.allocated = true;
    return true;
}

void ShadowCollector::release_light(const LightViews& request) {
    for (std::size_t i = 0; i < request.count; ++i) {
        if (const auto found = maps_.find(key_of_map(request, i)); found != maps_.end()) {
            atlas_.release(found->second.rect);
            maps_.erase(found);
        }
    }
}

void ShadowCollector::begin_frame() {
    for (auto& [key, map] : maps_) {
        map.used = false;
    }
}

bool ShadowCollector::evict_unused() {
    return std::erase_if(
               maps_,
               [&](const auto& entry) {
                   const bool unused = !entry.second.used;
                   if (unused) {
                       atlas_.release(entry.second.rect);
                   }
                   return unused;
               })
           > 0;
}

/// Allocates space for every view: first free space, then that of unused maps, then by doubling the
/// atlas, in which all others keep their positions and depths.
void ShadowCollector::allocate_views() {
    for (const LightViews& request : requests_) {
        for (std::size_t i = 0; i < request.count; ++i) {
            if (const auto found = maps_.find(key_of_map(request, i)); found != maps_.end()) {
                found->second.used = true;
            }
        }
    }
    while (atlas_.size() < kMinAtlasSize && !requests_.empty()) {
        atlas_.grow();
    }
    for (std::size_t i = 0; i < requests_.size();) {
        if (allocate_light(requests_[i])) {
            ++i;
        } else if (evict_unused()) {
            // try again
        } else if (atlas_.size() < kMaxAtlasSize) {
            atlas_.grow();
        } else {
            release_light(requests_[i]);
            ++i;
        }
    }
}

void ShadowCollector::write_records(LightList& lights, ShadowList& list) {
    for (const LightViews& request : requests_) {
        if (!request.allocated) {
            ++list.unserved;
            continue;
        }
        lights.shadows = true;
        list.kinds.maps = true;
        list.kinds.cubes = list.kinds.cubes || request.kind == layout::kShadowCube;
        list.kinds.cascades = list.kinds.cascades || request.kind == layout::kShadowCascades;
        const bool soft = request.settings.filter >= ShadowFilter::Soft;
        const bool used_for_lighting = request.water != nullptr || !request.light->for_volumes;
        const bool contact = request.settings.filter == ShadowFilter::ContactHardening;
        list.kinds.soft = list.kinds.soft || (soft && used_for_lighting);
        list.kinds.contact = list.kinds.contact || (contact && used_for_lighting);
        if (request.water != nullptr) {
            request.water->record = static_cast<int>(list.records.size());
        } else {
            lights.records[request.light->record].shadow = {
                static_cast<float>(list.records.size()), request.kind,
                static_cast<float>(request.count), 0};
        }
        for (std::size_t i = 0; i < request.count; ++i) {
            list.records.push_back(make_shadow_record(
                views_[request.first_view + i], cached_map(request, i).rect,
                static_cast<float>(request.settings.filter), request.settings.source_size,
                request.settings.bias));
            list.records.back().splits = request.splits;
        }
    }
}

void ShadowCollector::collect(
    const FrameData& frame, const ViewData& view, std::span<const WaterShadow> waters,
    LightList& lights, ShadowList& list) {
    list.waters.assign(waters.begin(), waters.end());
    list.records.clear();
    list.due.clear();
    list.unserved = 0;
    list.kinds = {};
    request_views(view.camera, view.kind, lights, list);
    allocate_views();
    write_records(lights, list);
    list.atlas_size = list.records.empty() ? 0 : atlas_.size();
    if (list.unserved > 0 && !reported_) {
        log_warn(
            "shadow: {} lights cast no shadows: the atlas of {} texels is full; lower their "
            "resolution",
            list.unserved, atlas_.size());
        reported_ = true;
    }
    if (list.records.empty()) {
        return;
    }

    volumes_.clear();
    for (const ShadowView& shadow_view : views_) {
        volumes_.push_back(make_caster_volume(shadow_view));
    }
    signatures_.resize(views_.size());
    hash_casters(*frame.items, volumes_, signatures_);
    // Displaced casters are divided for the eye of the view.
    const Vec4 eye = frame.materials->displaces() ? tessellation_eye(view.camera) : Vec4(0);
    for (const LightViews& request : requests_) {
        for (std::size_t i = 0; request.allocated && i < request.count; ++i) {
            const std::size_t v = request.first_view + i;
            CachedMap& map = cached_map(request, i);
            const std::uint64_t signature = hash_combine(
                hash_bytes(&eye, sizeof eye, hash_combine(signatures_[v], frame.assets_identity)),
                std::bit_cast<std::uint32_t>(views_[v].detail));
            if (map.drawn && map.signature == signature
                && map.clip_from_world == views_[v].clip_from_world) {
                continue;
            }
            map.drawn = true;
            map.signature = signature;
            map.clip_from_world = views_[v].clip_from_world;
            layout::ViewBlock block{};
            ShadowDraw& draw = list.due.emplace_back();
            draw.rect = map.rect;
            draw.clamp_depth = views_[v].clamp_depth;
            // Any caster may enter a map later.
            const bool all = frame.warm_up && list.due.size() == 1;
            collector_.collect_casters(
                *frame.items, all ? CasterVolume{kEverywhere} : volumes_[v], *frame.ring,
                draw.casters);
            block.clip_from_world = views_[v].clip_from_world;
            block.tessellation = eye;
            draw.view_block = frame.ring->push_value(block);
        }
    }
}

}  // namespace limn
