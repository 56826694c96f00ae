#include "content/make/patterns/fold_pattern.h"

#include "content/bake/wrinkle_map.h"
#include "content/make/patterns/noise.h"
#include "content/make/patterns/pattern_tools.h"
#include "ecs/base/log.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

// Techniques: wrinkle.compression.map

namespace limn {

PatternMaps make_folds(const FoldsPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const auto count = static_cast<float>(pattern.count);
    PatternMaps maps = make_wrinkle_maps(pattern.image.size, [&](const Vec2& uv) {
        const float bend = fbm(uv, 3, seed) + 0.35f * fbm(uv, 9, seed + 1);
        const float fold = uv.y * count + pattern.wander * 2 * bend;
        const float wave = 0.5f - 0.5f * std::cos(2 * kPi * fold);         // 0 in the valley
        const float crest = std::sqrt(wave + 0.004f) - std::sqrt(0.004f);  // round above a crease
        const float profile = glm::mix(wave, crest, pattern.sharpness);
        // The strength varies along a fold.
        const float strength = glm::smoothstep(-0.45f, 0.25f, fbm(uv, pattern.count, seed + 2, 2));
        const float height = 1 - glm::mix(1.0f, strength, pattern.breaks) * (1 - profile);
        PatternTexel t;
        t.color = pattern.color * (1 + 0.06f * fbm(uv, 40, seed + 3));
        t.height = pattern.depth / count * height;
        t.roughness = 0.5f;
        t.occlusion = 0.75f + 0.25f * height;
        return t;
    });
    const int beyond = limit_wrinkle_map(maps.normal, pattern.steepest);
    if (beyond > 0) {
        log_info("folds: {} normals were steeper than x^2 + y^2 = {}", beyond, pattern.steepest);
    }
    return maps;
}

}  // namespace limn
