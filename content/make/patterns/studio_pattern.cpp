#include "content/make/patterns/studio_pattern.h"

#include "content/make/patterns/pattern_tools.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// In the order of rows and columns of an equirectangular image, with -z at its center.
Vec3 direction_at(const Vec2& uv) {
    const float longitude = (uv.x - 0.5f) * glm::two_pi<float>();
    const float latitude = (0.5f - uv.y) * glm::pi<float>();
    return {
        std::cos(latitude) * std::sin(longitude), std::sin(latitude),
        -std::cos(latitude) * std::cos(longitude)};
}

/// 1 on the panes of a window, 0 on the bars between them; `point` is -1 .. 1 across the window.
float pane_coverage(const StudioLight& light, const Vec2& point, float blur) {
    const Vec2 panes = glm::max(light.panes, IVec2(1));
    const Vec2 at = (0.5f + 0.5f * point) * panes;
    const Vec2 to_bar = 0.5f - glm::abs(at - glm::floor(at) - 0.5f);  // in panes
    Vec2 coverage =
        glm::smoothstep(Vec2(0.5f * light.bars), 0.5f * light.bars + blur * panes, to_bar);
    coverage = glm::mix(Vec2(1), coverage, glm::greaterThan(panes, Vec2(1)));
    return coverage.x * coverage.y;
}

/// Coverage of a direction by the light; `pixel`: extent of a pixel there [rad].
float light_coverage(const StudioLight& light, const Vec3& direction, float pixel) {
    const Vec3 center = light.toward / std::max(glm::length(light.toward), 1e-6f);
    const float ahead = glm::dot(direction, center);
    if (!(ahead > 1e-3f)) {
        return 0;
    }
    const Vec3 up = std::abs(center.y) > 0.95f ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
    const Vec3 right = glm::normalize(glm::cross(up, center));
    const Vec2 at =
        Vec2(glm::dot(direction, right), glm::dot(direction, glm::cross(center, right)));
    const Vec2 point = at / (0.5f * ahead * light.size);
    const Vec2 blur = 2.0f * pixel / light.size;
    const Vec2 border = glm::max(Vec2(light.edge), blur);
    const Vec2 inside = 1.0f - glm::smoothstep(1.0f - border, Vec2(1), glm::abs(point));
    return inside.x * inside.y * pane_coverage(light, point, 0.5f * std::max(blur.x, blur.y));
}

}  // namespace

PatternMaps make_studio(const StudioPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float pixel = glm::pi<float>() / static_cast<float>(pattern.image.size);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec3 direction = direction_at(uv);
        const float down = glm::smoothstep(0.05f, 0.7f, -direction.y);
        const float uneven = (1 + 0.4f * fbm(uv, 3, seed, 3)) * (1 - 0.7f * std::abs(direction.y));
        PatternTexel t;
        t.color = glm::mix(uneven * pattern.wall, pattern.floor, down);
        for (const StudioLight& light : pattern.lights) {
            t.color += light.color * light_coverage(light, direction, pixel);
        }
        t.color = glm::min(t.color, Vec3(1));
        return t;
    });
}

}  // namespace limn
