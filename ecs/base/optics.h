#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

// Reflection and refraction at the boundary of two clear media. The same functions are in
// render/shaders/lib/optics.glsl. `to_light` points from the surface toward the light; `eta` is the
// refractive index on that side over the index on the far side (air to water: 1 / 1.33); `index`
// is the inverse ratio (1.33).
// Techniques: water.fresnel, water.fresnel-approx, water.snell-vectors

/// Direction of the reflected ray, R = 2 (N.L) N - L.
[[nodiscard]] inline Vec3 reflect_ray(const Vec3& normal, const Vec3& to_light) {
    return 2.0f * glm::dot(normal, to_light) * normal - to_light;
}

/// Direction of the refracted ray (Snell), or 0 on total internal reflection. The unit normal may
/// point to either side.
[[nodiscard]] inline Vec3 refract_ray(const Vec3& normal, const Vec3& to_light, float eta) {
    const float cosine = glm::dot(normal, to_light);
    const Vec3 facing = cosine < 0 ? -normal : normal;
    const float cos_in = std::abs(cosine);
    const float radicand = 1.0f - eta * eta + eta * eta * cos_in * cos_in;
    return radicand < 0 ? Vec3(0) : (eta * cos_in - std::sqrt(radicand)) * facing - eta * to_light;
}

/// Fresnel reflectance 0 .. 1 for unpolarized light; `cos_in` = |N.L|. Exact for clear media.
[[nodiscard]] inline float fresnel(float cos_in, float index) {
    const float c = std::clamp(cos_in, 0.0f, 1.0f);
    const float inverse2 = 1.0f / (index * index);
    const float radicand = 1.0f - inverse2 + inverse2 * c * c;
    if (radicand < 0) {
        return 1.0f;
    }
    constexpr float kTiny = 1e-20f;  // avoids 0 / 0 at grazing incidence with index 1
    const float cos_out = std::sqrt(radicand);
    const float s = (c - index * cos_out) / std::max(c + index * cos_out, kTiny);
    const float p = (index * c - cos_out) / std::max(index * c + cos_out, kTiny);
    return 0.5f * (s * s + p * p);
}

/// Schlick's approximation (1994), within 0.06 of fresnel() from air into water.
[[nodiscard]] inline float fresnel_schlick(float cos_in, float index) {
    const float f0 = square((index - 1.0f) / (index + 1.0f));
    const float m = 1.0f - std::clamp(cos_in, 0.0f, 1.0f);
    return f0 + (1.0f - f0) * (m * m) * (m * m) * m;
}

/// For air into water only: constant up to 45 degrees, then a parabola in the angle up to 1 (T'so
/// and Barsky 1987). Too bright by up to 0.27.
[[nodiscard]] inline float fresnel_tso_barsky(float cos_in) {
    const float angle = std::acos(std::clamp(cos_in, 0.0f, 1.0f));
    const float u = std::max(0.0f, angle * (4.0f / kPi) - 1.0f);  // 392 / (25 pi^2) (pi/4)^2 = 0.98
    return 0.02f + 0.98f * u * u;
}

}  // namespace limn
