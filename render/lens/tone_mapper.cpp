#include "render/lens/tone_mapper.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/tone_gpu.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// Techniques: hdr.pipeline

namespace limn {
namespace {

/// `measure`, if valid(), for defog and metering.
TextureId add_tone_map(
    FrameGraph& graph, const ToneMapper& tone_mapper, const Exposure& exposure, TextureId radiance,
    BufferId measure, const std::optional<LocalLuminance>& local) {
    const TextureId display = create_target(graph, "display", GL_RGBA8, size_of(graph, radiance));
    std::vector<Use> reads = {sampled(radiance, layout::kSourceUnit)};
    if (measure.valid()) {
        reads.emplace_back(measure);
    }
    if (local) {
        reads.insert(
            reads.end(), {sampled(local->fine, layout::kLocalFineUnit),
                          sampled(local->medium, layout::kLocalMediumUnit),
                          sampled(local->coarse, layout::kLocalCoarseUnit)});
    }
    const std::array writes = {discarded(display)};
    graph.add_pass(
        "tone map", std::span(reads), writes,
        [&tone_mapper, exposure, measure](PassContext& context) {
            const gpu::Program& program =
                *tone_mapper.programs[static_cast<std::size_t>(exposure.curve)];
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            const bool manual = exposure.metering == Metering::Manual;
            program.set("exposure", std::exp2(exposure.ev + (manual ? exposure.manual_ev : 0.0f)));
            program.set("defog", exposure.defog);
            program.set("inverse_white", exposure.white > 0.0f ? 1.0f / exposure.white : 0.0f);
            program.set("contrast", exposure.contrast);
            program.set("key", exposure.key);
            const bool power =
                exposure.encoding == DisplayEncoding::Power || exposure.curve == ToneCurve::Knee;
            program.set("gamma", power ? exposure.gamma : 0.0f);
            program.set("dither_codes", exposure.dither ? 1.0f : 0.0f);
            if (measure.valid()) {
                context.bind_uniforms(layout::kToneMeasureBinding, measure);
            } else {
                context.device().bind_uniforms(layout::kToneMeasureBinding, tone_mapper.no_measure);
            }
            context.device().draw_fullscreen();
        });
    return display;
}

}  // namespace

Result<ToneMapper> create_tone_mapper(gpu::Device& device) {
    ToneMapper tone_mapper = {
        LIMN_TRY(create_statistics_pass(device)), LIMN_TRY(create_local_luminance_pass(device))};
    for (std::size_t curve = 0; curve < tone_mapper.programs.size(); ++curve) {
        tone_mapper.programs[curve] = LIMN_TRY(
            load_fullscreen(device, "tone_map.frag", {{"TONE_CURVE", std::to_string(curve)}}));
    }
    layout::ImageStatistics none{};
    none.mean_scale = {0, 0, 0, 1};
    tone_mapper.no_measure = gpu::Buffer("no measure", sizeof(none), gpu::BufferUse::Static, &none);
    return tone_mapper;
}

TextureId apply_tone_mapper(
    FrameGraph& graph, ToneMapper& tone_mapper, const Exposure& exposure,
    std::optional<float> seconds, TextureId radiance, TextureId depth) {
    BufferId measure;
    const bool metered = exposure.metering != Metering::Manual;
    const bool adapts = exposure.metering == Metering::Auto;
    if (metered || exposure.defog > 0.0f) {
        const bool follows = adapts && tone_mapper.adapting && seconds.has_value();
        measure = measure_image(
            graph, tone_mapper.statistics, radiance,
            {.key = metered ? exposure.key : 0.0f,
             .blend = follows ? adaptation_blend(exposure.adaptation, *seconds) : 1.0f,
             .adaptation_range =
                 {exposure.min_luminance, std::max(exposure.min_luminance, exposure.max_luminance)},
             .depth = exposure.meter_surfaces ? depth : TextureId{}});
    }
    tone_mapper.adapting = adapts;
    std::optional<LocalLuminance> local;
    if (exposure.curve == ToneCurve::Local) {
        local = blur_luminance(graph, tone_mapper.local, radiance);
    }
    return add_tone_map(graph, tone_mapper, exposure, radiance, measure, local);
}

Result<ToneMapEffect> ToneMapEffect::create(gpu::Device& device, const RenderSettings&) {
    return ToneMapEffect{LIMN_TRY(create_tone_mapper(device))};
}

void ToneMapEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto* exposure = frame.world->find_resource<Exposure>();
    view.display = apply_tone_mapper(
        graph, tone_mapper, exposure != nullptr ? *exposure : Exposure{}, frame.since_last,
        view.radiance, view.gbuffer.depth);
}

}  // namespace limn
