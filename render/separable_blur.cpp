#include "render/separable_blur.h"

#include "render/gpu/shader_library.h"

#include <cmath>
#include <numeric>

namespace limn {
namespace {

TextureId blur_axis(
    FrameGraph& graph, const SeparableBlur& blur, std::string_view name, TextureId source,
    const BlurKernel& kernel, const IVec2& axis) {
    TextureSpec spec = graph.spec(source);
    spec.name = name;
    const TextureId target = graph.create(spec);
    graph.add_pass(
        name, {source}, {discarded(target)},
        [program = blur.program, source, kernel, axis](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("axis", axis);
            program->set("before", Vec3(kernel[0], kernel[1], kernel[2]));
            program->set("middle", kernel[3]);
            program->set("behind", Vec3(kernel[4], kernel[5], kernel[6]));
            context.bind_texture(0, source);
            context.device().draw_fullscreen();
        });
    return target;
}

}  // namespace

Result<SeparableBlur> create_separable_blur(gpu::Device& device) {
    const Result<const gpu::Program*> program =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "separable_blur.frag"});
    if (!program) {
        return program.error();
    }
    return SeparableBlur{*program};
}

TextureId blur_separable(
    FrameGraph& graph, const SeparableBlur& blur, std::string_view name, TextureId source,
    const BlurKernel& kernel, BlurOrder order) {
    LIMN_CHECK(std::abs(std::accumulate(kernel.begin(), kernel.end(), -1.0)) < 1e-4);

    const bool across_first = order == BlurOrder::AcrossFirst;
    const IVec2 first = across_first ? IVec2(1, 0) : IVec2(0, 1);
    source = blur_axis(graph, blur, name, source, kernel, first);
    return blur_axis(graph, blur, name, source, kernel, 1 - first);
}

}  // namespace limn
