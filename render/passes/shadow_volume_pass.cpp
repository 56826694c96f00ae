#include "render/passes/shadow_volume_pass.h"

#include "render/gpu/shader_library.h"

namespace limn {
namespace {

constexpr unsigned kVolumeBinding = 2;

/// Bit 7 of the stencil: the pixel lies on an edge of the light's map.
constexpr std::uint8_t kEdgeBit = 0x80;

/// Front faces of a volume enter it, back faces leave it; of a mirrored caster they look swapped.
/// With `edges` only marked pixels count, in the bits below the mark.
gpu::StencilState count_state(const VolumeRun& run, bool edges) {
    gpu::StencilFace enter = {.func = static_cast<GLenum>(edges ? GL_EQUAL : GL_ALWAYS)};
    gpu::StencilFace leave = enter;
    if (run.z_fail) {
        enter.depth_fail = GL_DECR_WRAP;
        leave.depth_fail = GL_INCR_WRAP;
    } else {
        enter.pass = GL_INCR_WRAP;
        leave.pass = GL_DECR_WRAP;
    }
    gpu::StencilState stencil = {.test = true};
    if (edges) {
        stencil.reference = kEdgeBit;
        stencil.read_mask = kEdgeBit;
        stencil.write_mask = kEdgeBit - 1;
    }
    stencil.front = run.mirrored ? leave : enter;
    stencil.back = run.mirrored ? enter : leave;
    return stencil;
}

void bind_volumes(gpu::Device& device, const FrameScene& scene) {
    const VolumeList& list = scene.volumes;
    gpu::VertexArray& vertices = list.meshes->vertices();
    glVertexArrayVertexBuffer(
        vertices.id(), kVolumeInstanceStream, list.instances.buffer,
        static_cast<GLintptr>(list.instances.offset), sizeof(layout::VolumeInstance));
    glVertexArrayBindingDivisor(vertices.id(), kVolumeInstanceStream, 1);
    bind_view(device, scene);
    device.bind_vertex_array(vertices);
    device.bind_indirect(list.commands.buffer);
}

/// Draws the light's volumes; `state_of` gives the state of each run.
template <typename StateOf>
void draw_volumes(
    gpu::Device& device, const VolumeList& list, const VolumeLight& light,
    const gpu::Program* const* programs, StateOf&& state_of) {
    device.bind_uniforms(kVolumeBinding, light.block.buffer, light.block.offset, light.block.size);
    for (std::uint32_t i = 0; i < light.run_count; ++i) {
        const VolumeRun& run = list.runs[light.first_run + i];
        device.use(gpu::Pipeline{programs[run.prisms ? 1 : 0], state_of(run)});
        device.draw_indexed_indirect(
            GL_TRIANGLES, GL_UNSIGNED_INT,
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
    gpu::Device& device, const FrameScene& scene, const ShadowVolumePass& pass,
    const VolumeLight& light) {
    bind_volumes(device, scene);
    draw_volumes(device, scene.volumes, light, pass.volumes, [&](const VolumeRun& run) {
        gpu::PipelineState state;
        state.depth.write = false;
        state.stencil = count_state(run, light.hybrid);
        state.cull = GL_NONE;
        state.color_mask = 0;
        state.depth_clamp = run.z_fail;
        return state;
    });
}

/// `lit` where the stencil passes `face`, whose operations set it back.
void write_mask(
    gpu::Device& device, const ShadowVolumePass& pass, float lit, std::uint8_t reference,
    const gpu::StencilFace& face) {
    gpu::PipelineState state = gpu::kFullscreenState;
    state.stencil = {.test = true, .reference = reference, .front = face, .back = face};
    device.use(gpu::Pipeline{pass.mask, state});
    pass.mask->set("lit", lit);
    device.draw_fullscreen();
}

/// After counting: 1 where nothing was counted; the stencil is 0 again.
void resolve_light(gpu::Device& device, const ShadowVolumePass& pass, bool hybrid) {
    if (!hybrid) {
        write_mask(device, pass, 1, 0, {.func = GL_EQUAL, .stencil_fail = GL_ZERO});
        return;
    }
    // The map's answer stays where no edge is.
    write_mask(device, pass, 0, kEdgeBit, {.func = GL_LESS});
    write_mask(
        device, pass, 1, kEdgeBit, {.func = GL_EQUAL, .stencil_fail = GL_ZERO, .pass = GL_ZERO});
}

/// The map's answers into the light's layer of the mask, its edges into bit 7 of the stencil.
void add_classification(
    FrameGraph& graph, ShadowVolumePass& pass, const FrameScene& scene, const Gbuffer& gbuffer,
    TextureId mask, int layer) {
    const Use reads[] = {gbuffer.surface, depth_tested(gbuffer.depth), scene.shadow_maps};
    const Use writes[] = {target_level(cleared(mask), 0, layer)};
    graph.add_pass(
        "shadow classes", std::span<const Use>(reads), std::span<const Use>(writes),
        [&pass, &scene, gbuffer, layer](PassContext& context) {
            gpu::Device& device = context.device();
            const VolumeLight& light = scene.volumes.lights[static_cast<std::size_t>(layer)];
            std::vector<gpu::ShaderDefine> defines = {{"SHADOW_MAPS"}, {"SHADOW_SOFT"}};
            if (scene.shadows.cubes) {
                defines.push_back({"SHADOW_CUBES"});
            }
            if (scene.shadows.cascades) {
                defines.push_back({"SHADOW_CASCADES"});
            }
            const std::uint32_t key =
                (scene.shadows.cubes ? 1u : 0u) | (scene.shadows.cascades ? 2u : 0u);
            const gpu::Program* program = pass.classify.get(0, key, defines);
            if (program == nullptr) {
                return;
            }
            gpu::PipelineState surfaces_only = gpu::kFullscreenState;
            surfaces_only.depth = {.test = true, .write = false, .func = GL_LESS};
            set_bounds(device, light.bounds);
            device.use(gpu::Pipeline{program, surfaces_only});
            program->set("map", light.map);
            bind_lighting(device, scene);
            device.bind_uniforms(
                kVolumeBinding, light.block.buffer, light.block.offset, light.block.size);
            context.bind_texture(kGbufferUnit, gbuffer.surface);
            context.bind_texture(kDepthUnit, gbuffer.depth);
            device.draw_fullscreen();
            clear_bounds(device);
        });
    graph.add_pass(
        "shadow edges", {mask}, {gbuffer.depth},
        [&pass, &scene, mask, layer](PassContext& context) {
            gpu::Device& device = context.device();
            gpu::PipelineState state = gpu::kFullscreenState;
            state.stencil = {
                .test = true,
                .reference = kEdgeBit,
                .front = {.pass = GL_REPLACE},
                .back = {.pass = GL_REPLACE}};
            set_bounds(device, scene.volumes.lights[static_cast<std::size_t>(layer)].bounds);
            device.use(gpu::Pipeline{pass.edges, state});
            pass.edges->set("layer", layer);
            context.bind_texture(kShadowMasksUnit, mask);
            device.draw_fullscreen();
            clear_bounds(device);
        });
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
    ShadowVolumePass pass = {
        .classify = SurfacePrograms(device, "fullscreen.vert", "shadow_classify.frag")};
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
    const Result<const gpu::Program*> edges =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "shadow_edge.frag"});
    if (!edges) {
        return edges.error();
    }
    pass.edges = *edges;
    return pass;
}

TextureId draw_shadow_volumes(
    FrameGraph& graph, ShadowVolumePass& pass, const FrameScene& scene, const Gbuffer& gbuffer) {
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
        if (lights[i].hybrid) {
            add_classification(graph, pass, scene, gbuffer, mask, layer);
        }
        const Use whole = lights[i].hybrid ? Use(mask) : cleared(mask);
        graph.add_pass(
            "shadow volumes", {}, {target_level(whole, 0, layer), gbuffer.depth},
            [&pass, &scene, layer](PassContext& context) {
                const VolumeLight& light = scene.volumes.lights[static_cast<std::size_t>(layer)];
                set_bounds(context.device(), light.bounds);
                count_light(context.device(), scene, pass, light);
                resolve_light(context.device(), pass, light.hybrid);
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
