#include "content/make/city_patterns.h"

#include "content/make/pattern_tools.h"

#include <algorithm>
#include <cmath>

namespace limn {

PatternMaps make_windows(const WindowsPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const Vec2 cells = {pattern.columns, pattern.rows};
    const float soft = 0.7f * std::max(cells.x, cells.y) / static_cast<float>(pattern.image.size);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 place = uv * cells;
        const Vec2 cell = glm::min(glm::floor(place), cells - 1.0f);
        const int column = static_cast<int>(cell.x);
        const int row = static_cast<int>(cell.y);
        // Whole stretches of a storey are dark or at work; within them windows decide one by one.
        const float stretch = lattice_random(column / 4, row, seed);
        const float own = lattice_random(column, row, seed + 1);
        const bool is_lit =
            0.5f * (stretch + own) < 0.5f * (pattern.lit + pattern.lit * pattern.lit)
            || own < 0.3f * pattern.lit;
        const Vec2 from_middle = glm::abs(place - cell - 0.5f);
        const Vec2 half = 0.5f - 0.5f * pattern.frame * Vec2(1.0f, 1.4f);
        const Vec2 inside = 1.0f - glm::smoothstep(half - soft, half + soft, from_middle);
        const float glass = inside.x * inside.y;
        const float bright = 1.0f - pattern.variation * lattice_random(column, row, seed + 2);
        // Lamps hang at the ceiling, blinds cover some of it.
        const float height = 1.0f - (place.y - cell.y);
        const float blind = 0.9f * lattice_random(column, row, seed + 3) - 0.3f;
        const float light = height > 1.0f - blind ? 0.35f : 0.55f + 0.45f * height;
        const bool accent = lattice_random(column / 4, row, seed + 4) < 0.25f;
        PatternTexel t;
        t.color =
            is_lit ? (accent ? pattern.accent : pattern.color) * (glass * bright * light) : Vec3(0);
        t.height = -0.004f * glass;
        t.roughness = glm::mix(0.7f, 0.12f, glass);
        return t;
    });
}

PatternMaps make_asphalt(const AsphaltPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float low = fbm(uv, 3, seed, 5, 0.55f);  // about -0.5 .. 0.5
        const float grain = fbm(uv, 96, seed + 7, 2, 0.6f);
        const float stains = fbm(uv, 8, seed + 13);
        const float level = 0.9f * (pattern.wet - 0.5f);
        const float puddle = glm::smoothstep(-0.06f, 0.10f, level - low);
        PatternTexel t;
        t.color = pattern.color * (1.0f + 0.5f * grain + 0.35f * stains) * (1.0f - 0.45f * puddle);
        t.height = 0.0016f * grain * (1.0f - puddle);
        t.roughness = glm::mix(
            std::clamp(pattern.roughness + 0.2f * grain + 0.15f * stains, 0.2f, 1.0f), 0.06f,
            puddle);
        t.occlusion = 1.0f;
        return t;
    });
}

}  // namespace limn
