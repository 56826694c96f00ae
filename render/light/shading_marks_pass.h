#pragma once

#include "render/effect.h"

namespace limn {

// Marks over the image: the divider of a comparison and the names of its methods, those of columns
// with wrinkles by different methods, a scanline, and the plot of its brightness.
//
// Reads    ComparedRadiance, or radiance where nothing is compared; ShadingComparison,
//          WrinkleComparison, ScanlinePlot
// Writes   radiance
// Order    after the lens, so that it does not blur them
// Shaders  shading_marks.frag
//
// Columns of the plot are those of the image, so that each value lies below its pixel. The curve of
// the left method is orange, that of the right one blue; the area between them is their error.
// Curves are of the unfiltered image: its edges are not smoothed.

struct ShadingMarksEffect {
    const gpu::Program* program = nullptr;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<ShadingMarksEffect>
    create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
