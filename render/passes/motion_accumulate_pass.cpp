#include "render/passes/motion_accumulate_pass.h"

#include "render/gpu/shader_library.h"

#include <algorithm>

namespace limn {

Result<MotionAccumulatePass> create_motion_accumulate_pass(gpu::Device& device) {
    MotionAccumulatePass pass;
    const Result<const gpu::Program*> copy =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "accumulate.frag"});
    if (!copy) {
        return copy.error();
    }
    const Result<const gpu::Program*> mean =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "motion_accumulate.frag"});
    if (!mean) {
        return mean.error();
    }
    pass.copy = *copy;
    pass.mean = *mean;
    return pass;
}

TextureId accumulate_motion(
    FrameGraph& graph, MotionAccumulatePass& pass, int window, bool cut, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const gpu::TextureDesc ring = {
        .format = GL_RGBA32F,
        .width = spec.width,
        .height = spec.height,
        .depth = window,
        .target = GL_TEXTURE_2D_ARRAY};
    if (!pass.pictures || !(pass.pictures.desc() == ring)) {
        pass.pictures = gpu::Texture("motion pictures", ring);
        forget_motion(pass);
    }
    if (cut) {
        forget_motion(pass);
    }
    pass.newest = (pass.newest + 1) % window;
    pass.count = std::min(pass.count + 1, window);

    const TextureId pictures = graph.import("motion blur.pictures", pass.pictures);
    graph.add_pass(
        "motion blur, keep", {radiance}, {target_level(discarded(pictures), 0, pass.newest)},
        [&program = *pass.copy, radiance](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("weight", 1.0f);
            context.bind_texture(0, radiance);
            context.device().draw_fullscreen();
        });
    const TextureId blurred = graph.create(
        {.name = "motion blur", .format = spec.format, .width = spec.width, .height = spec.height});
    graph.add_pass(
        "motion blur", {pictures}, {discarded(blurred)},
        [&program = *pass.mean, pictures, window, newest = pass.newest,
         count = pass.count](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("newest", newest);
            program.set("count", count);
            program.set("window", window);
            context.bind_texture(0, pictures);
            context.device().draw_fullscreen();
        });
    return blurred;
}

void forget_motion(MotionAccumulatePass& pass) {
    pass.newest = -1;
    pass.count = 0;
}

}  // namespace limn
