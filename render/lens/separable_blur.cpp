#include "render/lens/separable_blur.h"

#include "render/fullscreen.h"
#include "render/shaders/fullscreen_gpu.h"

#include <cmath>
#include <numeric>

// Techniques: post.separable-blur

namespace limn {
namespace {

TextureId blur_axis(
    FrameGraph& graph, const SeparableBlur& blur, std::string_view name, TextureId source,
    const BlurKernel& kernel, const IVec2& axis) {
    const TextureId target = create_like(graph, name, source);
    add_fullscreen_pass(
        graph, name, {sampled(source, layout::kSourceUnit)}, {discarded(target)}, blur.program,
        [kernel, axis](PassContext&, const gpu::Program& program) {
            program.set("axis", axis);
            program.set("negative_weights", Vec3(kernel[0], kernel[1], kernel[2]));
            program.set("center_weight", kernel[3]);
            program.set("positive_weights", Vec3(kernel[4], kernel[5], kernel[6]));
        });
    return target;
}

}  // namespace

Result<SeparableBlur> create_separable_blur(gpu::Device& device) {
    return SeparableBlur{LIMN_TRY(load_fullscreen(device, "separable_blur.frag"))};
}

TextureId blur_separable(
    FrameGraph& graph, const SeparableBlur& blur, std::string_view name, TextureId source,
    const BlurKernel& kernel, BlurOrder order) {
    LIMN_CHECK(std::abs(std::accumulate(kernel.begin(), kernel.end(), -1.0)) < 1e-4);

    const bool across_first = order == BlurOrder::HorizontalFirst;
    const IVec2 first = across_first ? IVec2(1, 0) : IVec2(0, 1);
    source = blur_axis(graph, blur, name, source, kernel, first);
    return blur_axis(graph, blur, name, source, kernel, 1 - first);
}

}  // namespace limn
