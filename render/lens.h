#pragma once

#include "ecs/components/glow.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/rendering.h"
#include "render/gbuffer.h"
#include "render/passes/depth_of_field_pass.h"
#include "render/passes/glare_pass.h"
#include "render/passes/glow_mask_pass.h"
#include "render/passes/glow_pass.h"
#include "render/passes/motion_accumulate_pass.h"
#include "render/passes/motion_blur_pass.h"
#include "render/passes/motion_camera_pass.h"
#include "render/passes/motion_flow_pass.h"
#include "render/passes/motion_stretch_pass.h"
#include "render/passes/ripple_pass.h"
#include "render/passes/temporal_pass.h"

#include <cstdint>
#include <optional>

namespace limn {

class World;
enum class SampleKind : std::uint8_t;
struct FrameScene;
struct RenderView;

namespace gpu {
class Device;
}

// What happens to a picture's radiance in the lens and behind the shutter, before it is developed:
//
//     temporal anti-aliasing -> ripple -> motion blur -> depth of field -> glare -> glow
//
// Each is a pass of its own that a resource or component of the world asks for; what nobody asks
// for adds no pass. Programs are compiled when they are first needed.

/// What the world and the camera ask of the lens, at the moment that a view shows.
struct LensSettings {
    RippleList ripples;
    bool depth_of_field = false;  ///< through the lens of the view
    Antialiasing antialiasing = Antialiasing::None;
    Glare glare{.strength = 0};
    Glow glow{.strength = 0};
    MotionBlur motion_blur{.shutter = 0};
};

[[nodiscard]] LensSettings lens_settings(const World& world, const RenderView& view);

/// Of a picture that becomes part of a mean, and of the mean: each is done once (render_frame.h).
[[nodiscard]] LensSettings lens_of_sample(const LensSettings& settings, SampleKind kind);
[[nodiscard]] LensSettings lens_of_mean(const LensSettings& settings);

/// Whether some effect wants to know what moves, or what the G-buffer says of surfaces.
[[nodiscard]] bool needs_velocity(const LensSettings& settings);
[[nodiscard]] bool needs_attributes(const LensSettings& settings);

/// A pass that is made when it is first needed. If that fails, it is logged once and there is none.
template <typename Pass>
class OptionalPass {
  public:
    /// Null if it cannot be made.
    [[nodiscard]] Pass* get(gpu::Device& device, Result<Pass> (*create)(gpu::Device&));
    /// Null if it was not needed yet.
    [[nodiscard]] Pass* made() { return pass_ ? &*pass_ : nullptr; }

  private:
    std::optional<Pass> pass_;
    bool failed_ = false;
};

struct LensPasses {
    explicit LensPasses(gpu::Device& its_device) : device(&its_device) {}

    gpu::Device* device;
    int picture = 0;  ///< since the last cut
    OptionalPass<TemporalPass> temporal;
    OptionalPass<MotionBlurPass> motion_blur;
    OptionalPass<MotionAccumulatePass> motion_accumulate;
    OptionalPass<MotionCameraPass> motion_camera;
    OptionalPass<MotionFlowPass> motion_flow;
    OptionalPass<MotionStretchPass> motion_stretch;
    OptionalPass<DepthOfFieldPass> depth_of_field;
    OptionalPass<RipplePass> ripple;
    OptionalPass<GlarePass> glare;
    OptionalPass<GlowPass> glow;
    OptionalPass<GlowMaskPass> glow_mask;
};

/// The view that is to be drawn: if pictures are laid over each other, moved by another part of a
/// pixel each time. Once a picture; `cut`: it does not follow the one before.
[[nodiscard]] RenderView
lens_view(LensPasses& passes, const LensSettings& settings, const RenderView& view, bool cut);

/// Adds the passes to this frame; returns the radiance that reaches the film, or `radiance` itself
/// if nothing is to be done. What is drawn into is always a texture of its own.
[[nodiscard]] TextureId apply_lens(
    FrameGraph& graph, LensPasses& passes, const LensSettings& settings, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance);

}  // namespace limn
