#include "render/shadow/volume_list.h"

#include "ecs/base/log.h"
#include "ecs/components/shadow.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/material/relief_hook.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <tuple>

// Techniques: shadow.caster-cull, shadow.closed-mesh, shadow.relief-stencil, shadow.selection,
//     shadow.stencil-pass

namespace limn {
namespace {

constexpr std::uint32_t kPrism = 4;
constexpr std::uint32_t kZFail = 2;
constexpr std::uint32_t kMirrored = 1;

/// Enlarges a finite light range slightly, so that rounding at its border causes no false shadow.
constexpr float kVolumeRim = 1.001f;

LightRange volume_range(const ShadowedLight& light) {
    if (light.kind == LightKind::Directional) {
        return {{0, 0, 0}, INFINITY};
    }
    LightRange range = {light.position, light.radius * kVolumeRim};
    if (light.kind == LightKind::Spot) {
        range.axis = light.axis;
        range.cosine = std::cos(std::clamp(light.outer_angle, 0.0f, 0.5f * kPi)) / kVolumeRim;
    }
    return range;
}

Vec4 homogeneous(const ShadowedLight& light) {
    return light.kind == LightKind::Directional ? Vec4(-light.axis, 0) : Vec4(light.position, 1);
}

/// Depth of the relief of a material on an instance [m]; 0 without one.
float relief_depth_of(
    const Assets& assets, MaterialId material, const glm::dmat4& world_from_mesh) {
    if (material.index >= assets.materials.size()) {
        return 0;
    }
    const double scale = std::cbrt(std::abs(glm::determinant(world_from_mesh)));
    return depth_below_mesh(assets.materials[material.index]) * static_cast<float>(scale);
}

bool has_holes(const Material& material) {
    return material.alpha_mode == AlphaMode::Mask
           || (material.detail == SurfaceDetail::DoubleDepth && depth_below_mesh(material) > 0);
}

layout::VolumeBlock make_block(const ShadowVolume& settings, const Vec4& light, float radius) {
    float extrusion = layout::kExtrudeInfinite;
    float distance = std::max(settings.distance, 0.01f);
    switch (settings.extrusion) {
    case Extrusion::Infinite:
        break;
    case Extrusion::Constant:
        extrusion = layout::kExtrudeConstant;
        break;
    case Extrusion::Radius:
        extrusion = std::isfinite(radius) ? layout::kExtrudeRadius : extrusion;
        distance = radius;
        break;
    case Extrusion::Plane:
        // With shared corners, one corner cannot be extruded to several planes.
        extrusion = std::isfinite(radius) && settings.kind == VolumeKind::PerTriangle
                        ? layout::kExtrudePlane
                        : extrusion;
        distance = radius;
        break;
    }
    return {light, {extrusion, distance, std::max(settings.cap_bias, 0.0f), radius}};
}

/// Smallest and largest of dot(n, p) over the box.
struct Interval {
    float low;
    float high;
};
Interval project(const Bounds& box, const Vec3& n) {
    const float mid = glm::dot(n, center(box));
    const float half = glm::dot(glm::abs(n), half_extent(box));
    return {mid - half, mid + half};
}

}  // namespace

ShadowMethod choose_shadow_method(ShadowMethod requested, bool has_volume) {
    if (requested != ShadowMethod::Auto) {
        return requested;
    }
    return has_volume ? ShadowMethod::Volume : ShadowMethod::Map;
}

bool shadow_may_contain(const Bounds& box, const Vec4& light, const Vec3& center, float radius) {
    // The shadow of the box lies behind it as viewed from the light: test whether the segment from
    // the sphere's center to the light hits the box, enlarged by the radius.
    const Vec3 low = box.min - Vec3(radius);
    const Vec3 high = box.max + Vec3(radius);
    const Vec3 to_light = Vec3(light) - center * light.w;
    float enter = 0;
    float leave = light.w > 0 ? 1.0f : INFINITY;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(to_light[i]) < 1e-20f) {
            if (center[i] < low[i] || center[i] > high[i]) {
                return false;
            }
            continue;
        }
        const float a = (low[i] - center[i]) / to_light[i];
        const float b = (high[i] - center[i]) / to_light[i];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * 1.00001f + 1e-6f;
}

bool shadow_is_outside(const Bounds& box, const Vec4& light, const Frustum& frustum) {
    for (const Vec4& plane : frustum.planes) {
        // Outside the plane, with the shadow extending away from it.
        const Vec3 n = Vec3(plane);
        const Interval along = project(box, n);
        const bool away = along.high * light.w <= glm::dot(n, Vec3(light));
        if (along.high + plane.w < 0 && away) {
            return true;
        }
    }
    return false;
}

void VolumeCollector::collect(
    const RenderItems& items, const RenderView& view, gpu::RingBuffer& ring, LightList& lights,
    VolumeList& list) {
    const World& world = items.world();
    list = {};
    list.meshes = &meshes_;
    casters_.clear();
    find_candidates(world, lights);
    const auto* assets = world.find_resource<Assets>();
    if (candidates_.empty() || assets == nullptr) {
        return;
    }
    find_casters(items, view);

    // Layers in the order of the records; lights whose range is off screen or without casters need
    // none.
    std::vector<std::size_t> taken;
    std::vector<std::uint32_t> layer_of(candidates_.size(), ~0u);
    std::vector<bool> shades(candidates_.size(), false);
    for (const Caster& caster : casters_) {
        shades[caster.light] = true;
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        Candidate& candidate = candidates_[i];
        ShadowedLight& light = lights.shadowed[candidate.shadowed];
        const bool hybrid = light.settings.method == ShadowMethod::Hybrid;
        const RangeSphere sphere = range_sphere(candidate.range);
        const LightBounds bounds = light_bounds(view, sphere.center, sphere.radius);
        const bool needed = shades[i] && !is_empty(bounds);
        if (candidate.served && needed
            && list.lights.size() == static_cast<std::size_t>(kMaxVolumeLights)) {
            refuse(
                candidate, "shadow volumes: more than " + std::to_string(kMaxVolumeLights)
                               + " lights use them; the others use shadow maps");
        }
        if (!candidate.served) {
            light.settings.method = ShadowMethod::Map;
            ++list.unserved;
            continue;
        }
        if (needed) {
            layer_of[i] = static_cast<std::uint32_t>(list.lights.size());
            VolumeLight& added = list.lights.emplace_back();
            added.record = light.record;
            added.hybrid = hybrid;
            added.bounds = bounds;
            added.block = ring.push_value(
                make_block(candidate.settings, candidate.light, candidate.range.radius));
        }
        if (hybrid && needed) {
            light.settings.method = ShadowMethod::Map;
            light.settings.filter = ShadowFilter::Soft;  // edge width of shadow_classify.frag
            light.for_volumes = true;
        } else {
            if (needed) {
                lights.records[light.record].shadow = {
                    static_cast<float>(layer_of[i]), layout::kShadowMask, 1, 0};
                lights.shadows = true;
            }
            taken.push_back(candidate.shadowed);
        }
    }
    std::erase_if(casters_, [&](const Caster& caster) { return layer_of[caster.light] == ~0u; });
    for (Caster& caster : casters_) {
        caster.light = layer_of[caster.light];
    }
    for (std::size_t i = taken.size(); i-- > 0;) {
        lights.shadowed.erase(lights.shadowed.begin() + static_cast<std::ptrdiff_t>(taken[i]));
    }
    write_draws(*assets, ring, list);
}

void VolumeCollector::assign_hybrid_masks(LightList& lights, VolumeList& list) {
    for (std::size_t i = 0; i < list.lights.size(); ++i) {
        VolumeLight& light = list.lights[i];
        if (!light.hybrid) {
            continue;
        }
        Vec4& shadow = lights.records[light.record].shadow;
        light.map = shadow;
        light.hybrid =
            shadow.y != layout::kShadowNone;  // its map does not fit into the atlas: volumes only
        shadow = {static_cast<float>(i), layout::kShadowMask, 1, 0};
        lights.shadows = true;
    }
}

void VolumeCollector::find_candidates(const World& world, const LightList& lights) {
    candidates_.clear();
    for (std::size_t i = 0; i < lights.shadowed.size(); ++i) {
        const ShadowedLight& light = lights.shadowed[i];
        const auto* settings = world.find<ShadowVolume>(light.entity);
        const ShadowMethod method =
            choose_shadow_method(light.settings.method, settings != nullptr);
        if (method != ShadowMethod::Volume && method != ShadowMethod::Hybrid) {
            continue;
        }
        Candidate& candidate = candidates_.emplace_back();
        candidate.shadowed = i;
        if (settings != nullptr) {
            candidate.settings = *settings;
        }
        candidate.light = homogeneous(light);
        candidate.range = volume_range(light);
    }
}

void VolumeCollector::find_casters(const RenderItems& items, const RenderView& view) {
    const Frustum frustum = make_frustum(view.clip_from_world);
    for (std::size_t b = 0; b < items.block_count(); ++b) {
        const RenderItemBlock& block = items.block(b);
        for (std::uint32_t i = 0; block.casts_shadows && i < block.size(); ++i) {
            const bool solid = !is_blended(block.keys[i]) && block.shells.empty();
            if (block.is_drawable(i) && solid) {
                add_item(items, block, i, view, frustum);
            }
        }
    }
}

void VolumeCollector::add_item(
    const RenderItems& items, const RenderItemBlock& block, std::uint32_t i, const RenderView& view,
    const Frustum& frustum) {
    const auto& assets = items.world().resource<Assets>();
    const MeshInstance& surface = block.surfaces[i];
    const DrawState state = draw_state(block.keys[i]);
    const Bounds box = block.box(i);
    for (Candidate& candidate : candidates_) {
        if (!candidate.served || !reaches_box(candidate.range, box)) {
            continue;
        }
        const bool displaced = is_tessellated(items.materials().batch(state.batch).features);
        if (state.inflated || state.deformed || displaced) {
            refuse(
                candidate, "shadow volumes: mesh " + assets.meshes[surface.mesh.index].name
                               + (state.deformed   ? " is deformed"
                                  : state.inflated ? " is inflated"
                                                   : " is displaced")
                               + "; lights that reach it use shadow maps");
        } else {
            add_caster(
                candidate, view, frustum, assets, surface, block.world_at(i, items.time()), box);
        }
    }
}

void VolumeCollector::add_caster(
    Candidate& candidate, const RenderView& view, const Frustum& frustum, const Assets& assets,
    const MeshInstance& surface, const Affine& world_from_mesh, const Bounds& box) {
    const ShadowVolume& settings = candidate.settings;
    const ManifoldReport& report = meshes_.report(assets, surface.mesh);
    if (report.triangles == 0) {
        return;
    }
    const bool closed = is_closed(report);
    if (settings.kind == VolumeKind::PerEdge) {
        if (!closed) {
            refuse(
                candidate, "shadow volumes: mesh " + assets.meshes[surface.mesh.index].name
                               + " is not closed (" + describe(report)
                               + "); lights that reach it use shadow maps");
            return;
        }
        if (surface.material.index < assets.materials.size()
            && has_holes(assets.materials[surface.material.index])) {
            refuse(
                candidate, "shadow volumes: material "
                               + assets.materials[surface.material.index].name
                               + " has holes and cannot cast volumes; lights that reach it use "
                                 "shadow maps");
            return;
        }
    }
    const glm::dmat4 world_matrix = to_mat4(world_from_mesh);
    const double determinant = glm::determinant(world_matrix);
    if (determinant == 0 || shadow_is_outside(box, candidate.light, frustum)) {
        return;
    }
    const auto& camera = view.world_from_camera.row;
    const Vec3 eye = {camera[0].w, camera[1].w, camera[2].w};
    const float to_corner = view.near * glm::length(Vec3(widest_tangent(view), 1));
    const float relief = relief_depth_of(assets, surface.material, world_matrix);
    const bool may_contain_eye = shadow_may_contain(
        box, candidate.light, eye, 1.01f * to_corner + std::max(settings.cap_bias, 0.0f));
    const bool z_fail = settings.mode == StencilMode::ZFail
                        || (settings.mode == StencilMode::Auto && may_contain_eye);
    const bool prism = settings.kind == VolumeKind::PerTriangle || !closed;

    Caster& caster = casters_.emplace_back();
    caster.light = static_cast<std::uint32_t>(&candidate - candidates_.data());
    caster.state = (prism ? kPrism : 0) | (z_fail ? kZFail : 0) | (determinant < 0 ? kMirrored : 0);
    caster.mesh = surface.mesh.index;
    // With z-pass the caps of an infinite volume are never visible: the caster hides them.
    caster.caps = z_fail || prism || settings.extrusion != Extrusion::Infinite || relief > 0;
    for (int i = 0; i < 3; ++i) {
        caster.instance.row[i] = world_from_mesh.row[i];
    }
    caster.instance.relief = {relief, 0, 0, 0};
    caster.instance.light = Vec4(glm::inverse(world_matrix) * glm::dvec4(candidate.light));
}

void VolumeCollector::refuse(Candidate& candidate, const std::string& why) {
    candidate.served = false;
    if (reported_.insert(why).second) {
        log_warn("{}", why);
    }
}

void VolumeCollector::write_draws(const Assets& assets, gpu::RingBuffer& ring, VolumeList& list) {
    const auto key = [](const Caster& c) { return std::tuple(c.light, c.state, c.mesh, c.caps); };
    std::stable_sort(casters_.begin(), casters_.end(), [&](const Caster& a, const Caster& b) {
        return key(a) < key(b);
    });
    list.casters = static_cast<int>(casters_.size());
    list.instances = ring.allocate(
        casters_.size() * sizeof(layout::VolumeInstance), sizeof(layout::VolumeInstance));
    auto* instances = reinterpret_cast<layout::VolumeInstance*>(list.instances.data);
    commands_.clear();
    for (std::size_t begin = 0; begin < casters_.size();) {
        std::size_t end = begin;
        for (; end < casters_.size() && key(casters_[end]) == key(casters_[begin]); ++end) {
            instances[end] = casters_[end].instance;
        }
        const Caster& first = casters_[begin];
        const bool prism = (first.state & kPrism) != 0;
        const VolumeRange& range = prism ? meshes_.triangle_volume(assets, {first.mesh})
                                         : meshes_.edge_volume(assets, {first.mesh});
        const std::uint32_t skipped = first.caps ? 0 : range.cap_indices;
        const bool same_light = begin > 0 && casters_[begin - 1].light == first.light;
        VolumeLight& light = list.lights[first.light];
        if (!same_light) {
            light.first_run = static_cast<std::uint32_t>(list.runs.size());
        }
        if (!same_light || casters_[begin - 1].state != first.state) {
            list.runs.push_back(
                {prism, (first.state & kZFail) != 0, (first.state & kMirrored) != 0,
                 static_cast<std::uint32_t>(commands_.size()), 0});
            ++light.run_count;
        }
        ++list.runs.back().command_count;
        commands_.push_back(
            {range.index_count - skipped, static_cast<std::uint32_t>(end - begin),
             range.first_index + skipped, range.base_vertex, static_cast<std::uint32_t>(begin)});
        list.triangles +=
            static_cast<std::int64_t>((range.index_count - skipped) / 3) * (end - begin);
        begin = end;
    }
    list.commands = ring.push(std::span<const DrawCommand>(commands_));
}

}  // namespace limn
