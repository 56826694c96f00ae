#include "render/passes/particle_shadow_pass.h"

#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/lighting.h"
#include "render/material_pool.h"
#include "render/shadow/shadow_view.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr unsigned kImagesUnit = 0;
constexpr unsigned kMotionsUnit = 1;
constexpr unsigned kParticlesUnit = 2;
constexpr unsigned kLooksUnit = 3;
constexpr unsigned kMapsUnit = 30;
constexpr unsigned kRecordUnit = 31;
constexpr int kSide = 128;             // of the maps [texels]
constexpr int kLayers = 3;             // two of coefficients, one of tints
constexpr float kLeastExtent = 1e-3f;  // of what the maps cover [m]
constexpr int kInSunlight = 1;         // values of PARTICLE_SHADOWS
constexpr int kInSpotlight = 2;

struct Range {
    float low = INFINITY;
    float high = -INFINITY;
};
void grow(Range& range, float middle, float radius) {
    range.low = std::min(range.low, middle - radius);
    range.high = std::max(range.high, middle + radius);
}
float extent(const Range& range) {
    return std::max(range.high - range.low, kLeastExtent);
}

/// Row of an affine map: 0 at `range.low` along `axis`, 1 at its end.
Vec4 row_along(const Vec3& axis, const Range& range) {
    return Vec4(axis, -range.low) / extent(range);
}

/// Two unit vectors perpendicular to `axis` and to each other.
void set_axes(ParticleShadowView& view, const Vec3& axis, const Vec3& near_right) {
    const Vec3 any = std::abs(axis.y) < 0.99f ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    view.right = normalize_or(near_right - glm::dot(near_right, axis) * axis, Vec3(0));
    if (view.right == Vec3(0)) {
        view.right = glm::normalize(glm::cross(axis, any));
    }
    view.up = glm::cross(view.right, axis);
}

bool can_cast(const LookRecord& look) {
    return look[layout::kLookShadow].w > 0 && look[2].w < static_cast<float>(layout::kFacingRibbon)
           && look[2].w != static_cast<float>(ParticleFacing::Pixels);
}

void bind_particle_shadow(PassContext& context, const ParticleShadowEffect& its) {
    context.device().bind_texture(kMapsUnit, its.maps);
    its.record.bind(context.device(), kRecordUnit);
}

}  // namespace

ParticleShadowView
view_from_sun(std::uint32_t record, const Vec3& axis, std::span<const ShadowBall> balls) {
    ParticleShadowView view;
    set_axes(view, axis, Vec3(0));
    Range s;
    Range t;
    Range depth;
    for (const ShadowBall& ball : balls) {
        grow(s, glm::dot(ball.middle, view.right), ball.radius);
        grow(t, glm::dot(ball.middle, view.up), ball.radius);
        grow(depth, glm::dot(ball.middle, axis), ball.radius);
    }
    if (!balls.empty()) {
        // A border that stays empty, so that nothing is smeared beyond the map.
        constexpr float kBorder = 2.0f / kSide;
        grow(s, 0.5f * (s.low + s.high), (0.5f + kBorder) * extent(s));
        grow(t, 0.5f * (t.low + t.high), (0.5f + kBorder) * extent(t));
        view.record[0] = row_along(view.right, s);
        view.record[1] = row_along(view.up, t);
        view.record[2] = row_along(axis, depth);
        view.depth_scale = 1 / extent(depth);
    }
    view.record[3] = {0, 0, 0, 1};
    view.record[4].x = balls.empty() ? -1.0f : static_cast<float>(record);
    return view;
}

ParticleShadowView view_from_spot(const ShadowedLight& spot, std::span<const ShadowBall> balls) {
    ParticleShadowView view;
    set_axes(view, spot.axis, spot.right);
    Range depth;
    for (const ShadowBall& ball : balls) {
        const float ahead = glm::dot(ball.middle - spot.position, spot.axis);
        if (ahead + ball.radius > 0 && ahead - ball.radius < spot.radius) {
            grow(depth, ahead, ball.radius);
        }
    }
    const bool any = depth.low < depth.high;
    if (any) {
        const float tangent = std::max(std::tan(spot.outer_angle), 1e-3f);
        const auto through_eye = [&](const Vec3& v) {
            return Vec4(v, -glm::dot(v, spot.position));
        };
        view.record[3] = through_eye(spot.axis);
        view.record[0] = 0.5f * (through_eye(view.right) / tangent + view.record[3]);
        view.record[1] = 0.5f * (through_eye(view.up) / tangent + view.record[3]);
        view.record[2] = (view.record[3] - Vec4(0, 0, 0, depth.low)) / extent(depth);
        view.depth_scale = 1 / extent(depth);
    }
    view.record[4].x = any ? static_cast<float>(spot.record) : -1.0f;
    return view;
}

Result<ParticleShadowEffect>
ParticleShadowEffect::create(gpu::Device& device, const RenderSettings&) {
    return ParticleShadowEffect{
        ProgramVariants(
            device, {.vertex = "particle_shadow.vert", .fragment = "particle_shadow.frag"}),
        gpu::Texture(
            "particle opacity", {.format = GL_RGBA16F,
                                 .width = kSide,
                                 .height = kSide,
                                 .depth = kLayers,
                                 .target = GL_TEXTURE_2D_ARRAY})};
}

bool ParticleShadowEffect::is_used(const FrameData& frame) {
    bool used = false;
    frame.world->query<const ParticleLook>().each(
        [&](const ParticleLook& look) { used = used || look.shadow > 0; });
    return used;
}

void ParticleShadowEffect::request_views(FrameData& frame) {
    casters.clear();
    balls.clear();
    runs.clear();
    light = 0;
    const auto& lights = frame.data.get<LightList>();
    const auto spot = std::ranges::find_if(lights.shadowed, [](const ShadowedLight& its) {
        return its.kind == LightKind::Spot && its.outer_angle <= kMaxSpotViewAngle;
    });
    const auto* sprites = frame.data.find<ParticleSprites>();
    const bool in_spot = lights.directional == 0 && spot != lights.shadowed.end();
    if (sprites == nullptr || (lights.directional == 0 && !in_spot)) {
        return;
    }
    light = in_spot ? kInSpotlight : kInSunlight;
    for (const ParticleInstance& instance : sprites->instances) {
        const std::uint32_t number = instance.look_and_share >> 16;
        const LookRecord& look = sprites->looks[number];
        const ShadowBall ball = {instance.position, reach_of(instance, look)};
        const float sum = ball.middle.x + ball.middle.y + ball.middle.z + ball.radius;
        if (!can_cast(look) || ball.radius <= 0 || !std::isfinite(sum)) {
            continue;
        }
        if (runs.empty() || runs.back().arrays != sprites->arrays[number]) {
            const int first = static_cast<int>(casters.size());
            runs.push_back({.arrays = sprites->arrays[number], .first = first, .count = 0});
        }
        ++runs.back().count;
        casters.push_back(instance);
        balls.push_back(ball);
    }
    view = in_spot ? view_from_spot(*spot, balls) : view_from_sun(0, -lights.sun_direction, balls);
    record.upload(*frame.ring, view.record);
    texels.upload(*frame.ring, casters);
}

bool ParticleShadowEffect::prepare(const FrameData&, ViewData& its) {
    if (light != 0) {
        its.lighting.variant.add("PARTICLE_SHADOWS", light);
        its.lighting.add_binding<bind_particle_shadow>(*this);
    }
    return light != 0;
}

void ParticleShadowEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    if (light == 0) {
        return;
    }
    const TextureId target = graph.import("particle.opacity", maps);
    const Use writes[] = {
        target_level(cleared(target), 0, 0), target_level(cleared(target), 0, 1),
        target_level(cleared(target), 0, 2)};
    graph.add_pass("particle shadows", {}, writes, [this, &frame](PassContext& context) {
        Variant variant;
        const auto& sprites = frame.data.get<ParticleSprites>();
        variant.add_if(!frame.assets->images.empty(), "IMAGES");
        variant.add_if(sprites.motions, "MOTION");
        const gpu::Program* const program = programs.get(variant);
        if (program == nullptr || view.record[4].x < 0) {
            return;
        }
        gpu::Device& device = context.device();
        device.use(gpu::Pipeline{
            program,
            {.depth = {.test = false, .write = false}, .blend = gpu::kBlendAdd, .cull = GL_NONE}});
        program->set("light_right", view.right);
        program->set("light_up", view.up);
        program->set("depth_scale", view.depth_scale);
        texels.bind(device, kParticlesUnit);
        record.bind(device, kRecordUnit);
        sprites.look_texels->bind(device, kLooksUnit);
        for (const ParticleRun& run : runs) {
            program->set("first", run.first);
            const ImagePool& pool = frame.materials->images();
            if (!frame.assets->images.empty()) {
                device.bind_texture(kImagesUnit, pool.array(run.arrays.images));
            }
            if (sprites.motions) {
                device.bind_texture(kMotionsUnit, pool.array(run.arrays.motions));
            }
            device.draw(GL_TRIANGLE_STRIP, 0, 4, run.count);
        }
    });
}

void ParticleShadowEffect::draw(FrameGraph& graph, const FrameData&, ViewData& its) {
    its.lighting.reads.emplace_back(graph.import("particle.opacity", maps));
}

}  // namespace limn
