#include "render/geometry/aov_pass.h"

#include "render/fullscreen.h"
#include "render/light/lighting.h"
#include "render/render_frame.h"
#include "render/shaders/gbuffer_gpu.h"
#include "render/shaders/shadow_gpu.h"
#include "render/shadow/shadow_list.h"
#include "render/shadow/volume_list.h"
#include "render/view_block.h"

#include <algorithm>
#include <string>

namespace limn {

const std::array<Aov, kAovCount> kAovs = {{
    {"depth", 1, {kNoDepth, 0, 0, 0}},
    {"normal", 3, {0, 0, 0, 0}},
    {"albedo", 3, {0, 0, 0, 0}},
    {"velocity", 2, {0, 0, 0, 0}},
    {"emission", 3, {0, 0, 0, 0}},
    {"shadow_texels", 1, {0, 0, 0, 0}},
    {"volume_layers", 1, {0, 0, 0, 0}},
}};

namespace {

constexpr int kVelocityAov = 3;
constexpr int kShadowTexelsAov = 5;
constexpr int kVolumeLayersAov = 6;  ///< drawn by draw_volume_layers

bool is_requested(const FrameData& frame, std::string_view name) {
    return std::find(frame.aovs.begin(), frame.aovs.end(), name) != frame.aovs.end();
}

TextureId draw_aov(FrameGraph& graph, AovEffect& effect, const ViewData& view, int aov) {
    const std::string name = "aov." + std::string(kAovs[aov].name);
    const TextureId value = create_target(graph, name, GL_RGBA32F, view.size());
    std::vector<Use> reads = {
        sampled(view.gbuffer.surface, layout::kGbufferUnit),
        sampled(depth_tested(view.gbuffer.depth), layout::kDepthUnit)};
    if (aov == kVelocityAov) {
        reads.push_back(sampled(view.gbuffer.velocity, layout::kVelocityUnit));
    }
    const Use writes[] = {cleared(value, kAovs[aov].background)};
    graph.add_pass(name, std::span(reads), writes, [&effect, &view, aov](PassContext& context) {
        const auto* maps = view.data.find<ShadowMaps>();
        const std::size_t shadow_views = maps != nullptr ? maps->list->records.size() : 0;
        Variant variant;
        variant.add("AOV", aov);
        const gpu::Program* program = effect.programs.get(variant);
        if (program == nullptr || (aov == kShadowTexelsAov && shadow_views == 0)) {
            return;
        }
        // The sky has a velocity, but no other attribute.
        gpu::PipelineState state = gpu::kFullscreenState;
        if (aov != kVelocityAov) {
            state.depth = {.test = true, .write = false, .func = GL_LESS};
        }
        context.device().use(gpu::Pipeline{program, state});
        bind_view(context, view);
        if (aov == kShadowTexelsAov) {
            maps->records->bind(context.device(), layout::kShadowViewsUnit);
            program->set("shadow_view_count", static_cast<int>(shadow_views));
        }
        context.device().draw_fullscreen();
    });
    return value;
}

}  // namespace

const std::vector<std::string_view>& aov_names() {
    static const std::vector<std::string_view> kNames = [] {
        std::vector<std::string_view> names;
        for (const Aov& aov : kAovs) {
            names.push_back(aov.name);
        }
        return names;
    }();
    return kNames;
}

int aov_channels(std::string_view name) {
    const auto found = std::find_if(
        kAovs.begin(), kAovs.end(), [name](const Aov& aov) { return aov.name == name; });
    return found != kAovs.end() ? found->channels : 0;
}

Result<AovEffect> AovEffect::create(gpu::Device& device, const RenderSettings&) {
    return AovEffect{ProgramVariants::fullscreen(device, "aov.frag")};
}

void AovEffect::collect(FrameData& frame) {
    frame.attributes = true;
    frame.velocity |= is_requested(frame, kAovs[kVelocityAov].name);
}

void AovEffect::draw(FrameGraph& its_graph, const FrameData& frame, ViewData& view) {
    graph = &its_graph;
    textures.clear();
    for (int i = 0; i < kAovCount; ++i) {
        if (is_requested(frame, kAovs[i].name)) {
            const TextureId texture = i == kVolumeLayersAov ? draw_volume_layers(its_graph, view)
                                                            : draw_aov(its_graph, *this, view, i);
            its_graph.keep(texture);
            textures.emplace_back(i, texture);
        }
    }
}

void AovEffect::report(const FrameData&, const ViewData&, FrameOutput& out) {
    for (const auto& [index, texture] : textures) {
        out.aovs.push_back(
            {std::string(kAovs[index].name), kAovs[index].channels, graph->texture(texture)});
    }
}

}  // namespace limn
