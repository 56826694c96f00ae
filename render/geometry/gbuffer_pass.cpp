#include "render/geometry/gbuffer_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/surface.h"
#include "render/fullscreen.h"
#include "render/geometry/surface_draws.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/hatched_view.h"
#include "render/light/lighting.h"
#include "render/material/fur_hook.h"
#include "render/material/material_pool.h"
#include "render/render_frame.h"
#include "render/shadow/volume_list.h"
#include "render/view_block.h"

#include <algorithm>
#include <array>

// Techniques: deferred.gbuffer

namespace limn {
namespace {

/// Fills background pixels; draws nothing while the camera is at rest.
void draw_sky_velocity(FrameGraph& graph, const gpu::Program* program, const ViewData& view) {
    if (view.camera.previous_clip_from_world == view.camera.unjittered_from_world) {
        return;
    }
    gpu::PipelineState state = gpu::kFullscreenState;
    state.depth = {.test = true, .write = false, .func = GL_EQUAL};
    add_fullscreen_pass(
        graph, "gbuffer, sky velocity", {depth_tested(view.gbuffer.depth)}, {view.gbuffer.velocity},
        program, state,
        [&view](PassContext& context, const gpu::Program&) { bind_view(context, view); });
}

/// Hybrid shadows read normals.
bool needs_normals(const ViewData& view) {
    const auto* volumes = view.data.find<VolumeList>();
    return volumes != nullptr
           && std::any_of(
               volumes->lights.begin(), volumes->lights.end(),
               [](const VolumeLight& light) { return light.hybrid; });
}

}  // namespace

GLenum depth_format(const ViewData& view) {
    const LightMethod method = view.data.get<LightingMethod>().method;
    const bool by_screen = method == LightMethod::Clustered || method == LightMethod::FullScreen;
    const auto* volumes = view.data.find<VolumeList>();
    const bool stencil = !by_screen || (volumes != nullptr && !volumes->lights.empty());
    return stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F;
}

Result<GbufferEffect> GbufferEffect::create(gpu::Device& device, const RenderSettings&) {
    GbufferEffect effect{
        .programs = ProgramVariants::of_meshes(device, "gbuffer.frag"),
        .depth_first = ProgramVariants::of_meshes(device, "depth_first.frag")};
    LIMN_TRY(effect.programs.load());
    effect.sky_velocity = LIMN_TRY(
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "sky_velocity.frag"}));
    return effect;
}

bool GbufferEffect::prepare(const FrameData& frame, ViewData& view) {
    auto& list = view.data.publish<InstanceList>();
    const auto& method = view.data.get<LightingMethod>();
    collector.collect(
        *frame.items, view.camera, view.velocity, *frame.ring, list, method.is_forward());
    if (method.shading != ShadingRate::Pixel || method.compared) {
        // Programs that light vertices draw the mesh alone.
        std::erase_if(list.opaque, [](const DrawRun& run) { return is_fur(run.features); });
        for (DrawRun& run : list.opaque) {
            remove_off_mesh_hooks(run.features);
        }
    }
    for (const std::uint32_t mesh : list.without_tangents) {
        if (reported_meshes.insert(mesh).second) {
            log_warn(
                "mesh {}: no tangents found, expected one per vertex; drawn without its normal map",
                frame.assets->meshes[mesh].name);
        }
    }
    return true;
}

void GbufferEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto create = [&](const char* name, GLenum format) {
        return graph.create(
            {.name = name,
             .format = format,
             .width = view.camera.width,
             .height = view.camera.height});
    };
    const bool attributes = view.attributes || view.velocity || needs_normals(view);
    const bool forward = view.data.get<LightingMethod>().is_forward();
    if (forward && !attributes) {
        view.gbuffer.depth = create("depth", depth_format(view));
        graph.add_pass(
            "depth", mesh_reads(graph, frame), std::array{cleared(view.gbuffer.depth)},
            [this, &view](PassContext& context) {
                bind_view(context, view);
                draw_depths(context, view, view.data.get<InstanceList>().opaque, depth_first);
            });
        return;
    }
    view.gbuffer.surface = create("gbuffer.surface", GL_RGBA32UI);
    view.gbuffer.depth = create("gbuffer.depth", depth_format(view));
    std::vector<Use> writes = {discarded(view.gbuffer.surface)};
    if (view.velocity) {
        view.gbuffer.velocity = create("gbuffer.velocity", frame.velocity_format);
        writes.push_back(cleared(view.gbuffer.velocity));
    }
    const bool is_read = !forward && reads_material_records(frame.materials->shading_models());
    if (is_read || view.material_ids) {
        const bool layered = is_read && frame.materials->layers() != 0;
        view.gbuffer.material =
            create("gbuffer.material", static_cast<GLenum>(layered ? GL_RG32UI : GL_R32UI));
        writes.push_back(discarded(view.gbuffer.material));
        if (layered) {
            view.gbuffer.layers = create("gbuffer.layers", GL_RGBA32UI);
            writes.push_back(discarded(view.gbuffer.layers));
        }
    }
    if (!forward && frame.materials->key_shadows()) {
        view.gbuffer.key_light = create("gbuffer.key_light", GL_RG8);
        writes.push_back(discarded(view.gbuffer.key_light));
    }
    writes.push_back(cleared(view.gbuffer.depth));
    graph.add_pass(
        "gbuffer", mesh_reads(graph, frame), writes, [this, &view](PassContext& context) {
            const bool clipped = is_clipped(view);
            Variant variant;
            variant.add_if(clipped, "CLIPPED");
            variant.add_if(view.gbuffer.material.valid(), "MATERIAL_RECORDS");
            variant.add_if(view.gbuffer.layers.valid(), "LAYER_TARGETS");
            variant.add_if(view.gbuffer.key_light.valid(), "KEY_SHADOWS");
            variant.add_if(view.data.find<HatchedView>() != nullptr, "HATCHED");
            if (view.gbuffer.key_light.valid()) {
                bind_lighting(context, view);
            } else {
                bind_view(context, view);
            }
            draw_runs(
                context, view, view.data.get<InstanceList>().opaque, programs,
                {.variant = &variant,
                 .features = view.velocity ? kVelocity : 0u,
                 .state = {.clip = clipped}});
        });
    if (view.velocity) {
        draw_sky_velocity(graph, sky_velocity, view);
    }
}

void GbufferEffect::report(const FrameData&, const ViewData& view, FrameOutput& out) {
    if (const auto* list = view.data.find<InstanceList>()) {
        out.statistics.instances = list->total;
        out.statistics.visible_instances = list->visible;
        out.statistics.draws = static_cast<int>(list->opaque.size() + list->blended.size());
        out.statistics.tested_boxes = list->tested;
        out.statistics.triangles = list->triangles;
    }
}

}  // namespace limn
