#include "render/light/ink_lines_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/settings.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/gbuffer_gpu.h"
#include "render/shaders/ink_gpu.h"
#include "render/view_block.h"

#include <cmath>

// Techniques: tex.ink-lines
// Source of tex.ink-lines: Saito and Takahashi 1990

namespace limn {
namespace {

constexpr float kLines = 720;  ///< height of the image that InkLines::width refers to

InkLines ink_lines_of(const FrameData& frame) {
    const auto* found = frame.world->find_resource<InkLines>();
    return found != nullptr ? within_ranges(*found) : InkLines{.width = 0};
}

}  // namespace

bool InkLinesEffect::is_used(const FrameData& frame) {
    const InkLines ink = ink_lines_of(frame);
    return ink.width > 0 && ink.opacity > 0;
}

Result<InkLinesEffect> InkLinesEffect::create(gpu::Device& device, const RenderSettings&) {
    return InkLinesEffect{
        LIMN_TRY(load_fullscreen(device, "ink_edges.frag")),
        LIMN_TRY(load_fullscreen(device, "ink_lines.frag"))};
}

void InkLinesEffect::collect(FrameData& frame) {
    frame.attributes = true;
    frame.material_ids = true;
}

void InkLinesEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const InkLines ink = ink_lines_of(frame);
    const TextureId edge = create_target(graph, "ink edges", GL_RG8, view.size());
    add_fullscreen_pass(
        graph, "ink edges",
        {sampled(view.gbuffer.surface, layout::kGbufferUnit),
         sampled(view.gbuffer.depth, layout::kDepthUnit),
         sampled(view.gbuffer.material, layout::kGbufferMaterialUnit)},
        {discarded(edge)}, edges, [&view, ink](PassContext& context, const gpu::Program& shader) {
            bind_view(context, view);
            shader.set("depth_threshold", ink.depth);
            shader.set("least_cosine", ink.angle < kPi ? std::cos(ink.angle) : -2.0f);
            shader.set("between_materials", ink.materials ? 1 : 0);
        });
    const TextureId drawn = create_like(graph, "radiance with ink lines", view.radiance);
    const float width = ink.width * static_cast<float>(view.size().y) / kLines;
    add_fullscreen_pass(
        graph, "ink lines",
        {sampled(view.radiance, layout::kSourceUnit), sampled(edge, layout::kInkEdgesUnit)},
        {discarded(drawn)}, lines, [ink, width](PassContext&, const gpu::Program& shader) {
            shader.set("ink", Vec4(ink.color, ink.opacity));
            shader.set("half_width", 0.5f * width);
        });
    view.radiance = drawn;
}

}  // namespace limn
