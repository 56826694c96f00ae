#include "content/app/player/render_scale.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kInterval = 0.5f;        // [s] between changes
constexpr float kSlowThreshold = 1.10f;  // of the target; smaller excesses are not noticeable
constexpr float kHeadroom = 0.70f;       // of the target; the scale grows while work takes less
constexpr float kMaxGrowth = 1.15f;      // limits of one change
constexpr float kMaxShrink = 0.70f;

}  // namespace

RenderScale make_render_scale(float wanted, bool automatic, bool software_gl, const IVec2& window) {
    RenderScale scale{.automatic = automatic};
    const float software =
        static_cast<float>(kSoftwareHeight) / static_cast<float>(std::max(window.y, 1));
    if (wanted > 0.0f) {
        scale.scale = wanted;
    } else if (software_gl) {
        scale.scale = std::min(software, 1.0f);
        scale.automatic = true;
    }
    scale.target_ms = software_gl ? kSoftwareFrameMs : scale.target_ms;
    return scale;
}

IVec2 render_size(const RenderScale& scale, const IVec2& window) {
    const auto pixels = [&](int side) {
        const float scaled = static_cast<float>(side) * scale.scale;
        return std::max(2 * static_cast<int>(std::lround(0.5f * scaled)), 16);
    };
    return scale.scale == 1.0f ? glm::max(window, IVec2(1))
                               : IVec2(pixels(window.x), pixels(window.y));
}

bool update_render_scale(RenderScale& scale, float frame_ms, float busy_ms, float dt) {
    scale.patience += dt;
    if (!scale.automatic || scale.patience < kInterval || frame_ms <= 0.0f) {
        return false;
    }
    scale.patience = 0.0f;
    // The time of a frame grows with its pixels, the square of the scale.
    float factor = 1.0f;
    if (frame_ms > kSlowThreshold * scale.target_ms) {
        factor = std::max(std::sqrt(scale.target_ms / frame_ms), kMaxShrink);
    } else if (busy_ms < kHeadroom * scale.target_ms) {
        factor =
            std::min(std::sqrt(kHeadroom * scale.target_ms / std::max(busy_ms, 0.1f)), kMaxGrowth);
    }
    if (factor < 1 && scale.scale == kMinScale && scale.thins_particles) {
        const float previous = scale.particle_share;
        // Half, at least: strides are powers of two.
        scale.particle_share = std::clamp(
            previous * std::min(scale.target_ms / frame_ms, 0.5f), kMinParticleShare, 1.0f);
        return scale.particle_share != previous;
    }
    const float before = scale.scale;
    scale.scale = std::clamp(scale.scale * factor, kMinScale, kMaxAutoScale);
    return scale.scale != before;
}

}  // namespace limn
