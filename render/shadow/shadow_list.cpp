#include "render/shadow/shadow_list.h"

#include "ecs/base/hash.h"
#include "ecs/base/log.h"
#include "ecs/world.h"
#include "render/shaders/view_gpu.h"
#include "render/shadow/light_bounds.h"
#include "render/shadow/perspective_view.h"

#include <algorithm>
#include <bit>

namespace limn {
namespace {

constexpr int kFirstAtlasSize = 1024;
constexpr int kLargestAtlasSize = 8192;
constexpr float kLeastNear = 0.02f;  ///< of a view from a light [m]
/// Share of a cascade over which the next one takes its place.
constexpr float kCascadeBlend = 0.1f;  // as in lib/shadow.glsl

float finite_or(float x, float fallback) {
    return std::isfinite(x) ? x : fallback;
}

/// Texels around a view that its filter may reach.
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

/// What shines has a size; what lies within it casts no shadow.
float near_of(const Shadow& shadow) {
    return std::max(0.5f * shadow.source_size, kLeastNear);
}

/// What the light can reach of what the camera sees; none if that is nothing.
std::optional<ViewSlice>
slice_of(const RenderView& view, const ShadowedLight& light, float distance) {
    const Vec2 widest = widest_tangent(view);
    ViewSlice slice = {view.near, distance, -widest, widest};
    if (light.kind == LightKind::Directional) {
        return slice;
    }
    LightReach reach = {light.position, light.radius};
    if (light.kind == LightKind::Spot) {
        reach.axis = light.axis;
        reach.cosine = std::cos(std::clamp(light.outer_angle, 0.0f, 0.5f * kPi));
    }
    const ReachSphere ball = reach_sphere(reach);
    const LightBounds bounds = light_bounds(view, ball.center, ball.radius);
    if (is_empty(bounds)) {
        return std::nullopt;
    }
    const auto slope = [](int pixel, float jitter, int size, float tangent) {
        const float steady = static_cast<float>(pixel) - jitter;
        return (2 * steady / static_cast<float>(size) - 1) * tangent;
    };
    const Vec2 jitter = view.jitter;
    slice.low.x = slope(bounds.x - 1, jitter.x, view.width, view.tangent.x);
    slice.low.y = slope(bounds.y - 1, jitter.y, view.height, view.tangent.y);
    slice.high.x = slope(bounds.x + bounds.width + 1, jitter.x, view.width, view.tangent.x);
    slice.high.y = slope(bounds.y + bounds.height + 1, jitter.y, view.height, view.tangent.y);
    slice.near = view.near / std::min(bounds.depth_max, 1.0f);
    slice.far = bounds.depth_min > 0 ? double(view.near) / bounds.depth_min : double(distance);
    return slice;
}

std::uint64_t key_of(Entity entity) {
    return static_cast<std::uint64_t>(entity.generation) << 32 | entity.index;
}

}  // namespace

Shadow make_sane(const Shadow& shadow) {
    Shadow sane = shadow;
    const auto resolution = static_cast<unsigned>(std::clamp(shadow.resolution, 16, 4096));
    sane.resolution = static_cast<int>(std::bit_ceil(resolution));
    sane.source_size = std::clamp(finite_or(shadow.source_size, 0.0f), 0.0f, 100.0f);
    sane.cascades = std::clamp(shadow.cascades, 1, kMaxCascades);
    sane.distance = finite_or(shadow.distance, 40.0f);
    sane.distance = sane.distance > 0 ? sane.distance : 40.0f;
    sane.bias = std::clamp(finite_or(shadow.bias, 1.0f), 0.0f, 8.0f);
    if (sane.method == ShadowMethod::Perspective && sane.filter > ShadowFilter::Soft) {
        sane.filter = ShadowFilter::Soft;  // a meter has no one depth in such a map
    }
    return sane;
}

void ShadowCollector::want_cascades(const RenderView& view, LightViews& wanted) {
    const Shadow& settings = wanted.settings;
    const float far = settings.distance;
    const float near = std::min(std::max(view.near, 0.01f * far), 0.5f * far);
    const auto ends = split_cascades(near, far, settings.cascades);
    float begin = 0;
    for (int i = 0; i < settings.cascades; ++i) {
        const float end = ends[static_cast<std::size_t>(i)];
        views_.push_back(make_cascade_view(
            view, -wanted.light->axis, begin, end, settings.resolution, guard_of(settings)));
        begin = (1 - kCascadeBlend) * end;
    }
    wanted.kind = layout::kShadowCascades;
    wanted.splits = {ends[0], ends[1], ends[2], ends[3]};
}

/// False if the light stands where no such view is.
bool ShadowCollector::want_perspective(const RenderView& view, LightViews& wanted) {
    const ShadowedLight& light = *wanted.light;
    const float distance = wanted.settings.distance;
    const std::optional<ViewSlice> slice = slice_of(view, light, distance);
    if (!slice) {
        return false;
    }
    const bool sun = light.kind == LightKind::Directional;
    const Vec4 place = sun ? Vec4(-light.axis, 0) : Vec4(light.position, 1);
    const int guard = guard_of(wanted.settings);
    const auto found =
        make_perspective_view(view, place, *slice, wanted.settings.resolution, guard);
    if (!found) {
        return false;
    }
    views_.push_back(*found);
    wanted.kind = layout::kShadowCascades;  // a single one
    if (sun || !std::isfinite(light.radius)) {
        wanted.splits.x = distance;
    }
    return true;
}

/// Every light's views, in the order of the lights.
void ShadowCollector::want_views(
    const RenderView& view, const LightList& lights, ShadowList& list) {
    views_.clear();
    wanted_.clear();
    for (const ShadowedLight& light : lights.shadowed) {
        LightViews wanted = {
            .light = &light, .key = key_of(light.entity), .settings = make_sane(light.settings)};
        wanted.first_view = views_.size();
        const Shadow& settings = wanted.settings;
        const bool perspective =
            settings.method == ShadowMethod::Perspective && want_perspective(view, wanted);
        const int resolution = settings.resolution;
        const int guard = guard_of(settings);
        if (perspective) {
            // has its one view
        } else if (light.kind == LightKind::Directional) {
            want_cascades(view, wanted);
        } else if (light.kind == LightKind::Spot && light.outer_angle <= kWidestSpotView) {
            wanted.kind = layout::kShadowView;
            views_.push_back(make_spot_view(
                light.position, light.axis, light.outer_angle, near_of(settings), resolution, guard,
                light.right));
        } else {
            wanted.kind = layout::kShadowCube;
            for (int face = 0; face < 6; ++face) {
                views_.push_back(
                    make_cube_view(light.position, face, near_of(settings), resolution, guard));
            }
        }
        wanted.count = views_.size() - wanted.first_view;
        for (std::size_t i = wanted.first_view; i < views_.size(); ++i) {
            views_[i].reach = light.radius;
        }
        wanted_.push_back(wanted);
    }
    for (WaterShadow& water : list.waters) {
        water.record = -1;
        constexpr std::uint64_t kWaters = std::uint64_t{1} << 63;  // apart from lights
        LightViews wanted = {
            .water = &water,
            .key = key_of(water.water) | kWaters | water.part << 60,
            .settings = {.filter = ShadowFilter::Bilinear, .resolution = water.view.resolution},
            .kind = layout::kShadowView,
            .first_view = views_.size(),
            .count = 1};
        views_.push_back(water.view);
        wanted_.push_back(wanted);
    }
}

ShadowCollector::Kept& ShadowCollector::kept(const LightViews& wanted, std::size_t number) {
    return kept_.at({wanted.key, static_cast<int>(number)});
}

/// False if there is no room for all of the light's views.
bool ShadowCollector::place_light(LightViews& wanted) {
    for (std::size_t i = 0; i < wanted.count; ++i) {
        const int size = wanted.settings.resolution;
        const auto [found, fresh] =
            kept_.try_emplace(KeptKey(wanted.key, static_cast<int>(i)), Kept{});
        Kept& view = found->second;
        view.used = true;
        if (!fresh && view.place.size == size) {
            continue;
        }
        if (!fresh) {
            atlas_.release(view.place);
        }
        const std::optional<AtlasRect> place = atlas_.allocate(size);
        if (!place) {
            kept_.erase(found);
            return false;
        }
        view = {.place = *place, .used = true};
    }
    wanted.placed = true;
    return true;
}

void ShadowCollector::release_light(const LightViews& wanted) {
    auto it = kept_.lower_bound({wanted.key, 0});
    while (it != kept_.end() && it->first.first == wanted.key) {
        atlas_.release(it->second.place);
        it = kept_.erase(it);
    }
}

/// Finds room for every view, in an atlas twice as large if need be.
void ShadowCollector::place_views() {
    for (auto& [key, view] : kept_) {
        view.used = false;
    }
    for (const LightViews& wanted : wanted_) {
        for (std::size_t i = 0; i < wanted.count; ++i) {
            const auto found = kept_.find({wanted.key, static_cast<int>(i)});
            if (found != kept_.end()) {
                found->second.used = true;
            }
        }
    }
    for (auto it = kept_.begin(); it != kept_.end();) {
        if (it->second.used) {
            ++it;
        } else {
            atlas_.release(it->second.place);
            it = kept_.erase(it);
        }
    }
    if (atlas_.size() < kFirstAtlasSize && !wanted_.empty()) {
        atlas_ = ShadowAtlas(kFirstAtlasSize);
    }
    for (std::size_t i = 0; i < wanted_.size();) {
        if (place_light(wanted_[i])) {
            ++i;
        } else if (atlas_.size() < kLargestAtlasSize) {
            // The larger one is empty: all views are placed, and drawn, anew.
            atlas_ = ShadowAtlas(2 * atlas_.size());
            kept_.clear();
            i = 0;
        } else {
            release_light(wanted_[i]);
            ++i;
        }
    }
}

void ShadowCollector::write_records(LightList& lights, ShadowList& list) {
    for (const LightViews& wanted : wanted_) {
        if (!wanted.placed) {
            ++list.unserved;
            continue;
        }
        lights.shadows = true;
        list.cubes = list.cubes || wanted.kind == layout::kShadowCube;
        list.cascades = list.cascades || wanted.kind == layout::kShadowCascades;
        const bool soft = wanted.settings.filter >= ShadowFilter::Soft;
        const bool lights_by_it = wanted.water != nullptr || !wanted.light->for_volumes;
        list.soft = list.soft || (soft && lights_by_it);
        if (wanted.water != nullptr) {
            wanted.water->record = static_cast<int>(list.records.size());
        } else {
            lights.records[wanted.light->record].shadow = {
                static_cast<float>(list.records.size()), wanted.kind,
                static_cast<float>(wanted.count), 0};
        }
        for (std::size_t i = 0; i < wanted.count; ++i) {
            list.records.push_back(make_shadow_record(
                views_[wanted.first_view + i], kept(wanted, i).place,
                static_cast<float>(wanted.settings.filter), wanted.settings.source_size,
                wanted.settings.bias));
            list.records.back().splits = wanted.splits;
        }
    }
}

void ShadowCollector::collect(
    const World& world, const RenderView& view, const MeshPool& meshes,
    const MaterialPool& materials, DeformedList& shapes, std::uint64_t assets,
    gpu::RingBuffer& ring, LightList& lights, ShadowList& list) {
    list.records.clear();
    list.due.clear();
    list.unserved = 0;
    list.cubes = list.cascades = list.soft = false;
    want_views(view, lights, list);
    place_views();
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
    for (const ShadowView& one : views_) {
        volumes_.push_back(make_caster_volume(one));
    }
    signatures_.resize(views_.size());
    sign_casters(world, view.alpha, meshes, materials, shapes, volumes_, signatures_);
    for (const LightViews& wanted : wanted_) {
        for (std::size_t i = 0; wanted.placed && i < wanted.count; ++i) {
            const std::size_t v = wanted.first_view + i;
            Kept& map = kept(wanted, i);
            const std::uint64_t signature = hash_combine(signatures_[v], assets);
            if (map.drawn && map.signature == signature
                && map.clip_from_world == views_[v].clip_from_world) {
                continue;
            }
            map.drawn = true;
            map.signature = signature;
            map.clip_from_world = views_[v].clip_from_world;
            layout::ViewBlock block{};
            block.clip_from_world = views_[v].clip_from_world;
            ShadowDraw& draw = list.due.emplace_back();
            draw.place = map.place;
            draw.clamp_depth = views_[v].clamp_depth;
            draw.view_block = ring.push_value(block);
            collector_.collect_casters(
                world, volumes_[v], view.alpha, meshes, materials, shapes, ring, draw.casters);
        }
    }
}

}  // namespace limn
