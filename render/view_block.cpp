#include "render/view_block.h"

#include "render/frame_data.h"
#include "render/gpu/device.h"
#include "render/light/light_clusters.h"

namespace limn {

Vec4 tessellation_eye(const RenderView& camera) {
    const auto& r = camera.world_from_camera.row;
    const float pixels = static_cast<float>(camera.height) / (2 * camera.tangent.y);
    return {r[0].w, r[1].w, r[2].w, pixels};
}

layout::ViewBlock make_view_block(
    const RenderView& camera, const ClusterShape& shape, const LightList& lights,
    bool infinite_viewer) {
    const auto& r = camera.world_from_camera.row;
    const auto column = [&](int c) { return Vec3(r[0][c], r[1][c], r[2][c]); };
    const Vec2 size = {camera.width, camera.height};
    const Vec2 jitter = 2.0f * camera.jitter / size;
    layout::ViewBlock block{};
    block.clip_from_world = camera.clip_from_world;
    block.previous_clip_from_world = camera.previous_clip_from_world;
    block.camera_ws = Vec4(column(3), camera.near);
    block.orthographic.x = camera.pullback;
    block.ray_right = Vec4(column(0) * camera.tangent.x, jitter.x);
    block.ray_up = Vec4(column(1) * camera.tangent.y, jitter.y);
    block.ray_forward = Vec4(-column(2), infinite_viewer ? 1.0f : 0.0f);
    block.size = {size.x, size.y, 1 / size.x, 1 / size.y};
    block.grid_cells = {shape.columns, shape.rows, shape.slices, shape.tile};
    block.grid_depth = {
        shape.depth_scale, shape.depth_bias, lights.directional, lights.first_shadowed};
    block.clip_plane = camera.clip_plane;
    block.tessellation = tessellation_eye(camera);
    return block;
}

void bind_view(PassContext& context, const ViewData& view) {
    const auto bind = [&](unsigned binding, const gpu::RingSlice& block) {
        context.device().bind_uniforms(binding, block.buffer, block.offset, block.size);
    };
    bind(layout::kViewBinding, view.block);
    for (unsigned i = 0; i < layout::kMaxEffectBlocks; ++i) {
        bind(layout::kEffectBlocks + i, view.effect_blocks[i]);
    }
}

bool is_clipped(const ViewData& view) {
    return view.camera.clip_plane != Vec4(0);
}

}  // namespace limn
