#include "content/make/patterns/hair_pattern.h"

#include "content/make/patterns/pattern_maps.h"
#include "content/make/patterns/pattern_tools.h"
#include "ecs/base/rng.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {

namespace {

struct PatternStrand {
    float u;       ///< at the root
    float bend;    ///< sideways offset of the tip, in units of the image
    float sway;    ///< amplitude of waves
    float phase;   ///< of the waves [rad]
    float length;  ///< along v
    float shade;   ///< factor of the color
    float slope;   ///< toward the viewer, largest rise per length: moves highlights
    float layer;   ///< 0: bottom, 1: top
};

std::vector<PatternStrand> strands_of(const HairPattern& pattern) {
    Random random(seed_of(pattern.image), 0, name_hash("hair_pattern"), 0);
    const auto signed_value = [&] { return 2 * random.uniform() - 1; };
    const float distance = 1 / static_cast<float>(pattern.count);
    std::vector<PatternStrand> strands;
    for (int i = 0; i < pattern.count; ++i) {
        PatternStrand strand;
        strand.u = (static_cast<float>(i) + random.uniform()) * distance;
        strand.bend = 1.5f * pattern.wander * distance * signed_value();
        strand.sway = 0.5f * pattern.wander * distance * signed_value();
        strand.phase = 2 * kPi * random.uniform();
        strand.length = glm::mix(pattern.shortest, 1.0f, std::sqrt(random.uniform()));
        strand.shade = 1 + pattern.variation * signed_value();
        strand.slope = 0.22f * signed_value();
        strand.layer = random.uniform();
        strands.push_back(strand);
    }
    return strands;
}

}  // namespace

PatternMaps make_hair(const HairPattern& pattern) {
    const std::vector<PatternStrand> strands = strands_of(pattern);
    constexpr float kRoots = 0.02f;  // so that the image repeats
    constexpr float kWaves = 3.0f;
    const float half = 0.5f * pattern.width / static_cast<float>(pattern.count);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        PatternTexel t;
        t.color = Vec3(0.5f);
        t.opacity = 0;
        t.roughness = 1;
        float top = -1;
        for (const PatternStrand& strand : strands) {
            const float v = uv.y / strand.length;
            if (v > 1 || uv.y < kRoots) {
                continue;
            }
            const float center =
                strand.u + strand.bend * v * v + strand.sway * std::sin(5 * v + strand.phase);
            const float x = std::remainder(uv.x - center, 1.0f) / (half * std::sqrt(1 - 0.9f * v));
            if (std::abs(x) < 1 && strand.layer > top) {
                top = strand.layer;
                t.opacity = 1;
                t.color = Vec3(0.7f * strand.shade * (0.55f + 0.45f * strand.layer));
                // Up and down in waves: without steps, which would shine as bars across.
                const float wave = 2 * kPi * kWaves;
                t.height = half * (0.35f * std::sqrt(1 - x * x) + strand.layer)
                           + strand.slope / wave * std::sin(wave * uv.y + strand.phase);
            }
        }
        return t;
    });
}

}  // namespace limn
