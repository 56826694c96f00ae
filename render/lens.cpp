#include "render/lens.h"

#include "ecs/base/log.h"
#include "ecs/world.h"
#include "render/frame_scene.h"

#include <algorithm>
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

namespace {

bool opens_shutter(const MotionBlur& blur) {
    return blur.shutter > 0.0f && blur.longest > 0.0f;
}

TextureId apply_motion_blur(
    FrameGraph& graph,
    LensPasses& passes,
    const MotionBlur& blur,
    const FrameScene& scene,
    const Gbuffer& gbuffer,
    TextureId radiance) {
    const bool open = opens_shutter(blur);
    if (open && blur.mode == MotionBlurMode::Accumulate) {
        auto* pass = passes.motion_accumulate.get(*passes.device, create_motion_accumulate_pass);
        const int window = std::clamp(blur.window, 1, 16);
        return pass == nullptr
                   ? radiance
                   : accumulate_motion(graph, *pass, window, !scene.since_last, radiance);
    }
    if (auto* pass = passes.motion_accumulate.made()) {
        forget_motion(*pass);
    }
    if (open && blur.mode == MotionBlurMode::Reconstruct) {
        const auto* pass = passes.motion_blur.get(*passes.device, create_motion_blur_pass);
        return pass == nullptr ? radiance
                               : blur_motion(graph, *pass, blur, scene, gbuffer, radiance);
    }
    if (open && blur.mode == MotionBlurMode::Camera) {
        const auto* pass = passes.motion_camera.get(*passes.device, create_motion_camera_pass);
        return pass == nullptr ? radiance
                               : blur_camera_motion(graph, *pass, blur, scene, gbuffer, radiance);
    }
    return radiance;
}

TextureId apply_glow(
    FrameGraph& graph,
    LensPasses& passes,
    const Glow& glow,
    const Gbuffer& gbuffer,
    TextureId radiance) {
    if (glow.strength > 0 && glow.kind == GlowKind::Lens) {
        const auto* pass = passes.glow.get(*passes.device, create_glow_pass);
        return pass == nullptr ? radiance : draw_glow(graph, *pass, glow, radiance);
    }
    if (glow.strength > 0 && glow.kind == GlowKind::Mask) {
        const auto* pass = passes.glow_mask.get(*passes.device, create_glow_mask_pass);
        return pass == nullptr ? radiance : draw_glow_mask(graph, *pass, glow, gbuffer, radiance);
    }
    return radiance;
}

}  // namespace

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
    return opens_shutter(settings.motion_blur)
           && settings.motion_blur.mode == MotionBlurMode::Reconstruct;
}

bool needs_attributes(const LensSettings& settings) {
    return settings.glow.strength > 0 && settings.glow.kind == GlowKind::Mask;
}

TextureId apply_lens(
    FrameGraph& graph,
    LensPasses& passes,
    const LensSettings& settings,
    const FrameScene& scene,
    const Gbuffer& gbuffer,
    TextureId radiance) {
    radiance = apply_motion_blur(graph, passes, settings.motion_blur, scene, gbuffer, radiance);
    return apply_glow(graph, passes, settings.glow, gbuffer, radiance);
}

}  // namespace limn
