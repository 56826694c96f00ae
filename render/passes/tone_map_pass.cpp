#include "render/passes/tone_map_pass.h"

#include "render/gpu/shader_library.h"
#include "render/shaders/tone_gpu.h"

#include <cmath>
#include <string>
#include <vector>

namespace limn {
namespace {

constexpr unsigned kMeasureBinding = 2;
constexpr unsigned kLocalUnit = 1;

}  // namespace

Result<ToneMapPass> create_tone_map_pass(gpu::Device& device) {
    ToneMapPass pass;
    for (std::size_t curve = 0; curve < pass.programs.size(); ++curve) {
        const Result<const gpu::Program*> program = device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "tone_map.frag",
             .defines = {{"TONE_CURVE", std::to_string(curve)}}});
        if (!program) {
            return program.error();
        }
        pass.programs[curve] = *program;
    }
    layout::PictureMeasure none{};
    none.mean_scale = {0, 0, 0, 1};
    pass.no_measure = gpu::Buffer("no measure", sizeof(none), gpu::BufferUse::Static, &none);
    return pass;
}

TextureId tone_map(
    FrameGraph& graph, const ToneMapPass& pass, const Exposure& exposure,
    const ToneMapInput& input) {
    LIMN_CHECK(input.local.has_value() == (exposure.curve == ToneCurve::Local));
    const TextureSpec source = graph.spec(input.radiance);
    const TextureId display = graph.create(
        {.name = "display", .format = GL_RGBA8, .width = source.width, .height = source.height});
    std::vector<Use> reads = {input.radiance};
    if (input.measure.valid()) {
        reads.emplace_back(input.measure);
    }
    if (input.local) {
        reads.insert(
            reads.end(), {Use(input.local->fine), input.local->middle, input.local->coarse});
    }
    const std::array writes = {discarded(display)};
    graph.add_pass(
        "tone map", std::span(reads), writes, [&pass, exposure, input](PassContext& context) {
            const gpu::Program& program = *pass.programs[static_cast<std::size_t>(exposure.curve)];
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("exposure", std::exp2(exposure.ev));
            program.set("defog", exposure.defog);
            program.set("per_white", exposure.white > 0.0f ? 1.0f / exposure.white : 0.0f);
            program.set("contrast", exposure.contrast);
            program.set("key", exposure.key);
            const bool power =
                exposure.encoding == DisplayEncoding::Power || exposure.curve == ToneCurve::Knee;
            program.set("gamma", power ? exposure.gamma : 0.0f);
            program.set("dither_codes", exposure.dither ? 1.0f : 0.0f);
            context.bind_texture(0, input.radiance);
            if (input.local) {
                context.bind_texture(kLocalUnit, input.local->fine);
                context.bind_texture(kLocalUnit + 1, input.local->middle);
                context.bind_texture(kLocalUnit + 2, input.local->coarse);
            }
            if (input.measure.valid()) {
                context.bind_uniforms(kMeasureBinding, input.measure);
            } else {
                context.device().bind_uniforms(kMeasureBinding, pass.no_measure);
            }
            context.device().draw_fullscreen();
        });
    return display;
}

}  // namespace limn
