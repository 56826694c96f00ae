#include "render/shadow/shadow_volume_pass.h"

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/lighting.h"
#include "render/shaders/gbuffer_gpu.h"
#include "render/shaders/shadow_gpu.h"
#include "render/shaders/shadow_volume_gpu.h"
#include "render/shadow/shadow_list.h"
#include "render/shadow/volume_list.h"
#include "render/view_block.h"

// Techniques: shadow.density-view, shadow.hybrid-edge, shadow.stencil-frame, shadow.stencil-pass,
//     shadow.volume-count

namespace limn {
namespace {

/// Bit 7 of the stencil: the pixel lies on a shadow edge of the light's map.
constexpr std::uint8_t kEdgeBit = 0x80;

/// Front faces of a volume enter it, back faces leave it; swapped for a mirrored caster. With
/// `edges` only marked pixels are counted, in the bits below the mark.
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

void bind_volumes(PassContext& context, const ViewData& view) {
    gpu::Device& device = context.device();
    const auto& list = view.data.get<VolumeList>();
    gpu::VertexArray& vertices = list.meshes->vertices();
    glVertexArrayVertexBuffer(
        vertices.id(), kVolumeInstanceStream, list.instances.buffer,
        static_cast<GLintptr>(list.instances.offset), sizeof(layout::VolumeInstance));
    glVertexArrayBindingDivisor(vertices.id(), kVolumeInstanceStream, 1);
    bind_view(context, view);
    device.bind_vertex_array(vertices);
    device.bind_indirect(list.commands.buffer);
}

/// Draws the light's volumes; `state_of` gives the state of each run.
template <typename StateOf>
void draw_volumes(
    gpu::Device& device, const VolumeList& list, const VolumeLight& light,
    const gpu::Program* const* programs, StateOf&& state_of) {
    device.bind_uniforms(
        layout::kShadowVolumeBinding, light.block.buffer, light.block.offset, light.block.size);
    for (std::uint32_t i = 0; i < light.run_count; ++i) {
        const VolumeRun& run = list.runs[light.first_run + i];
        device.use(gpu::Pipeline{programs[run.prisms ? 1 : 0], state_of(run)});
        device.draw_indexed_indirect(
            GL_TRIANGLES, GL_UNSIGNED_INT,
            list.commands.offset + run.first_command * sizeof(DrawCommand),
            static_cast<int>(run.command_count));
    }
}

/// Limits drawing to the light's range.
void set_bounds(gpu::Device& device, const LightBounds& bounds) {
    device.set_scissor(bounds.x, bounds.y, bounds.width, bounds.height);
    device.set_depth_bounds(bounds.depth_min, bounds.depth_max);
}

void clear_bounds(gpu::Device& device) {
    device.disable_scissor();
    device.disable_depth_bounds();
}

void count_light(PassContext& context, const ViewData& view, const VolumeLight& light) {
    const auto& list = view.data.get<VolumeList>();
    bind_volumes(context, view);
    draw_volumes(context.device(), list, light, list.pass->volumes, [&](const VolumeRun& run) {
        gpu::PipelineState state;
        state.depth.write = false;
        state.stencil = count_state(run, light.hybrid);
        state.cull = GL_NONE;
        state.color_mask = 0;
        state.depth_clamp = run.z_fail;
        return state;
    });
}

/// Writes `lit` where the stencil passes `face`, whose operations reset it.
void write_mask(
    gpu::Device& device, const ShadowVolumePass& pass, float lit, std::uint8_t reference,
    const gpu::StencilFace& face) {
    gpu::PipelineState state = gpu::kFullscreenState;
    state.stencil = {.test = true, .reference = reference, .front = face, .back = face};
    device.use(gpu::Pipeline{pass.mask, state});
    pass.mask->set("lit", lit);
    device.draw_fullscreen();
}

/// After counting: writes 1 where the count is 0 and resets the stencil to 0.
void resolve_light(gpu::Device& device, const ShadowVolumePass& pass, bool hybrid) {
    if (!hybrid) {
        write_mask(device, pass, 1, 0, {.func = GL_EQUAL, .stencil_fail = GL_ZERO});
        return;
    }
    // Away from edges the map's result stays.
    write_mask(device, pass, 0, kEdgeBit, {.func = GL_LESS});
    write_mask(
        device, pass, 1, kEdgeBit, {.func = GL_EQUAL, .stencil_fail = GL_ZERO, .pass = GL_ZERO});
}

const VolumeLight& light_of(const ViewData& view, int layer) {
    return view.data.get<VolumeList>().lights[static_cast<std::size_t>(layer)];
}

/// Writes the map's result to the light's layer of the mask, its edges to bit 7 of the stencil.
void add_classification(
    FrameGraph& graph, ShadowVolumePass& pass, const ViewData& view, TextureId mask, int layer) {
    const Use reads[] = {
        sampled(view.gbuffer.surface, layout::kGbufferUnit),
        sampled(depth_tested(view.gbuffer.depth), layout::kDepthUnit),
        view.data.get<ShadowMaps>().atlas};
    const Use writes[] = {target_level(cleared(mask), 0, layer)};
    graph.add_pass("shadow classes", reads, writes, [&pass, &view, layer](PassContext& context) {
        const ShadowKinds& kinds = view.data.get<ShadowList>().kinds;
        Variant variant("SHADOW_MAPS");
        variant.add("SHADOW_SOFT");
        variant.add_if(kinds.cubes, "SHADOW_CUBES");
        variant.add_if(kinds.cascades, "SHADOW_CASCADES");
        const gpu::Program* program = pass.classify.get(variant);
        if (program == nullptr) {
            return;
        }
        gpu::Device& device = context.device();
        const VolumeLight& light = light_of(view, layer);
        gpu::PipelineState surfaces_only = gpu::kFullscreenState;
        surfaces_only.depth = {.test = true, .write = false, .func = GL_LESS};
        set_bounds(device, light.bounds);
        device.use(gpu::Pipeline{program, surfaces_only});
        program->set("map", light.map);
        bind_lighting(context, view);
        device.bind_uniforms(
            layout::kShadowVolumeBinding, light.block.buffer, light.block.offset, light.block.size);
        device.draw_fullscreen();
        clear_bounds(device);
    });
    gpu::PipelineState state = gpu::kFullscreenState;
    state.stencil = {
        .test = true,
        .reference = kEdgeBit,
        .front = {.pass = GL_REPLACE},
        .back = {.pass = GL_REPLACE}};
    graph.add_pass(
        "shadow edges", {sampled(mask, layout::kShadowMasksUnit)}, {view.gbuffer.depth},
        [&pass, &view, state, layer](PassContext& context) {
            set_bounds(context.device(), light_of(view, layer).bounds);
            context.device().use(gpu::Pipeline{pass.edges, state});
            pass.edges->set("layer", layer);
            context.device().draw_fullscreen();
            clear_bounds(context.device());
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
        .classify = ProgramVariants::fullscreen(device, "shadow_classify.frag")};
    for (int prisms = 0; prisms < 2; ++prisms) {
        pass.volumes[prisms] =
            LIMN_TRY(load_volume_program(device, "shadow_volume.frag", prisms == 1));
        pass.layers[prisms] =
            LIMN_TRY(load_volume_program(device, "shadow_density.frag", prisms == 1));
    }
    pass.mask = LIMN_TRY(
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "shadow_mask.frag"}));
    pass.edges = LIMN_TRY(
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "shadow_edge.frag"}));
    pass.no_masks = gpu::Texture(
        "no shadow masks",
        {.format = GL_R8, .width = 1, .height = 1, .target = GL_TEXTURE_2D_ARRAY});
    return pass;
}

TextureId draw_shadow_volumes(FrameGraph& graph, ShadowVolumePass& pass, const ViewData& view) {
    const std::vector<VolumeLight>& lights = view.data.get<VolumeList>().lights;
    const TextureId mask = graph.create(
        {.name = "shadow.mask",
         .format = GL_R8,
         .width = view.camera.width,
         .height = view.camera.height,
         .depth = static_cast<int>(lights.size()),
         .target = GL_TEXTURE_2D_ARRAY});
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto layer = static_cast<int>(i);
        if (lights[i].hybrid) {
            add_classification(graph, pass, view, mask, layer);
        }
        const Use whole = lights[i].hybrid ? Use(mask) : cleared(mask);
        graph.add_pass(
            "shadow volumes", {}, {target_level(whole, 0, layer), view.gbuffer.depth},
            [&pass, &view, layer](PassContext& context) {
                const VolumeLight& light = light_of(view, layer);
                set_bounds(context.device(), light.bounds);
                count_light(context, view, light);
                resolve_light(context.device(), pass, light.hybrid);
                clear_bounds(context.device());
            });
    }
    return mask;
}

TextureId draw_volume_layers(FrameGraph& graph, const ViewData& view) {
    const TextureId layers = graph.create(
        {.name = "aov.volume_layers",
         .format = GL_RGBA32F,
         .width = view.camera.width,
         .height = view.camera.height});
    graph.add_pass("aov.volume_layers", {}, {cleared(layers)}, [&view](PassContext& context) {
        const auto& list = view.data.get<VolumeList>();
        if (list.lights.empty()) {
            return;
        }
        bind_volumes(context, view);
        for (const VolumeLight& light : list.lights) {
            const auto state_of = [](const VolumeRun& run) {
                gpu::PipelineState state = gpu::kFullscreenState;
                state.blend = gpu::kBlendAdd;
                state.depth_clamp = run.z_fail;
                return state;
            };
            draw_volumes(context.device(), list, light, list.pass->layers, state_of);
        }
    });
    return layers;
}

}  // namespace limn
