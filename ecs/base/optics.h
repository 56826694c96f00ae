#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

// Light where two clear media meet: which ways it goes on and how it is shared. The same functions
// are in render/shaders/lib/optics.glsl. `to_light` points away from the surface, back to where the
// light comes from, `eta` is the refractive index on that side over the one beyond (air to water 1
// / 1.33), and `index` is the inverse, the one beyond over the one on this side (1.33).

/// Where light leaves that is mirrored, R = 2 (N.L) N - L.
[[nodiscard]] inline Vec3 reflect_ray(const Vec3& normal, const Vec3& to_light) {
    return 2.0f * glm::dot(normal, to_light) * normal - to_light;
}

/// Where light leaves that goes through (Snell), or 0 where all of it is mirrored. A unit normal
/// may point to either side.
[[nodiscard]] inline Vec3 refract_ray(const Vec3& normal, const Vec3& to_light, float eta) {
    const float cosine = glm::dot(normal, to_light);
    const Vec3 facing = cosine < 0 ? -normal : normal;
    const float cos_in = std::abs(cosine);
    const float radicand = 1.0f - eta * eta + eta * eta * cos_in * cos_in;
    return radicand < 0 ? Vec3(0) : (eta * cos_in - std::sqrt(radicand)) * facing - eta * to_light;
}

/// Share 0 .. 1 of unpolarized light that is mirrored; `cos_in` = |N.L|. Exact for clear media
/// (Fresnel).
[[nodiscard]] inline float fresnel(float cos_in, float index) {
    const float c = std::clamp(cos_in, 0.0f, 1.0f);
    const float inverse2 = 1.0f / (index * index);
    const float radicand = 1.0f - inverse2 + inverse2 * c * c;
    if (radicand < 0) {
        return 1.0f;
    }
    constexpr float kTiny = 1e-20f;  // light that grazes what is no boundary: index 1
    const float beyond = std::sqrt(radicand);
    const float s = (c - index * beyond) / std::max(c + index * beyond, kTiny);
    const float p = (index * c - beyond) / std::max(index * c + beyond, kTiny);
    return 0.5f * (s * s + p * p);
}

/// Within 0.06 of fresnel() from air into water (Schlick 1994).
[[nodiscard]] inline float fresnel_schlick(float cos_in, float index) {
    const float head_on = square((index - 1.0f) / (index + 1.0f));
    const float m = 1.0f - std::clamp(cos_in, 0.0f, 1.0f);
    return head_on + (1.0f - head_on) * (m * m) * (m * m) * m;
}

/// Into water alone, by the angle: even up to 45 degrees, then a parabola up to 1 (T'so and Barsky
/// 1987). Too bright by as much as 0.27.
[[nodiscard]] inline float fresnel_tso_barsky(float cos_in) {
    const float angle = std::acos(std::clamp(cos_in, 0.0f, 1.0f));
    const float u = std::max(0.0f, angle * (4.0f / kPi) - 1.0f);  // 392 / (25 pi^2) (pi/4)^2 = 0.98
    return 0.02f + 0.98f * u * u;
}

}  // namespace limn
