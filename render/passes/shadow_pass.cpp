#include "render/passes/shadow_pass.h"

#include "render/gpu/device.h"
#include "render/graph/frame_graph.h"

namespace limn {
namespace {

gpu::Texture make_atlas(int size) {
    return {"shadow atlas", {.format = GL_DEPTH_COMPONENT32F, .width = size, .height = size}};
}

void draw_view(
    gpu::Device& device, ShadowPass& pass, const FrameScene& scene, const ShadowDraw& draw) {
    const AtlasRect& place = draw.place;
    const gpu::PipelineState state = {.cull = GL_NONE, .depth_clamp = draw.clamp_depth};
    device.set_viewport(place.x, place.y, place.size, place.size);
    device.set_scissor(place.x, place.y, place.size, place.size);
    device.apply(state);
    constexpr float kNothing = 0;
    glClearBufferfv(GL_DEPTH, 0, &kNothing);
    const gpu::RingSlice& block = draw.view_block;
    device.bind_uniforms(kViewBinding, block.buffer, block.offset, block.size);
    draw_casters(device, scene, draw.casters, pass.programs, state);
}

}  // namespace

Result<ShadowPass> create_shadow_pass(gpu::Device& device) {
    ShadowPass pass = {SurfacePrograms(device, "mesh.vert", "shadow_map.frag"), make_atlas(1)};
    const Status plain = pass.programs.load(0, 0, {});
    if (!plain) {
        return plain.error();
    }
    return pass;
}

void resize_shadow_atlas(ShadowPass& pass, const ShadowList& list) {
    if (pass.atlas.width() < list.atlas_size) {
        pass.atlas = make_atlas(list.atlas_size);
    }
}

TextureId draw_shadows(FrameGraph& graph, ShadowPass& pass, const FrameScene& scene) {
    if (scene.shadows.atlas_size == 0) {
        return {};
    }
    const TextureId atlas = graph.import("shadow.atlas", pass.atlas);
    if (!scene.shadows.due.empty()) {
        graph.add_pass("shadows", {}, {atlas}, [&pass, &scene](PassContext& context) {
            for (const ShadowDraw& draw : scene.shadows.due) {
                draw_view(context.device(), pass, scene, draw);
            }
            context.device().disable_scissor();
        });
    }
    return atlas;
}

}  // namespace limn
