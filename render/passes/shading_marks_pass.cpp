#include "render/passes/shading_marks_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/lighting.h"
#include "render/settings.h"

namespace limn {

bool ShadingMarksEffect::is_used(const FrameData& frame) {
    return frame.world->find_resource<ScanlinePlot>() != nullptr
           || frame.world->find_resource<ShadingComparison>() != nullptr;
}

Result<ShadingMarksEffect> ShadingMarksEffect::create(gpu::Device& device, const RenderSettings&) {
    return ShadingMarksEffect{LIMN_TRY(load_fullscreen(device, "shading_marks.frag"))};
}

void ShadingMarksEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto* plot = frame.world->find_resource<ScanlinePlot>();
    const auto* comparison = frame.world->find_resource<ShadingComparison>();
    const auto* both = view.data.find<ComparedRadiance>();
    const TextureId left = both != nullptr ? both->left : view.radiance;
    const TextureId right = both != nullptr ? both->right : view.radiance;
    const TextureId marked = create_like(graph, "radiance with marks", view.radiance);
    add_fullscreen_pass(
        graph, "shading marks", {sampled(view.radiance, 0), sampled(left, 1), sampled(right, 2)},
        {discarded(marked)}, program,
        [its = within_ranges(plot != nullptr ? *plot : ScanlinePlot{.height = 0}),
         divider = comparison != nullptr && comparison->image == ComparisonImage::Split
                       ? within_ranges(*comparison).divider
                       : -1,
         curves = both != nullptr ? 2 : 1](PassContext&, const gpu::Program& to) {
            to.set("row", its.row);
            to.set("plot_height", its.height);
            to.set("divider", divider);
            to.set("curves", curves);
        });
    view.radiance = marked;
}

}  // namespace limn
