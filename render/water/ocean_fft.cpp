#include "render/water/ocean_fft.h"

#include "ecs/base/check.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/ocean_gpu.h"

#include <string>
#include <vector>

// Techniques: water.fft-synthesis

namespace limn {
namespace {

constexpr std::size_t kLineElement = 32;  ///< four complex numbers [bytes]

void upload_spectra(const OceanState& state, OceanFft& fft) {
    std::vector<Vec4> waves;
    std::vector<float> frequencies;
    for (const OceanCascade& cascade : state.cascades) {
        for (std::size_t i = 0; i < cascade.frequency.size(); ++i) {
            waves.emplace_back(
                cascade.ahead_re[i], cascade.ahead_im[i], cascade.behind_re[i],
                cascade.behind_im[i]);
        }
        frequencies.insert(frequencies.end(), cascade.frequency.begin(), cascade.frequency.end());
    }
    fft.waves = gpu::Buffer::of<Vec4>("ocean waves", waves);
    fft.frequencies = gpu::Buffer::of<float>("ocean frequencies", frequencies);
    fft.lines = gpu::Buffer("ocean lines", waves.size() * kLineElement, gpu::BufferUse::GpuOnly);
}

gpu::Texture make_field(const char* label, const OceanFft& fft) {
    gpu::Texture texture(
        label, {.format = GL_RGBA32F,
                .width = fft.size,
                .height = fft.size,
                .depth = fft.cascades,
                .target = GL_TEXTURE_2D_ARRAY});
    texture.set_wrap(GL_REPEAT);
    return texture;
}

}  // namespace

Result<OceanFft> create_ocean_fft(gpu::Device& device, const OceanState& state) {
    LIMN_CHECK(!state.cascades.empty() && state.cascades.size() <= kMaxOceanCascades);
    OceanFft fft;
    fft.size = state.cascades.front().size;
    fft.cascades = static_cast<int>(state.cascades.size());
    for (int i = 0; i < fft.cascades; ++i) {
        fft.patches[i] = state.cascades[i].patch;
    }
    const std::vector<gpu::ShaderDefine> size = {{"SIZE", std::to_string(fft.size) + "u"}};
    const Result<const gpu::Program*> waves =
        device.shaders().load({.compute = "ocean_waves.comp", .defines = size});
    if (!waves) {
        return waves.error();
    }
    const Result<const gpu::Program*> fields =
        device.shaders().load({.compute = "ocean_fields.comp", .defines = size});
    if (!fields) {
        return fields.error();
    }
    fft.waves_program = *waves;
    fft.fields_program = *fields;
    upload_spectra(state, fft);
    fft.fields.displacement = make_field("ocean displacement", fft);
    fft.fields.derivatives = make_field("ocean derivatives", fft);
    return fft;
}

OceanFieldIds
synthesize_ocean(FrameGraph& graph, const OceanFft& fft, float choppiness, double time) {
    const BufferId lines = graph.import("ocean.lines", fft.lines);
    const OceanFieldIds fields = {
        graph.import("ocean.displacement", fft.fields.displacement),
        graph.import("ocean.derivatives", fft.fields.derivatives)};
    const unsigned size = static_cast<unsigned>(fft.size);
    const unsigned cascades = static_cast<unsigned>(fft.cascades);

    const double turns = time / 6.283185307179586;
    const float whole = static_cast<float>(turns);
    const Vec2 time_in_periods = {whole, static_cast<float>(turns - static_cast<double>(whole))};
    graph.add_pass("ocean waves", {}, {lines}, [=, &fft](PassContext& context) {
        gpu::Device& device = context.device();
        device.use(*fft.waves_program);
        fft.waves_program->set("patches", fft.patches);
        fft.waves_program->set("choppiness", choppiness);
        fft.waves_program->set("time_in_periods", time_in_periods);
        device.bind_storage(layout::kOceanWavesBinding, fft.waves);
        device.bind_storage(layout::kOceanFrequenciesBinding, fft.frequencies);
        context.bind_storage(layout::kOceanLinesBinding, lines);
        device.dispatch(size, cascades);
    });
    graph.add_pass(
        "ocean fields", {lines}, {image(fields.displacement), image(fields.derivatives)},
        [=, &fft](PassContext& context) {
            gpu::Device& device = context.device();
            device.use(*fft.fields_program);
            context.bind_storage(layout::kOceanLinesBinding, lines);
            context.bind_image(layout::kOceanDisplacementImage, fields.displacement, GL_WRITE_ONLY);
            context.bind_image(layout::kOceanDerivativesImage, fields.derivatives, GL_WRITE_ONLY);
            device.dispatch(size, cascades);
        });
    return fields;
}

}  // namespace limn
