#include "render/passes/forward_pass.h"

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"

namespace limn {
namespace {

constexpr std::uint32_t kObjectLights = 1u << 16;  ///< beside lighting_key()
constexpr std::uint32_t kDirectional = 1u << 17;
constexpr int kTurns = 255;  ///< that the stencil can tell apart

/// For the nearest surface, and of several there for one in each turn: from kTurns to the next
/// multiple the stencil must be made 0 again.
gpu::PipelineState nearest_once(int turn) {
    const gpu::StencilFace other_turns = {.func = GL_NOTEQUAL, .pass = GL_REPLACE};
    return {
        .depth = {.write = false, .func = GL_EQUAL},
        .stencil = {
            .test = true,
            .reference = static_cast<std::uint8_t>(1 + turn % kTurns),
            .front = other_turns,
            .back = other_turns}};
}

void clear_stencil(gpu::Device& device, const gpu::Program& nothing) {
    gpu::PipelineState zero = gpu::kFullscreenState;
    zero.stencil = {.test = true, .front = {.pass = GL_ZERO}, .back = {.pass = GL_ZERO}};
    zero.color_mask = 0;
    device.use(gpu::Pipeline{&nothing, zero});
    device.draw_fullscreen();
}

std::vector<gpu::ShaderDefine> with(std::vector<gpu::ShaderDefine> defines, const char* more) {
    defines.push_back({more});
    return defines;
}

void draw_object_major(PassContext& context, ForwardPass& pass, const FrameScene& scene) {
    gpu::Device& device = context.device();
    bind_lighting(device, scene);
    bind_shadow_masks(context, scene);
    scene.object_lights->bind(device, kLightIndicesUnit);
    scene.object_lists->bind(device, kLightCellsUnit);
    draw_runs(
        device, scene, scene.instances.opaque, scene.per_vertex ? pass.gouraud : pass.list, 0,
        lighting_key(scene) | kObjectLights, with(lighting_defines(scene), "OBJECT_LIGHTS"),
        nearest_once(0));
}

void add_lights(PassContext& context, ForwardPass& pass, const FrameScene& scene) {
    gpu::Device& device = context.device();
    const std::uint32_t key = lighting_key(scene);
    const std::vector<gpu::ShaderDefine> defines = lighting_defines(scene);
    bind_lighting(device, scene);
    bind_shadow_masks(context, scene);
    int turn = 0;  // the first is that of the surroundings
    const auto next_turn = [&] {
        if (++turn % kTurns == 0) {
            clear_stencil(device, *pass.nothing);
        }
        gpu::PipelineState state = nearest_once(turn);
        state.blend = gpu::kBlendAdd;
        return state;
    };
    for (int i = 0; i < scene.lights.directional; ++i) {
        draw_runs(
            device, scene, scene.instances.opaque, pass.one, 0, key | kDirectional,
            with(defines, "DIRECTIONAL_LIGHT"), next_turn(), i);
    }
    const std::span<const LightRun> runs = scene.light_draws.runs;
    for (std::size_t begin = 0, end = 0; begin < runs.size(); begin = end) {
        while (end < runs.size() && runs[end].light == runs[begin].light) {
            ++end;
        }
        draw_light_runs(
            device, scene, runs.subspan(begin, end - begin), pass.one, key, defines, next_turn());
    }
}

}  // namespace

Result<ForwardPass> create_forward_pass(gpu::Device& device) {
    ForwardPass pass = {
        .depth = SurfacePrograms(device, "mesh.vert", "depth_first.frag"),
        .list = SurfacePrograms(device, "mesh.vert", "forward_list.frag"),
        .gouraud = SurfacePrograms(device, "gouraud.vert", "gouraud.frag"),
        .base = SurfacePrograms(device, "mesh.vert", "forward_base.frag"),
        .one = SurfacePrograms(device, "mesh.vert", "forward_one.frag")};
    const Status plain = pass.depth.load(0, 0, {});
    if (!plain) {
        return plain.error();
    }
    const Result<const gpu::Program*> nothing =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "nothing.frag"});
    if (!nothing) {
        return nothing.error();
    }
    pass.nothing = *nothing;
    return pass;
}

TextureId draw_depth_first(FrameGraph& graph, ForwardPass& pass, const FrameScene& scene) {
    const TextureId depth = graph.create(
        {.name = "depth",
         .format = static_cast<GLenum>(
             needs_stencil(scene) ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F),
         .width = scene.view.width,
         .height = scene.view.height});
    graph.add_pass("depth", {}, {cleared(depth)}, [&pass, &scene](PassContext& context) {
        bind_view(context.device(), scene);
        draw_depths(context.device(), scene, pass.depth);
    });
    return depth;
}

TextureId
draw_forward(FrameGraph& graph, ForwardPass& pass, const FrameScene& scene, TextureId depth) {
    const TextureId radiance = graph.create(
        {.name = "radiance",
         .format = scene.radiance_format,
         .width = scene.view.width,
         .height = scene.view.height});
    const std::vector<Use> reads = lighting_reads(scene, {});
    if (scene.method == LightMethod::ObjectMajor) {
        const Use writes[] = {cleared(radiance), depth};
        graph.add_pass(
            "objects", std::span<const Use>(reads), std::span<const Use>(writes),
            [&pass, &scene](PassContext& context) { draw_object_major(context, pass, scene); });
        return radiance;
    }
    graph.add_pass(
        "objects.base", {}, {cleared(radiance), depth}, [&pass, &scene](PassContext& context) {
            bind_lighting(context.device(), scene);
            draw_runs(
                context.device(), scene, scene.instances.opaque, pass.base, 0, lighting_key(scene),
                lighting_defines(scene), nearest_once(0));
        });
    const Use writes[] = {radiance, depth};
    graph.add_pass(
        "objects.lights", std::span<const Use>(reads), std::span<const Use>(writes),
        [&pass, &scene](PassContext& context) { add_lights(context, pass, scene); });
    return radiance;
}

}  // namespace limn
