#include "render/passes/ripple_pass.h"

#include "render/frame_scene.h"
#include "render/gpu/shader_library.h"

namespace limn {
namespace {

constexpr unsigned kRadianceUnit = 0;
constexpr unsigned kFieldUnit = 1;

/// Shifts add up; of the depths behind which they read, the one drawn last counts, the farthest.
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

void draw_ring(gpu::Device& device, const RipplePass& pass, const RingRecord& ring) {
    device.use(gpu::Pipeline{pass.ring, add_shift()});
    pass.ring->set("center", ring.center);
    pass.ring->set("radius", ring.radius);
    pass.ring->set("wavelength", ring.wavelength);
    pass.ring->set("amplitude", ring.amplitude);
    draw_quad(device, *pass.ring, ring.rect);
}

void draw_haze(gpu::Device& device, const RipplePass& pass, const HazeRecord& haze) {
    device.use(gpu::Pipeline{pass.haze, add_shift()});
    pass.haze->set("local_from_world", haze.local_from_world);
    pass.haze->set("is_ball", haze.shape == HazeShape::Ball ? 1 : 0);
    pass.haze->set("most", haze.shift);
    pass.haze->set("scale", haze.scale);
    pass.haze->set("raised", haze.raised);
    pass.haze->set("seed", haze.seed);
    draw_quad(device, *pass.haze, haze.rect);
}

/// Rings and hot air, each list sorted, the nearest first.
void draw_in_depth(gpu::Device& device, const RipplePass& pass, const RippleList& ripples) {
    auto ring = ripples.rings.begin();
    for (const HazeRecord& haze : ripples.hazes) {
        for (; ring != ripples.rings.end() && ring->distance < haze.distance; ++ring) {
            draw_ring(device, pass, *ring);
        }
        draw_haze(device, pass, haze);
    }
    for (; ring != ripples.rings.end(); ++ring) {
        draw_ring(device, pass, *ring);
    }
}

void draw_screens(gpu::Device& device, const RipplePass& pass, const RippleList& ripples) {
    for (const ScreenRecord& screen : ripples.screens) {
        const gpu::Program& program = screen.grid > 1 ? *pass.grid : *pass.screen;
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

void draw_rain(gpu::Device& device, const RipplePass& pass, const RainRecord& record) {
    if (record.rain.amount <= 0) {
        return;
    }
    device.use(gpu::Pipeline{pass.rain, add_shift()});
    pass.rain->set("amount", record.rain.amount);
    pass.rain->set("size", record.rain.size);
    pass.rain->set("speed", record.rain.speed);
    pass.rain->set("strength", record.rain.strength);
    pass.rain->set("seed", record.rain.seed);
    pass.rain->set("time", record.time);
    draw_quad(device, *pass.rain, {-1, -1, 1, 1});
}

}  // namespace

Result<RipplePass> create_ripple_pass(gpu::Device& device) {
    RipplePass pass;
    struct Wanted {
        const gpu::Program*& program;
        const char* vertex;
        const char* fragment;
    };
    for (const Wanted& wanted :
         {Wanted{pass.ring, "ripple_quad.vert", "ripple_ring.frag"},
          Wanted{pass.haze, "ripple_quad.vert", "ripple_haze.frag"},
          Wanted{pass.rain, "ripple_quad.vert", "ripple_rain.frag"},
          Wanted{pass.screen, "ripple_quad.vert", "ripple_screen.frag"},
          Wanted{pass.grid, "ripple_grid.vert", "ripple_grid.frag"},
          Wanted{pass.resolve, "fullscreen.vert", "ripple_resolve.frag"}}) {
        const Result<const gpu::Program*> program =
            device.shaders().load({.vertex = wanted.vertex, .fragment = wanted.fragment});
        if (!program) {
            return program.error();
        }
        wanted.program = *program;
    }
    return pass;
}

TextureId draw_ripples(
    FrameGraph& graph, const RipplePass& pass, const RippleList& ripples, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const TextureId field = graph.create(
        {.name = "ripple.field", .format = GL_RGBA32F, .width = spec.width, .height = spec.height});
    graph.add_pass(
        "ripple field", {gbuffer.depth},
        {cleared(field, {0, 0, 0, 1})},  // all lies behind the near plane
        [&pass, &ripples, &scene, depth = gbuffer.depth](PassContext& context) {
            gpu::Device& device = context.device();
            bind_view(device, scene);
            context.bind_texture(kDepthUnit, depth);
            draw_rain(device, pass, ripples.rain);
            draw_screens(device, pass, ripples);
            draw_in_depth(device, pass, ripples);
        });
    const TextureId rippled = graph.create(
        {.name = "radiance with ripples",
         .format = spec.format,
         .width = spec.width,
         .height = spec.height});
    graph.add_pass(
        "ripple", {radiance, field, gbuffer.depth}, {discarded(rippled)},
        [program = pass.resolve, radiance, field, depth = gbuffer.depth](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            context.bind_texture(kRadianceUnit, radiance);
            context.bind_texture(kFieldUnit, field);
            context.bind_texture(kDepthUnit, depth);
            context.device().draw_fullscreen();
        });
    return rippled;
}

}  // namespace limn
