#include "render/develop.h"

#include "render/render_view.h"

namespace limn {
namespace {

constexpr double kLongestShot = 1.0;  // [s] between two pictures

}  // namespace

Result<Developer> create_developer(gpu::Device& device) {
    Result<StatisticsPass> statistics = create_statistics_pass(device);
    if (!statistics) {
        return statistics.error();
    }
    Result<LocalLuminancePass> local = create_local_luminance_pass(device);
    if (!local) {
        return local.error();
    }
    Result<ToneMapPass> tone_map = create_tone_map_pass(device);
    if (!tone_map) {
        return tone_map.error();
    }
    return Developer{*std::move(statistics), *std::move(local), *std::move(tone_map)};
}

TextureId develop(
    FrameGraph& graph, Developer& developer, const Exposure& exposure, std::optional<float> seconds,
    TextureId radiance) {
    ToneMapInput input{.radiance = radiance};
    const bool metered = exposure.metering != Metering::Manual;
    const bool adapts = exposure.metering == Metering::Auto;
    if (metered || exposure.defog > 0.0f) {
        const bool follows = adapts && developer.adapting && seconds.has_value();
        input.measure = measure_picture(
            graph, developer.statistics, radiance,
            {.key = metered ? exposure.key : 0.0f,
             .follow = follows ? eye_follows(exposure.adaptation, *seconds) : 1.0f,
             .adaptable = {exposure.darkest, std::max(exposure.darkest, exposure.brightest)}});
    }
    developer.adapting = adapts;
    if (exposure.curve == ToneCurve::Local) {
        input.local = blur_luminance(graph, developer.local, radiance);
    }
    return tone_map(graph, developer.tone_map, exposure, input);
}

std::optional<float>
seconds_since_last(PictureClock& clock, std::uint64_t world, double time, const Affine& camera) {
    const double seconds = time - clock.time;
    const bool cut = !clock.running || clock.world != world || seconds < 0.0
                     || seconds > kLongestShot || is_cut(clock.camera, camera);
    clock = {true, world, time, camera};
    return cut ? std::nullopt : std::optional(static_cast<float>(seconds));
}

}  // namespace limn
