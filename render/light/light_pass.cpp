#include "render/light/light_pass.h"

#include "ecs/base/log.h"
#include "render/fullscreen.h"
#include "render/geometry/instance_list.h"
#include "render/gpu/device.h"
#include "render/light/light_clusters.h"
#include "render/light/lighting.h"
#include "render/light/lobe_bounds.h"
#include "render/material/material_pool.h"
#include "render/render_frame.h"
#include "render/shaders/gbuffer_gpu.h"
#include "render/shaders/light_gpu.h"
#include "render/shaders/material_gpu.h"
#include "render/shaders/projector_gpu.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>

// Techniques: deferred.light-pass, light.multi, light.unified

namespace limn {
namespace {

void bind_records(PassContext& context, const LightRecords& lights) {
    lights.records.bind(context.device(), layout::kLightsUnit);
    if (!lights.projector_pool->records().empty()) {
        context.device().bind_texture(
            layout::kProjectorImagesUnit, lights.projector_pool->images());
        lights.projectors.bind(context.device(), layout::kProjectorsUnit);
    }
}

void bind_materials(PassContext& context, const MaterialPool& materials) {
    materials.records().bind(context.device(), layout::kMaterialsUnit);
}

/// What the forward methods loop over.
void upload_objects(
    const FrameData& frame, const ViewData& view, const LightList& lights, LightRecords& to) {
    const auto& list = view.data.get<InstanceList>();
    collect_light_objects(lights, view.data.get<ClusterLights>(), list, to.objects);
    if (view.data.get<LightingMethod>().method == LightMethod::ObjectMajor) {
        list_lights_of_objects(to.objects, list.opaque_instances, to.object_lights);
        to.object_lists.upload(*frame.ring, to.object_lights.lists);
        to.object_indices.upload(*frame.ring, to.object_lights.lights);
    } else {
        list_draws_of_lights(to.objects, list, to.draws);
        to.commands = frame.ring->push(std::span<const DrawCommand>(to.draws.commands));
    }
}

/// The pass, created on first use; null, with a logged error, if that fails.
template <typename Pass>
Pass* get_or_create(
    std::optional<Pass>& pass, gpu::Device& device, Result<Pass> (*create)(gpu::Device&)) {
    if (!pass) {
        Result<Pass> made = create(device);
        if (!made) {
            log_error("{}", made.error().message);
            return nullptr;
        }
        pass = *std::move(made);
    }
    return &*pass;
}

/// Whether pixels are lit lobe by lobe.
bool by_lobes(const MaterialPool& materials) {
    return std::popcount(lobes_of(materials.shading_models())) > 1 || materials.diffuses();
}

constexpr int kScatteredLevels = 6;

TextureId create_scattered(FrameGraph& graph, const ViewData& view) {
    const IVec2 size = view.size();
    return create_target(
        graph, "scattered", view.frame->radiance_format, size,
        std::min(kScatteredLevels, gpu::full_level_count(size.x, size.y)));
}

/// Writes ShadingLobes.
TextureId draw_lobes(FrameGraph& graph, const gpu::Program* program, const ViewData& view) {
    const TextureId lobes =
        create_target(graph, "shading lobes", GL_DEPTH_COMPONENT32F, view.size());
    gpu::PipelineState state = gpu::kFullscreenState;
    state.depth = {.test = true, .write = true, .func = GL_ALWAYS};
    add_fullscreen_pass(
        graph, "shading lobes",
        {sampled(view.gbuffer.surface, layout::kGbufferUnit),
         sampled(view.gbuffer.depth, layout::kDepthUnit)},
        {discarded(lobes)}, program, state, [](PassContext&, const gpu::Program&) {});
    return lobes;
}

void draw_lit(
    PassContext& context, ProgramVariants& programs, const Variant& variant,
    const gpu::PipelineState& state) {
    if (const gpu::Program* program = programs.get(variant)) {
        context.device().use(gpu::Pipeline{program, state});
        context.device().draw_fullscreen();
    }
}

/// One draw per lobe, so that no pixel evaluates other lobes, as a software OpenGL would.
void draw_each_lobe(PassContext& context, ProgramVariants& programs, const ViewData& view) {
    const ShadingModelSet lobes = lobes_of(view.frame->materials->shading_models());
    const auto& bounds = view.data.get<LobeBounds>();
    for (std::uint32_t lobe = 0; lobe < kMaxShadingModels; ++lobe) {
        const PixelBounds& box = bounds[lobe];
        if ((lobes >> lobe & 1u) == 0 || (is_empty(box) && !view.frame->warm_up)) {
            continue;
        }
        Variant variant = view.lighting.variant;
        variant.add("SHADING_LOBE", static_cast<int>(lobe));
        const IVec2 size = glm::max(box.high - box.low, IVec2(0));
        context.device().set_scissor(box.low.x, box.low.y, size.x, size.y);
        draw_lit(context, programs, variant, kWhereLobe);
    }
    context.device().disable_scissor();
}

void draw_clustered(FrameGraph& graph, ProgramVariants& programs, const ViewData& view) {
    const auto* lobes = view.data.find<ShadingLobes>();
    std::vector<Use> reads = surface_reads(
        view, sampled(
                  lobes != nullptr ? Use(view.gbuffer.depth) : depth_tested(view.gbuffer.depth),
                  layout::kDepthUnit));
    if (lobes != nullptr) {
        reads.push_back(depth_tested(lobes->depth));
    }
    std::vector<Use> writes = {cleared(view.radiance)};
    if (view.scattered.valid()) {
        writes.push_back(cleared(view.scattered));
    }
    graph.add_pass(
        "lights", std::span(reads), writes, [&programs, &view, lobes](PassContext& context) {
            bind_lighting(context, view);
            bind_shadow_masks(context, view);
            if (lobes != nullptr) {
                draw_each_lobe(context, programs, view);
            } else {
                draw_lit(context, programs, view.lighting.variant, kWhereSurfaces);
            }
        });
}

}  // namespace

Result<LightEffect> LightEffect::create(gpu::Device& device, const RenderSettings&) {
    LightEffect effect{
        .clustered = ProgramVariants::fullscreen(device, "light_pass.frag"),
        .lobes = ProgramVariants::fullscreen(device, "shading_lobes.frag")};
    LIMN_TRY(effect.clustered.load());
    return effect;
}

bool LightEffect::prepare(const FrameData& frame, ViewData& view) {
    // The view's own lights: shadows have been set, projectors are the last to add to them.
    auto& lights = view.data.publish<LightList>();
    auto& published = view.data.publish<LightRecords>();
    projectors.update(*frame.assets, lights);
    published.records.upload(*frame.ring, lights.records);
    published.projectors.upload(*frame.ring, projectors.records());
    published.projector_pool = &projectors;
    view.lighting.variant.add_if(!projectors.records().empty(), "PROJECTORS");
    view.lighting.add_binding<bind_records>(published);
    view.lighting.add_binding<bind_materials>(*frame.materials);
    if (by_lobes(*frame.materials)) {
        view.data.publish<LobeBounds>() = find_lobe_bounds(*frame.items, view.camera);
    }
    if (view.data.get<LightingMethod>().is_forward()) {
        upload_objects(frame, view, lights, published);
    }
    return true;
}

void LightEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    view.radiance = create_radiance(graph, view);
    const auto& method = view.data.get<LightingMethod>();
    if (method.method == LightMethod::Clustered) {
        if (view.spreads) {
            view.scattered = create_scattered(graph, view);
        }
        if (by_lobes(*frame.materials)) {
            view.data.publish<ShadingLobes>().depth = draw_lobes(graph, lobes.get({}), view);
        }
        draw_clustered(graph, clustered, view);
    } else if (method.is_forward()) {
        if (ForwardPass* pass = get_or_create(forward, *frame.device, create_forward_pass)) {
            TextureId compared;
            if (method.compared) {
                compared = create_radiance(graph, view, "radiance, compared");
                view.data.publish<ComparedRadiance>() = {view.radiance, compared};
            }
            draw_forward(graph, *pass, view, compared);
        }
    } else if (LightEachPass* pass = get_or_create(each, *frame.device, create_light_each_pass)) {
        draw_each_light(graph, *pass, view);
    }
}

void LightEffect::report(const FrameData&, const ViewData& view, FrameOutput& out) {
    const auto* method = view.data.find<LightingMethod>();
    if (method != nullptr && method->method == LightMethod::LightMajor) {
        out.statistics.lit_objects =
            static_cast<int>(view.data.get<LightRecords>().objects.objects.size());
    }
}

}  // namespace limn
