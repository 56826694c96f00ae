#include "render/lens.h"

#include "ecs/base/log.h"
#include "ecs/world.h"
#include "render/frame_scene.h"

#include <utility>

namespace limn {

template <typename Pass>
Pass* OptionalPass<Pass>::get(gpu::Device& device, Result<Pass> (*create)(gpu::Device&)) {
    if (!pass_ && !failed_) {
        Result<Pass> made = create(device);
        if (made) {
            pass_ = *std::move(made);
        } else {
            failed_ = true;
            log_error("{}", made.error().message);
        }
    }
    return pass_ ? &*pass_ : nullptr;
}

LensSettings lens_settings(const World& world, const RenderView& /*view*/) {
    LensSettings settings;
    if (const auto* glow = world.find_resource<Glow>()) {
        settings.glow = *glow;
    }
    if (const auto* blur = world.find_resource<MotionBlur>()) {
        settings.motion_blur = *blur;
    }
    return settings;
}

LensSettings lens_of_mean(const LensSettings& settings) {
    LensSettings rest = settings;
    rest.motion_blur.shutter = 0;
    return rest;
}

bool needs_velocity(const LensSettings& settings) {
    return blurs(settings.motion_blur);
}

TextureId apply_lens(
    FrameGraph& graph,
    LensPasses& passes,
    const LensSettings& settings,
    const FrameScene& scene,
    const Gbuffer& gbuffer,
    TextureId radiance) {
    if (blurs(settings.motion_blur)) {
        if (const MotionBlurPass* pass =
                passes.motion_blur.get(*passes.device, create_motion_blur_pass)) {
            radiance = blur_motion(graph, *pass, settings.motion_blur, scene, gbuffer, radiance);
        }
    }
    if (settings.glow.strength > 0) {
        if (const GlowPass* pass = passes.glow.get(*passes.device, create_glow_pass)) {
            radiance = draw_glow(graph, *pass, settings.glow, radiance);
        }
    }
    return radiance;
}

}  // namespace limn
