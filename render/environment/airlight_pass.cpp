#include "render/environment/airlight_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/light/light_list.h"
#include "render/settings.h"
#include "render/shaders/airlight_gpu.h"
#include "render/view_block.h"
#include "render/water/water_surfaces.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

// Techniques: light.airlight

namespace limn {
namespace {

float luminance(const Vec4& color) {
    return 0.2126f * color.x + 0.7152f * color.y + 0.0722f * color.z;
}

/// Indices into LightList::ranges of the strongest lights, in their order there.
std::vector<std::uint32_t> strongest(const LightList& lights, std::size_t count) {
    const auto first = static_cast<std::size_t>(lights.directional);
    std::vector<std::uint32_t> found(lights.ranges.size());
    std::iota(found.begin(), found.end(), 0u);
    if (found.size() > count) {
        std::stable_sort(found.begin(), found.end(), [&](std::uint32_t a, std::uint32_t b) {
            return luminance(lights.records[first + a].color)
                   > luminance(lights.records[first + b].color);
        });
        found.resize(count);
        std::sort(found.begin(), found.end());
    }
    return found;
}

}  // namespace

bool AirlightEffect::is_used(const FrameData& frame) {
    const auto* fog = frame.world->find_resource<HeightFog>();
    return fog != nullptr && fog->lamps > 0 && fog->density > 0;
}

Result<AirlightEffect> AirlightEffect::create(gpu::Device& device, const RenderSettings&) {
    const std::vector<gpu::ShaderDefine> all_lights = {{"LINEAR_FADE", "1"}, {"SPOT_ANGLES", "1"}};
    return AirlightEffect{LIMN_TRY(load_fullscreen(device, "airlight.frag", all_lights))};
}

void AirlightEffect::collect(FrameData& frame) {
    const auto& lights = frame.data.get<LightList>();
    const float factor = within_ranges(*frame.world->find_resource<HeightFog>()).lamps;
    const auto first = static_cast<std::size_t>(lights.directional);
    const std::vector<std::uint32_t> chosen = strongest(lights, kMaxLights);
    texels.assign(1, Vec4(static_cast<float>(chosen.size()), 0, 0, 0));
    for (const std::uint32_t i : chosen) {
        const layout::LightRecord& record = lights.records[first + i];
        const LightRange& range = lights.ranges[i];
        texels.push_back(record.position);
        texels.push_back(
            {factor * record.color.x, factor * record.color.y, factor * record.color.z,
             record.color.w});
        texels.push_back(record.polynomial);
        texels.push_back(record.axis);
        texels.emplace_back(range.axis, range.cosine);
    }
    records.upload(*frame.ring, texels);
}

void AirlightEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const auto* waters = view.data.find<WaterSurfaces>();
    if (texels.size() <= 1 || (waters != nullptr && waters->list.around)) {
        return;  // no fog under water
    }
    gpu::PipelineState state = gpu::kFullscreenState;
    state.blend = gpu::kBlendAdd;
    add_fullscreen_pass(
        graph, "airlight", {sampled(view.gbuffer.depth, layout::kAirlightDepthUnit)},
        {view.radiance}, program, state, [this, &view](PassContext& context, const gpu::Program&) {
            bind_view(context, view);
            records.bind(context.device(), layout::kAirlightUnit);
        });
}

}  // namespace limn
