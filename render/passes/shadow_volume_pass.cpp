#include "render/passes/shadow_volume_pass.h"

#include "render/gpu/shader_library.h"

namespace limn {
namespace {

constexpr unsigned kVolumeBinding = 2;

/// Front faces of a volume enter it, back faces leave it; of a mirrored caster they look swapped.
gpu::StencilState count_state(const VolumeRun& run) {
    gpu::StencilFace enter;
    gpu::StencilFace leave;
    if (run.z_fail) {
        enter.depth_fail = GL_DECR_WRAP;
        leave.depth_fail = GL_INCR_WRAP;
    } else {
        enter.pass = GL_INCR_WRAP;
        leave.pass = GL_DECR_WRAP;
    }
    gpu::StencilState stencil;
    stencil.test = true;
    stencil.front = run.mirrored ? leave : enter;
    stencil.back = run.mirrored ? enter : leave;
    return stencil;
}

void bind_volumes(gpu::Device& device, const FrameScene& scene) {
    const VolumeList& list = scene.volumes;
    gpu::VertexArray& vertices = list.meshes->vertices();
    glVertexArrayVertexBuffer(
        vertices.id(),
        kVolumeInstanceStream,
        list.instances.buffer,
        static_cast<GLintptr>(list.instances.offset),
        sizeof(layout::VolumeInstance));
    glVertexArrayBindingDivisor(vertices.id(), kVolumeInstanceStream, 1);
    bind_view(device, scene);
    device.bind_vertex_array(vertices);
    device.bind_indirect(list.commands.buffer);
}

/// Draws the light's volumes; `state_of` gives the state of each run.
template <typename StateOf>
void draw_volumes(
    gpu::Device& device,
    const VolumeList& list,
    const VolumeLight& light,
    const gpu::Program* const* programs,
    StateOf&& state_of) {
    device.bind_uniforms(kVolumeBinding, light.block.buffer, light.block.offset, light.block.size);
    for (std::uint32_t i = 0; i < light.run_count; ++i) {
        const VolumeRun& run = list.runs[light.first_run + i];
        device.use(gpu::Pipeline{programs[run.prisms ? 1 : 0], state_of(run)});
        device.draw_indexed_indirect(
            GL_TRIANGLES,
            GL_UNSIGNED_INT,
            list.commands.offset + run.first_command * sizeof(DrawCommand),
            static_cast<int>(run.command_count));
    }
}

/// Only where the light reaches.
void set_bounds(gpu::Device& device, const LightBounds& bounds) {
    device.set_scissor(bounds.x, bounds.y, bounds.width, bounds.height);
    device.set_depth_bounds(bounds.depth_min, bounds.depth_max);
}

void clear_bounds(gpu::Device& device) {
    device.disable_scissor();
    device.disable_depth_bounds();
}

void count_light(
    gpu::Device& device,
    const FrameScene& scene,
    const ShadowVolumePass& pass,
    const VolumeLight& light) {
    bind_volumes(device, scene);
    draw_volumes(device, scene.volumes, light, pass.volumes, [](const VolumeRun& run) {
        gpu::PipelineState state;
        state.depth.write = false;
        state.stencil = count_state(run);
        state.cull = GL_NONE;
        state.color_mask = 0;
        state.depth_clamp = run.z_fail;
        return state;
    });
}

/// 1 where nothing was counted; elsewhere the count is set back to 0.
void write_mask(gpu::Device& device, const ShadowVolumePass& pass) {
    gpu::PipelineState state = gpu::kFullscreenState;
    state.stencil.test = true;
    state.stencil.front = {.func = GL_EQUAL, .stencil_fail = GL_ZERO};
    state.stencil.back = state.stencil.front;
    device.use(gpu::Pipeline{pass.mask, state});
    pass.mask->set("lit", 1.0f);
    device.draw_fullscreen();
}

Result<const gpu::Program*>
load_volume_program(gpu::Device& device, const char* fragment, bool prisms) {
    gpu::ProgramDesc desc = {.vertex = "shadow_volume.vert", .fragment = fragment};
    if (prisms) {
        desc.defines.push_back({"PRISMS"});
    }
    return device.shaders().load(desc);
}

}  // namespace

Result<ShadowVolumePass> create_shadow_volume_pass(gpu::Device& device) {
    ShadowVolumePass pass;
    for (int prisms = 0; prisms < 2; ++prisms) {
        const Result<const gpu::Program*> volumes =
            load_volume_program(device, "shadow_volume.frag", prisms == 1);
        if (!volumes) {
            return volumes.error();
        }
        pass.volumes[prisms] = *volumes;
        const Result<const gpu::Program*> layers =
            load_volume_program(device, "shadow_density.frag", prisms == 1);
        if (!layers) {
            return layers.error();
        }
        pass.layers[prisms] = *layers;
    }
    const Result<const gpu::Program*> mask =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "shadow_mask.frag"});
    if (!mask) {
        return mask.error();
    }
    pass.mask = *mask;
    return pass;
}

TextureId draw_shadow_volumes(
    FrameGraph& graph,
    const ShadowVolumePass& pass,
    const FrameScene& scene,
    const Gbuffer& gbuffer) {
    const std::vector<VolumeLight>& lights = scene.volumes.lights;
    if (lights.empty()) {
        return {};
    }
    const TextureId mask = graph.create(
        {.name = "shadow.mask",
         .format = GL_R8,
         .width = scene.view.width,
         .height = scene.view.height,
         .depth = static_cast<int>(lights.size()),
         .target = GL_TEXTURE_2D_ARRAY});
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto layer = static_cast<int>(i);
        graph.add_pass(
            "shadow volumes",
            {},
            {target_level(cleared(mask), 0, layer), gbuffer.depth},
            [&pass, &scene, layer](PassContext& context) {
                const VolumeLight& light = scene.volumes.lights[static_cast<std::size_t>(layer)];
                set_bounds(context.device(), light.bounds);
                count_light(context.device(), scene, pass, light);
                write_mask(context.device(), pass);
                clear_bounds(context.device());
            });
    }
    return mask;
}

TextureId
draw_volume_layers(FrameGraph& graph, const ShadowVolumePass& pass, const FrameScene& scene) {
    const TextureId layers = graph.create(
        {.name = "aov.volume_layers",
         .format = GL_RGBA32F,
         .width = scene.view.width,
         .height = scene.view.height});
    graph.add_pass(
        "aov.volume_layers", {}, {cleared(layers)}, [&pass, &scene](PassContext& context) {
            if (scene.volumes.lights.empty()) {
                return;
            }
            bind_volumes(context.device(), scene);
            for (const VolumeLight& light : scene.volumes.lights) {
                const auto state_of = [](const VolumeRun& run) {
                    gpu::PipelineState state = gpu::kFullscreenState;
                    state.blend = gpu::kBlendAdd;
                    state.depth_clamp = run.z_fail;
                    return state;
                };
                draw_volumes(context.device(), scene.volumes, light, pass.layers, state_of);
            }
        });
    return layers;
}

}  // namespace limn
