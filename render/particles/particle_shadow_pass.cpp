#include "render/particles/particle_shadow_pass.h"

#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/light/lighting.h"
#include "render/material/material_pool.h"
#include "render/shaders/particle_gpu.h"
#include "render/shadow/shadow_view.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

// Techniques: particle.gpu-shadow, particle.shadow
// Source of particle.gpu-shadow: Jansen and Bavoil 2010

namespace limn {
namespace {

constexpr int kShadowSide = 128;     // of the maps [texels]
constexpr int kLayers = 3;           // two of coefficients, one of tints
constexpr float kMinExtent = 1e-3f;  // of what the maps cover [m]
constexpr float kShadowBorder =
    2.0f / kShadowSide;         // kept empty around the casters, as a fraction of the map
constexpr int kInSunlight = 1;  // values of PARTICLE_SHADOWS
constexpr int kInSpotlight = 2;

/// As ordered() of particle_shadow_fit.comp.
std::uint32_t ordered(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

void grow(ShadowRange& range, float center, float radius) {
    range.low = std::min(range.low, center - radius);
    range.high = std::max(range.high, center + radius);
}
float extent(const ShadowRange& range) {
    return std::max(range.high - range.low, kMinExtent);
}

/// Row of an affine map: 0 at `range.low` along `axis`, 1 at `range.high`.
Vec4 row_along(const Vec3& axis, const ShadowRange& range) {
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
    view.axis = axis;
}

bool can_cast(const LookRecord& look) {
    return look[layout::kLookShadow].w > 0 && look[2].w < static_cast<float>(layout::kFacingRibbon)
           && look[2].w != static_cast<float>(ParticleFacing::Pixels);
}

void bind_particle_shadow(PassContext& context, const ParticleShadowEffect& effect) {
    context.device().bind_texture(layout::kParticleOpacityUnit, effect.maps);
    (effect.gpu_casters.empty() ? effect.record : effect.fitted)
        .bind(context.device(), layout::kParticleShadowUnit);
}

}  // namespace

ParticleShadowView
view_from_sun(std::uint32_t record, const Vec3& axis, std::span<const ShadowBall> balls) {
    ParticleShadowView view;
    set_axes(view, axis, Vec3(0));
    ShadowRange s;
    ShadowRange t;
    ShadowRange depth;
    for (const ShadowBall& ball : balls) {
        grow(s, glm::dot(ball.center, view.right), ball.radius);
        grow(t, glm::dot(ball.center, view.up), ball.radius);
        grow(depth, glm::dot(ball.center, axis), ball.radius);
    }
    view.ranges = {s, t, depth};
    if (!balls.empty()) {
        grow(s, 0.5f * (s.low + s.high), (0.5f + kShadowBorder) * extent(s));
        grow(t, 0.5f * (t.low + t.high), (0.5f + kShadowBorder) * extent(t));
        view.record[0] = row_along(view.right, s);
        view.record[1] = row_along(view.up, t);
        view.record[2] = row_along(axis, depth);
    }
    view.record[3] = {0, 0, 0, 1};
    const float light = static_cast<float>(record);
    view.record[4] = {balls.empty() ? -1.0f : light, 1 / extent(depth), light, 0};
    return view;
}

ParticleShadowView view_from_spot(const ShadowedLight& spot, std::span<const ShadowBall> balls) {
    ParticleShadowView view;
    set_axes(view, spot.axis, spot.right);
    view.origin = spot.position;
    view.spot_range = spot.radius;
    ShadowRange depth;
    for (const ShadowBall& ball : balls) {
        const float ahead = glm::dot(ball.center - spot.position, spot.axis);
        if (ahead + ball.radius > 0 && ahead - ball.radius < spot.radius) {
            grow(depth, ahead, ball.radius);
        }
    }
    view.ranges[2] = depth;
    const bool any = depth.low < depth.high;
    const float tangent = std::max(std::tan(spot.outer_angle), 1e-3f);
    const auto through_eye = [&](const Vec3& v) { return Vec4(v, -glm::dot(v, spot.position)); };
    view.record[3] = through_eye(spot.axis);
    view.record[0] = 0.5f * (through_eye(view.right) / tangent + view.record[3]);
    view.record[1] = 0.5f * (through_eye(view.up) / tangent + view.record[3]);
    const float light = static_cast<float>(spot.record);
    view.record[4] = {any ? light : -1.0f, 1, light, 0};
    if (any) {
        view.record[2] = (view.record[3] - Vec4(0, 0, 0, depth.low)) / extent(depth);
        view.record[4].y = 1 / extent(depth);
    }
    return view;
}

Result<ParticleShadowEffect>
ParticleShadowEffect::create(gpu::Device& device, const RenderSettings&) {
    constexpr std::size_t kRanges = 6 * sizeof(std::uint32_t);
    constexpr std::size_t kRecord = layout::kParticleShadowTexels * sizeof(Vec4);
    ParticleShadowEffect effect{
        ProgramVariants(
            device, {.vertex = "particle_shadow.vert", .fragment = "particle_shadow.frag"}),
        LIMN_TRY(device.shaders().load({.compute = "particle_shadow_fit.comp"})),
        LIMN_TRY(device.shaders().load(
            {.compute = "particle_shadow_fit.comp", .defines = {{"RECORD"}}})),
        gpu::Texture(
            "particle opacity", {.format = GL_RGBA16F,
                                 .width = kShadowSide,
                                 .height = kShadowSide,
                                 .depth = kLayers,
                                 .target = GL_TEXTURE_2D_ARRAY}),
        gpu::Buffer("particle shadow ranges", kRanges, gpu::BufferUse::Dynamic),
        gpu::Buffer("fitted particle shadow", kRecord, gpu::BufferUse::GpuOnly)};
    effect.fitted.set(effect.fitted_record);
    return effect;
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
    gpu_casters.clear();
    light = 0;
    const auto& lights = frame.data.get<LightList>();
    const auto spot = std::ranges::find_if(lights.shadowed, [](const ShadowedLight& shadowed) {
        return shadowed.kind == LightKind::Spot && shadowed.outer_angle <= kMaxSpotViewAngle;
    });
    const auto* sprites = frame.data.find<ParticleSprites>();
    const bool in_spot = lights.directional == 0 && spot != lights.shadowed.end();
    if (sprites == nullptr || (lights.directional == 0 && !in_spot)) {
        return;
    }
    light = in_spot ? kInSpotlight : kInSunlight;
    for (const ParticleInstance& instance : sprites->instances) {
        const std::uint32_t number = instance.look_and_life >> 16;
        const LookRecord& look = sprites->looks[number];
        const ShadowBall ball = {instance.position, corner_radius(instance, look)};
        const float sum = ball.center.x + ball.center.y + ball.center.z + ball.radius;
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
    for (const auto& [entity, pool] : sprites->gpu->pools()) {
        if (pool->count > 0 && can_cast(sprites->looks[pool->look])) {
            gpu_casters.push_back({pool.get(), sprites->arrays[pool->look]});
        }
    }
    view = in_spot ? view_from_spot(*spot, balls) : view_from_sun(0, -lights.sun_direction, balls);
    record.upload(*frame.ring, view.record);
    texels.upload(*frame.ring, casters);
}

bool ParticleShadowEffect::prepare(const FrameData&, ViewData& drawn_view) {
    if (light != 0) {
        drawn_view.lighting.variant.add("PARTICLE_SHADOWS", light);
        drawn_view.lighting.add_binding<bind_particle_shadow>(*this);
    }
    return light != 0;
}

/// Widens the ranges of the view to the casters that the GPU moves, and writes the record for them.
void ParticleShadowEffect::fit_to_gpu_casters(FrameGraph& graph, const ParticleSprites& sprites) {
    sprites.gpu->update(graph, *sprites.gpu_view);
    std::uint32_t words[6];
    for (std::size_t i = 0; i < 3; ++i) {
        words[i] = ordered(view.ranges[i].low);
        words[3 + i] = ordered(view.ranges[i].high);
    }
    ranges.write<std::uint32_t>(0, words);
    std::vector<Use> reads;
    for (const GpuShadowCaster& caster : gpu_casters) {
        reads.emplace_back(graph.import("particles", caster.pool->instances));
    }
    const Use writes[] = {
        graph.import("particle shadow ranges", ranges),
        graph.import("fitted particle shadow", fitted_record)};
    graph.add_pass("particle shadow range", reads, writes, [this, &sprites](PassContext& context) {
        gpu::Device& device = context.device();
        const auto begin = [&](const gpu::Program& program) {
            device.use(program);
            program.set("light_right", view.right);
            program.set("light_up", view.up);
            program.set("light_axis", view.axis);
            program.set("origin", view.origin);
            program.set("spot_range", view.spot_range);
            device.bind_storage(layout::kShadowRangesBinding, ranges);
        };
        begin(*find_ranges);
        sprites.look_texels->bind(device, layout::kLooksUnit);
        for (const GpuShadowCaster& caster : gpu_casters) {
            constexpr std::uint32_t kMaxGroups = 16;  // whose invocations loop over particles
            const std::uint32_t groups = std::min(
                (caster.pool->count + layout::kParticleGroup - 1) / layout::kParticleGroup,
                kMaxGroups);
            caster.pool->texels.bind(device, layout::kParticlesUnit);
            find_ranges->set("count", caster.pool->count);
            find_ranges->set("stride", groups * layout::kParticleGroup);
            device.dispatch(groups);
        }
        device.storage_barrier();
        begin(*write_record);
        write_record->set("border", kShadowBorder);
        write_record->set("min_extent", kMinExtent);
        record.bind(device, layout::kParticleShadowUnit);
        device.bind_storage(layout::kShadowRecordBinding, fitted_record);
        device.dispatch(1);
    });
}

void ParticleShadowEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    if (light == 0) {
        return;
    }
    std::vector<Use> reads;
    if (!gpu_casters.empty()) {
        fit_to_gpu_casters(graph, frame.data.get<ParticleSprites>());
        reads.emplace_back(graph.import("fitted particle shadow", fitted_record));
        for (const GpuShadowCaster& caster : gpu_casters) {
            reads.emplace_back(graph.import("particles", caster.pool->instances));
        }
    }
    const TextureId target = graph.import("particle.opacity", maps);
    const Use writes[] = {
        target_level(cleared(target), 0, 0), target_level(cleared(target), 0, 1),
        target_level(cleared(target), 0, 2)};
    graph.add_pass("particle shadows", reads, writes, [this, &frame](PassContext& context) {
        draw_casters(context, frame);
    });
}

void ParticleShadowEffect::draw_casters(PassContext& context, const FrameData& frame) {
    const auto& sprites = frame.data.get<ParticleSprites>();
    const ImagePool& images = frame.materials->images();
    Variant variant;
    sprites.features.add_to(variant);
    const gpu::Program* const program = programs.get(variant);
    if (program == nullptr || (view.record[4].x < 0 && gpu_casters.empty())) {
        return;
    }
    gpu::Device& device = context.device();
    device.use(gpu::Pipeline{
        program,
        {.depth = {.test = false, .write = false}, .blend = gpu::kBlendAdd, .cull = GL_NONE}});
    program->set("light_right", view.right);
    program->set("light_up", view.up);
    (gpu_casters.empty() ? record : fitted).bind(device, layout::kParticleShadowUnit);
    sprites.look_texels->bind(device, layout::kLooksUnit);
    const auto bind_images = [&](const ParticleArrays& arrays) {
        if (sprites.features.images) {
            device.bind_texture(layout::kSpriteImagesUnit, images.array(arrays.images));
        }
        if (sprites.features.motions) {
            device.bind_texture(layout::kSpriteMotionsUnit, images.array(arrays.motions));
        }
    };
    texels.bind(device, layout::kParticlesUnit);
    for (const ShadowCasters& run : runs) {
        program->set("first", run.first);
        bind_images(run.arrays);
        device.draw_quads(run.count);
    }
    program->set("first", 0);
    for (const GpuShadowCaster& caster : gpu_casters) {
        bind_images(caster.arrays);
        caster.pool->texels.bind(device, layout::kParticlesUnit);
        device.draw_quads(static_cast<int>(caster.pool->count));
    }
}

void ParticleShadowEffect::draw(FrameGraph& graph, const FrameData&, ViewData& drawn_view) {
    drawn_view.lighting.reads.emplace_back(graph.import("particle.opacity", maps));
    if (!gpu_casters.empty()) {
        drawn_view.lighting.reads.emplace_back(
            graph.import("fitted particle shadow", fitted_record));
    }
}

}  // namespace limn
