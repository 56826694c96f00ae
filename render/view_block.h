#pragma once

#include "render/shaders/view_gpu.h"

namespace limn {

class PassContext;
struct ClusterShape;
struct LightList;
struct RenderView;
struct ViewData;

/// ViewBlock::tessellation of a view.
[[nodiscard]] Vec4 tessellation_eye(const RenderView& camera);

/// The uniform block of lib/view.glsl.
[[nodiscard]] layout::ViewBlock make_view_block(
    const RenderView& camera, const ClusterShape& shape, const LightList& lights,
    bool infinite_viewer);

/// Binds it, as uploaded in ViewData::block, and the blocks that effects have published.
void bind_view(PassContext& context, const ViewData& view);

/// Whether a plane cuts away part of the view: then surfaces are drawn with the definition CLIPPED
/// and PipelineState::clip.
[[nodiscard]] bool is_clipped(const ViewData& view);

}  // namespace limn
