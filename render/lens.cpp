#include "render/lens.h"

#include "ecs/base/log.h"
#include "ecs/world.h"
#include "render/frame_scene.h"
#include "render/render_frame.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
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

/// Numbers that code wrote, brought to where a file may have them; what is none counts as 0.
template <typename Setting>
Setting within_ranges(Setting setting) {
    visit_fields(setting, [](std::string_view, auto& field, const FieldMeta& meta = {}) {
        if constexpr (std::is_same_v<decltype(field), float&>) {
            constexpr double kMost = 1e6;  // of what has no range
            const double number = std::isnan(field) ? 0.0 : static_cast<double>(field);
            field = static_cast<float>(
                std::clamp(number, std::max(meta.min, -kMost), std::min(meta.max, kMost)));
        }
    });
    return setting;
}

bool opens_shutter(const MotionBlur& blur) {
    return blur.shutter > 0.0f && blur.longest > 0.0f;
}

/// Forgets the pictures that modes keep which are not in use: they are not the ones before.
void forget_pictures(LensPasses& passes, bool open, MotionBlurMode mode) {
    auto* accumulate = passes.motion_accumulate.made();
    if (accumulate != nullptr && !(open && mode == MotionBlurMode::Accumulate)) {
        forget_motion(*accumulate);
    }
    auto* stretch = passes.motion_stretch.made();
    if (stretch != nullptr && !(open && mode == MotionBlurMode::Stretch)) {
        forget_motion(*stretch);
    }
}

TextureId apply_motion_blur(
    FrameGraph& graph, LensPasses& passes, const MotionBlur& blur, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance) {
    const bool open = opens_shutter(blur);
    forget_pictures(passes, open, blur.mode);
    if (!open) {
        return radiance;
    }
    gpu::Device& device = *passes.device;
    switch (blur.mode) {
    case MotionBlurMode::Reconstruct:
        if (const auto* pass = passes.motion_blur.get(device, create_motion_blur_pass)) {
            return blur_motion(graph, *pass, blur, scene, gbuffer, radiance);
        }
        break;
    case MotionBlurMode::Accumulate:
        if (auto* pass = passes.motion_accumulate.get(device, create_motion_accumulate_pass)) {
            const int window = std::clamp(blur.window, 1, 16);
            return accumulate_motion(graph, *pass, window, !scene.since_last, radiance);
        }
        break;
    case MotionBlurMode::Camera:
        if (const auto* pass = passes.motion_camera.get(device, create_motion_camera_pass)) {
            return blur_camera_motion(graph, *pass, blur, scene, gbuffer, radiance);
        }
        break;
    case MotionBlurMode::Flow:
        if (auto* pass = passes.motion_flow.get(device, create_motion_flow_pass)) {
            return blur_along_flow(graph, *pass, blur, scene, gbuffer, radiance);
        }
        break;
    case MotionBlurMode::Stretch:
        if (auto* pass = passes.motion_stretch.get(device, create_motion_stretch_pass)) {
            return stretch_motion(graph, *pass, blur, scene, gbuffer, radiance);
        }
        break;
    }
    return radiance;
}

TextureId apply_antialiasing(
    FrameGraph& graph, LensPasses& passes, Antialiasing antialiasing, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance) {
    if (antialiasing == Antialiasing::Temporal) {
        auto* pass = passes.temporal.get(*passes.device, create_temporal_pass);
        return pass == nullptr ? radiance
                               : resolve_temporally(graph, *pass, scene, gbuffer, radiance);
    }
    if (auto* pass = passes.temporal.made()) {
        forget_pictures(*pass);
    }
    return radiance;
}

TextureId apply_glow(
    FrameGraph& graph, LensPasses& passes, const Glow& glow, const Gbuffer& gbuffer,
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

LensSettings lens_settings(const World& world, const RenderView& view) {
    LensSettings settings{.ripples = collect_ripples(world, view)};
    settings.depth_of_field = has_depth_of_field(view);
    if (const auto* rendering = world.find_resource<Rendering>()) {
        settings.antialiasing = rendering->antialiasing;
    }
    if (const auto* glare = world.find_resource<Glare>()) {
        settings.glare = within_ranges(*glare);
    }
    if (const auto* glow = world.find_resource<Glow>()) {
        settings.glow = within_ranges(*glow);
    }
    if (const auto* blur = world.find_resource<MotionBlur>()) {
        settings.motion_blur = *blur;
    }
    return settings;
}

LensSettings lens_of_sample(const LensSettings& settings, SampleKind kind) {
    LensSettings sample = settings;
    sample.antialiasing = Antialiasing::None;
    sample.glare.strength = 0;
    if (sample.glow.kind != GlowKind::Mask) {
        sample.glow.strength = 0;
    }
    if (kind == SampleKind::Instant || keeps_pictures(sample.motion_blur.mode)) {
        sample.motion_blur.shutter = 0;
    }
    return sample;
}

LensSettings lens_of_mean(const LensSettings& settings) {
    LensSettings rest = settings;
    rest.ripples = {};
    rest.antialiasing = Antialiasing::None;
    if (rest.glow.kind == GlowKind::Mask) {
        rest.glow.strength = 0;  // needs surfaces, which a mean has none of
    }
    rest.motion_blur.shutter = 0;
    rest.depth_of_field = false;
    return rest;
}

bool needs_velocity(const LensSettings& settings) {
    const MotionBlurMode mode = settings.motion_blur.mode;
    const bool smears = mode == MotionBlurMode::Reconstruct || mode == MotionBlurMode::Flow
                        || mode == MotionBlurMode::Stretch;
    return settings.antialiasing == Antialiasing::Temporal
           || (opens_shutter(settings.motion_blur) && smears);
}

bool needs_attributes(const LensSettings& settings) {
    return settings.glow.strength > 0 && settings.glow.kind == GlowKind::Mask;
}

RenderView
lens_view(LensPasses& passes, const LensSettings& settings, const RenderView& view, bool cut) {
    passes.picture = cut ? 0 : passes.picture + 1;
    if (settings.antialiasing != Antialiasing::Temporal) {
        return view;
    }
    return with_jitter(view, sample_jitter(passes.picture % kTemporalSamples, kTemporalSamples));
}

TextureId apply_lens(
    FrameGraph& graph, LensPasses& passes, const LensSettings& settings, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance) {
    radiance = apply_antialiasing(graph, passes, settings.antialiasing, scene, gbuffer, radiance);
    if (!settings.ripples.empty()) {
        if (const auto* pass = passes.ripple.get(*passes.device, create_ripple_pass)) {
            radiance = draw_ripples(graph, *pass, settings.ripples, scene, gbuffer, radiance);
        }
    }
    radiance = apply_motion_blur(graph, passes, settings.motion_blur, scene, gbuffer, radiance);
    if (settings.depth_of_field) {
        auto* pass = passes.depth_of_field.get(*passes.device, create_depth_of_field_pass);
        if (pass != nullptr) {
            radiance = draw_depth_of_field(graph, *pass, scene.view, radiance, gbuffer.depth);
        }
    }
    if (settings.glare.strength > 0) {
        if (const auto* pass = passes.glare.get(*passes.device, create_glare_pass)) {
            radiance = draw_glare(graph, *pass, settings.glare, radiance);
        }
    }
    return apply_glow(graph, passes, settings.glow, gbuffer, radiance);
}

}  // namespace limn
