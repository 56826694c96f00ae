#include "render/light/lighting.h"

#include "render/shaders/gbuffer_gpu.h"
#include "render/shaders/material_layers_gpu.h"
#include "render/shaders/shadow_gpu.h"
#include "render/view_block.h"

namespace limn {

void bind_lighting(PassContext& context, const ViewData& view) {
    bind_view(context, view);
    for (const LightingInputs::Binding& binding : view.lighting.bindings) {
        binding.bind(context, binding.data);
    }
}

std::vector<Use> lighting_reads(const ViewData& view, std::initializer_list<Use> reads) {
    std::vector<Use> all = reads;
    all.insert(all.end(), view.lighting.reads.begin(), view.lighting.reads.end());
    return all;
}

std::vector<Use> surface_reads(const ViewData& view, Use depth) {
    std::vector<Use> reads =
        lighting_reads(view, {sampled(view.gbuffer.surface, layout::kGbufferUnit), depth});
    if (view.gbuffer.material.valid()) {
        reads.push_back(sampled(view.gbuffer.material, layout::kGbufferMaterialUnit));
    }
    if (view.gbuffer.key_light.valid()) {
        reads.push_back(sampled(view.gbuffer.key_light, layout::kGbufferKeyLightUnit));
    }
    if (view.gbuffer.layers.valid()) {
        reads.push_back(sampled(view.gbuffer.layers, layout::kGbufferLayersUnit));
    }
    return reads;
}

void bind_shadow_masks(PassContext& context, const ViewData& view) {
    if (const auto* masks = view.data.find<ShadowMasks>()) {
        context.bind_texture(layout::kShadowMasksUnit, masks->layers);
    }
}

TextureId create_radiance(FrameGraph& graph, const ViewData& view, std::string_view name) {
    return graph.create(
        {.name = name,
         .format = view.frame->radiance_format,
         .width = view.camera.width,
         .height = view.camera.height});
}

}  // namespace limn
