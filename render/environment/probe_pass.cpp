#include "render/environment/probe_pass.h"

#include "render/environment/cube_map.h"
#include "render/environment/environment_maps.h"
#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/lighting.h"
#include "render/render_frame.h"
#include "render/shaders/environment_gpu.h"

// Techniques: env.capture

namespace limn {
namespace {

constexpr int kWarmUpResolution = 16;  ///< of faces drawn only to compile shaders [px]
constexpr int kProbeSamples = 64;      ///< per texel of a probe's reflection map

/// The probes as lit passes read them in a view.
struct ProbeBlockSlice {
    gpu::RingSlice block;
};

void bind_probes(PassContext& context, const ProbeBlockSlice& probes) {
    const gpu::RingSlice& block = probes.block;
    context.device().bind_uniforms(layout::kProbesBinding, block.buffer, block.offset, block.size);
}

/// Whether the face just counted completes a round of six.
bool completes_round(const ProbeSlot& slot) {
    return slot.ready ? slot.drawn % kCubeFaces == 0 : slot.fresh >= kCubeFaces;
}

/// What a probe view draws, decided when it is prepared.
struct ProbeFace {
    int slot = 0;
    int face = 0;
    bool completes_cube = false;
};

}  // namespace

Result<ProbeEffect> ProbeEffect::create(gpu::Device& device, const RenderSettings&) {
    return ProbeEffect{LIMN_TRY(
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "probe_face.frag"}))};
}

void ProbeEffect::request_views(FrameData& frame) {
    if (frame.data.get<SceneEnvironment>().changed) {
        probes.forget();
    }
    probes.collect(
        *frame.world, frame.camera.alpha, frame.warm_up ? kWarmUpResolution : kMaxProbeResolution);
    faces_drawn = 0;
    for (std::size_t i = 0; i < probes.slots().size(); ++i) {
        ProbeSlot& slot = probes.slots()[i];
        if (slot.alive && (!slot.cube || slot.cube.width() != slot.resolution)) {
            slot.cube = gpu::Texture(
                "probe cube", {.format = frame.radiance_format,
                               .width = slot.resolution,
                               .height = slot.resolution,
                               .levels = 0,
                               .target = GL_TEXTURE_CUBE_MAP});
        }
        for (std::uint64_t drawn = slot.drawn; slot.alive && drawn < slot.due; ++drawn) {
            const int face = static_cast<int>(drawn % kCubeFaces);
            frame.views.push_back(
                {kProbeView, make_probe_view(slot, face, frame.camera.alpha), "probe",
                 static_cast<int>(i)});
            ++faces_drawn;
        }
    }
}

bool ProbeEffect::prepare(const FrameData& frame, ViewData& view) {
    if (view.is(kProbeView)) {  // lit without probes
        ProbeSlot& slot = probes.slots()[static_cast<std::size_t>(view.index)];
        auto& drawn = view.data.publish<ProbeFace>();
        drawn = {view.index, static_cast<int>(slot.drawn % kCubeFaces), false};
        ++slot.drawn;
        ++slot.fresh;
        drawn.completes_cube = completes_round(slot);
        slot.ready = slot.ready || drawn.completes_cube;
        return true;
    }
    const layout::ProbeBlock block = probes.make_block();
    if (block.count.x > 0) {
        auto& published = view.data.publish<ProbeBlockSlice>();
        published.block = frame.ring->push_value(block);
        view.lighting.variant.add("PROBES");
        view.lighting.add_binding<bind_probes>(published);
    }
    return false;
}

void ProbeEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto& drawn = view.data.get<ProbeFace>();
    const ProbeSlot& slot = probes.slots()[static_cast<std::size_t>(drawn.slot)];
    const TextureId cube = graph.import("probe cube", slot.cube);
    add_fullscreen_pass(
        graph, "probe face", {sampled(view.radiance, layout::kProbeFaceUnit)},
        {target_level(discarded(cube), 0, drawn.face)}, program);
    if (drawn.completes_cube) {
        const auto& environment = frame.data.get<SceneEnvironment>();
        draw_cube_levels(graph, slot.cube);
        draw_cube_reflection(
            graph, *environment.reflection, environment.block_slice, slot.cube,
            probe_layer(static_cast<std::size_t>(drawn.slot)), kProbeSamples);
    }
}

void ProbeEffect::report(const FrameData&, const ViewData&, FrameOutput& out) {
    out.statistics.probe_faces = faces_drawn;
}

}  // namespace limn
