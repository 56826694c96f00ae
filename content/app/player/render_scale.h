#pragma once

#include "ecs/base/math.h"

namespace limn {

// Render resolution for a window. A GPU gets the full resolution. Software OpenGL (llvmpipe) begins
// with 640 x 360 and adapts, so that every level can be steered. Automatic scaling adapts to recent
// frame times: to hold 60 frames per second on a GPU, 16 on a CPU. If a CPU is still too slow at
// the lowest resolution and the level has GPU particles, only a fraction of them is simulated and
// drawn, enlarged to compensate (Rendering::particle_share); that fraction only falls until another
// level is loaded.

struct RenderScale {
    float scale = 1.0f;            ///< rendered pixels per window pixel, along each side
    bool automatic = false;        ///< adapted by update_render_scale
    float patience = 0.0f;         ///< time since the last change [s]
    float target_ms = 16.67f;      ///< frame time to hold [ms]
    bool thins_particles = false;  ///< may lower particle_share: GPU particles on a CPU
    float particle_share = 1.0f;   ///< limit of Rendering::particle_share
};

inline constexpr int kSoftwareHeight = 360;       ///< render height with software OpenGL [px]
inline constexpr float kSoftwareFrameMs = 60.0f;  ///< target of automatic scaling there [ms]
inline constexpr float kMinScale = 0.2f;
inline constexpr float kMaxAutoScale = 1.0f;
inline constexpr float kMinParticleShare = 1.0f / 256;

/// `wanted`: the scale the user requested, 0 = choose by the device, which adapts on a CPU.
[[nodiscard]] RenderScale
make_render_scale(float wanted, bool automatic, bool software_gl, const IVec2& window);

/// Render resolution for a window of this size; even numbers, at least 16.
[[nodiscard]] IVec2 render_size(const RenderScale& scale, const IVec2& window);

/// `frame_ms`: median time of the last frames, including the wait for vsync; `busy_ms`: CPU or GPU
/// work without that wait. Changes the scale, or the fraction of particles, at most twice per
/// second; returns whether it did.
bool update_render_scale(RenderScale& scale, float frame_ms, float busy_ms, float dt);

}  // namespace limn
