#include "render/water/ripple_pass.h"

#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/light/lighting.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/gbuffer_gpu.h"
#include "render/shaders/ripple_gpu.h"
#include "render/shadow/light_bounds.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

// Techniques: post.glare-heat-haze, post.scene-ripple

namespace limn {
namespace {

constexpr double kRainCycle = 1024;  // [s] period of the rain: keeps float time precise enough

/// Screen rectangle of a sphere; nullopt if it is off screen.
std::optional<NdcRect> ndc_rect(const RenderView& view, const Vec3& center, float radius) {
    const LightBounds bounds = light_bounds(view, center, radius);
    if (is_empty(bounds)) {
        return std::nullopt;
    }
    const Vec2 pixel = {
        2.0f / static_cast<float>(view.width), 2.0f / static_cast<float>(view.height)};
    const Vec2 low = Vec2(bounds.x, bounds.y) * pixel - 1.0f;
    return NdcRect(low, low + Vec2(bounds.width, bounds.height) * pixel);
}

float view_distance(const RenderView& view, const Vec3& position) {
    float distance = 0;
    for (int i = 0; i < 3; ++i) {  // the camera looks along -z
        const Vec4& row = view.world_from_camera.row[i];
        distance -= row.z * (position[i] - row.w);
    }
    return distance;
}

void collect_rings(const World& world, const RenderView& view, float ago, RippleList& list) {
    const auto* const jumps = world.find_resource<StepJumps>();
    world.query<const RippleRing, const WorldTransform, Optional<const PreviousWorldTransform>>()
        .each([&](Entity entity, const RippleRing& last, const WorldTransform& now,
                  const PreviousWorldTransform* before) {
            RippleRing ring = last;
            ring.age -= ago;
            const Affine pose = world_at(jumps, entity, now, before, {view.alpha, view.alpha});
            const Vec3 center = {pose.row[0].w, pose.row[1].w, pose.row[2].w};
            const float radius = ring.start_radius + ring.speed * ring.age;
            const float amplitude = ring.amplitude * ripple_fade(ring);
            if (amplitude == 0 || !(ring.wavelength > 0)) {
                return;
            }
            if (const auto rect = ndc_rect(view, center, radius + ring.wavelength)) {
                list.rings.push_back(
                    {*rect, view_distance(view, center), center, radius, ring.wavelength,
                     amplitude});
            }
        });
}

void collect_hazes(const World& world, const RenderView& view, double time, RippleList& list) {
    const auto* const jumps = world.find_resource<StepJumps>();
    world.query<const HeatHaze, const WorldTransform, Optional<const PreviousWorldTransform>>()
        .each([&](Entity entity, const HeatHaze& haze, const WorldTransform& now,
                  const PreviousWorldTransform* before) {
            const Mat4 pose =
                to_mat4(world_at(jumps, entity, now, before, {view.alpha, view.alpha}));
            // The box is within the sphere through its farthest corner.
            float radius = 0;
            for (int corner = 0; corner < 4; ++corner) {
                const Vec4 local(corner % 2 == 0 ? -1 : 1, corner / 2 == 0 ? -1 : 1, 1, 0);
                radius = std::max(radius, glm::length(Vec3(pose * local)));
            }
            const bool flat = !(std::abs(glm::determinant(pose)) > 1e-12f);
            if (haze.strength <= 0 || flat || !(haze.scale > 0)) {
                return;
            }
            const double raised = haze.rise * time / haze.scale;
            if (const auto rect = ndc_rect(view, Vec3(pose[3]), radius)) {
                list.hazes.push_back(
                    {*rect, view_distance(view, Vec3(pose[3])), glm::inverse(pose), haze.shape,
                     haze.strength * static_cast<float>(view.height), haze.scale,
                     static_cast<float>(raised), haze.seed});
            }
        });
}

void collect_screens(const World& world, const RenderView& view, float ago, RippleList& list) {
    world.query<const ScreenRipple>().each([&](const ScreenRipple& last) {
        ScreenRipple ripple = last;
        ripple.age -= ago;
        const float radius = ripple.radius + ripple.radius_speed * ripple.age;
        const float amplitude = ripple.amplitude * ripple_fade(ripple);
        if (amplitude == 0 || radius <= 0) {
            return;
        }
        const float aspect =
            ripple.round ? static_cast<float>(view.width) / static_cast<float>(view.height) : 1.0f;
        list.screens.push_back({ripple.center, radius, amplitude, aspect, ripple.grid});
    });
}

/// Skips ripples that would not change the image.
RippleList collect_ripples(const World& world, const RenderView& view) {
    RippleList list;
    const auto* clock = world.find_resource<FrameTime>();
    const float ago = clock != nullptr ? (1.0f - view.alpha) * clock->step : 0.0f;
    const double time = clock != nullptr ? clock->time - ago : 0.0;
    collect_rings(world, view, ago, list);
    collect_hazes(world, view, time, list);
    const auto nearer = [](const auto& a, const auto& b) { return a.distance < b.distance; };
    std::stable_sort(list.rings.begin(), list.rings.end(), nearer);
    std::stable_sort(list.hazes.begin(), list.hazes.end(), nearer);
    collect_screens(world, view, ago, list);
    const auto* rain = world.find_resource<LensRain>();
    if (rain != nullptr && rain->amount > 0 && rain->strength > 0) {
        list.rain = {*rain, static_cast<float>(std::fmod(time, kRainCycle))};
    }
    return list;
}

/// Offsets are summed; the depth limit is that of the ripple drawn last, the farthest.
constexpr gpu::PipelineState add_shift() {
    gpu::PipelineState state = gpu::kFullscreenState;
    state.blend = gpu::kBlendAdd;
    state.blend.destination_alpha = GL_ZERO;
    return state;
}

void draw_quad(gpu::Device& device, const gpu::Program& program, const NdcRect& rect) {
    program.set("rect", rect);
    device.draw(GL_TRIANGLE_STRIP, 0, 4);
}

void draw_ring(gpu::Device& device, const RippleEffect& effect, const RingRecord& ring) {
    device.use(gpu::Pipeline{effect.ring, add_shift()});
    effect.ring->set("center", ring.center);
    effect.ring->set("radius", ring.radius);
    effect.ring->set("wavelength", ring.wavelength);
    effect.ring->set("amplitude", ring.amplitude);
    draw_quad(device, *effect.ring, ring.rect);
}

void draw_haze(gpu::Device& device, const RippleEffect& effect, const HazeRecord& haze) {
    device.use(gpu::Pipeline{effect.haze, add_shift()});
    effect.haze->set("local_from_world", haze.local_from_world);
    effect.haze->set("is_ball", haze.shape == HazeShape::Ball ? 1 : 0);
    effect.haze->set("max_shift", haze.shift);
    effect.haze->set("scale", haze.scale);
    effect.haze->set("raised", haze.raised);
    effect.haze->set("seed", haze.seed);
    draw_quad(device, *effect.haze, haze.rect);
}

/// Rings and hot air merged by distance, nearest first.
void draw_in_depth(gpu::Device& device, const RippleEffect& effect) {
    auto ring = effect.ripples.rings.begin();
    for (const HazeRecord& haze : effect.ripples.hazes) {
        for (; ring != effect.ripples.rings.end() && ring->distance < haze.distance; ++ring) {
            draw_ring(device, effect, *ring);
        }
        draw_haze(device, effect, haze);
    }
    for (; ring != effect.ripples.rings.end(); ++ring) {
        draw_ring(device, effect, *ring);
    }
}

void draw_screens(gpu::Device& device, const RippleEffect& effect) {
    for (const ScreenRecord& screen : effect.ripples.screens) {
        const gpu::Program& program = screen.grid > 1 ? *effect.grid : *effect.screen;
        device.use(gpu::Pipeline{&program, add_shift()});
        program.set("center", screen.center);
        program.set("radius", screen.radius);
        program.set("amplitude", screen.amplitude);
        program.set("aspect", screen.aspect);
        program.set("points", screen.grid);
        if (screen.grid > 1) {
            const int cells = screen.grid - 1;
            device.draw(GL_TRIANGLES, 0, 6 * cells * cells);
        } else {
            draw_quad(device, program, {-1, -1, 1, 1});
        }
    }
}

void draw_rain(gpu::Device& device, const RippleEffect& effect, const RainRecord& record) {
    if (record.rain.amount <= 0) {
        return;
    }
    device.use(gpu::Pipeline{effect.rain, add_shift()});
    effect.rain->set("amount", record.rain.amount);
    effect.rain->set("size", record.rain.size);
    effect.rain->set("speed", record.rain.speed);
    effect.rain->set("strength", record.rain.strength);
    effect.rain->set("seed", record.rain.seed);
    effect.rain->set("time", record.time);
    draw_quad(device, *effect.rain, {-1, -1, 1, 1});
}

}  // namespace

Result<RippleEffect> RippleEffect::create(gpu::Device& device, const RenderSettings&) {
    const auto load_quad = [&](const char* fragment) {
        return device.shaders().load({.vertex = "ripple_quad.vert", .fragment = fragment});
    };
    return RippleEffect{
        .ring = LIMN_TRY(load_quad("ripple_ring.frag")),
        .haze = LIMN_TRY(load_quad("ripple_haze.frag")),
        .rain = LIMN_TRY(load_quad("ripple_rain.frag")),
        .screen = LIMN_TRY(load_quad("ripple_screen.frag")),
        .grid = LIMN_TRY(
            device.shaders().load({.vertex = "ripple_grid.vert", .fragment = "ripple_grid.frag"})),
        .resolve = LIMN_TRY(load_fullscreen(device, "ripple_resolve.frag"))};
}

bool RippleEffect::is_used(const FrameData& frame) {
    const World& world = *frame.world;
    return world.find_resource<LensRain>() != nullptr || !world.query<const RippleRing>().empty()
           || !world.query<const HeatHaze>().empty() || !world.query<const ScreenRipple>().empty();
}

bool RippleEffect::prepare(const FrameData& frame, ViewData& view) {
    ripples = collect_ripples(*frame.world, view.camera);
    return !ripples.empty();
}

void RippleEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const TextureId depth = view.gbuffer.depth;
    const TextureId field =
        create_target(graph, "ripple.field", GL_RGBA32F, size_of(graph, view.radiance));
    graph.add_pass(
        "ripple field", {sampled(depth, layout::kDepthUnit)},
        {cleared(field, {0, 0, 0, 1})},  // depth limit: the near plane
        [this, &view](PassContext& context) {
            bind_view(context, view);
            draw_rain(context.device(), *this, ripples.rain);
            draw_screens(context.device(), *this);
            draw_in_depth(context.device(), *this);
        });
    const TextureId rippled = create_like(graph, "radiance with ripples", view.radiance);
    add_fullscreen_pass(
        graph, "ripple",
        {sampled(view.radiance, layout::kSourceUnit), sampled(field, layout::kRippleFieldUnit),
         sampled(depth, layout::kDepthUnit)},
        {discarded(rippled)}, resolve);
    view.radiance = rippled;
}

}  // namespace limn
