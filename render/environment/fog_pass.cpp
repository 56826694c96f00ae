#include "render/environment/fog_pass.h"

#include "ecs/world.h"
#include "render/environment/fog_block.h"
#include "render/fullscreen.h"
#include "render/light/light_list.h"
#include "render/shaders/fog_gpu.h"
#include "render/view_block.h"
#include "render/water/water_surfaces.h"

// Techniques: light.height-fog

namespace limn {
namespace {}  // namespace

bool FogEffect::is_used(const FrameData& frame) {
    return frame.world->find_resource<HeightFog>() != nullptr;
}

Result<FogEffect> FogEffect::create(gpu::Device& device, const RenderSettings&) {
    return FogEffect{LIMN_TRY(load_fullscreen(device, "fog.frag"))};
}

bool FogEffect::prepare(const FrameData& frame, ViewData& view) {
    const Vec4& row = view.camera.world_from_camera.row[1];
    const float y = row.w - view.camera.pullback * row.z;  // of the camera, not of its eye
    view.publish_block(
        layout::kFogBinding,
        make_fog_block(*frame.world->find_resource<HeightFog>(), view.data.get<LightList>(), y));
    return true;
}

void FogEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const auto* waters = view.data.find<WaterSurfaces>();
    if (waters != nullptr && waters->list.around) {
        return;  // no fog under water
    }
    gpu::PipelineState state = gpu::kFullscreenState;
    state.blend = gpu::kBlendPremultiplied;
    add_fullscreen_pass(
        graph, "fog", {sampled(view.gbuffer.depth, layout::kFogDepthUnit)}, {view.radiance},
        program, state,
        [&view](PassContext& context, const gpu::Program&) { bind_view(context, view); });
}

}  // namespace limn
