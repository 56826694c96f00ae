#include "content/make/patterns/glow_pattern.h"

#include "content/make/patterns/flipbook.h"
#include "content/make/patterns/pattern_tools.h"

namespace limn {

PatternMaps make_glow(const GlowPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float core = std::max(pattern.core, 0.01f);
    return make_shaded_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const float away = glm::length(at.p);
        // Half intensity at the core, inverse-square falloff, and a smooth end.
        const float spread = 1.0f / (1.0f + square(away / core));
        const float end = square(std::max(1.0f - square(away), 0.0f));
        // Noise around the center, sampled on a circle to avoid a seam. Rays end at different
        // distances.
        const Vec2 around = at.p / std::max(away, 1e-3f);
        const Vec2 other = {23.0f * static_cast<float>(frame_number(at, pattern.frames)), 5.0f};
        const float noise_around = fbm(7.0f * around + other, seed, {0, 0}, 3);
        const float ray = 6.0f * square(glm::smoothstep(-0.15f + 0.35f * away, 0.6f, noise_around));
        const float ray_weight = pattern.rays * glm::smoothstep(0.0f, 2.0f * core, away);
        const float root =
            std::sqrt(spread * end * glm::mix(1.0f, std::min(ray, 4.0f), ray_weight));
        PatternTexel t;
        t.color = Vec3(std::min(root, 1.0f));
        t.opacity = root;
        return t;
    });
}

}  // namespace limn
