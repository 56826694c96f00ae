#pragma once

#include "render/render_view.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace limn::oracle {

// The shift of each pixel's lookup by ripples, analytically in double precision: the reference for
// the renderer's shift field.

/// A camera by its axes, which are unit and perpendicular.
struct RippleCamera {
    glm::dvec3 eye{0};
    glm::dvec3 right{1, 0, 0};
    glm::dvec3 up{0, 1, 0};
    glm::dvec3 forward{0, 0, -1};
    glm::dvec2 tangent{1};  ///< of half the field of view
    glm::dvec2 size{1};     ///< [px]
    double near = 0.05;     ///< [m]
};

[[nodiscard]] RippleCamera ripple_camera(const RenderView& view);

/// Unit direction from the eye through a point of the image [px from the bottom left].
[[nodiscard]] glm::dvec3 ray_through(const RippleCamera& camera, const glm::dvec2& pixel);
/// The inverse, for directions that point forward.
[[nodiscard]] glm::dvec2 pixel_of(const RippleCamera& camera, const glm::dvec3& direction);

/// A shell of radius r and half-thickness l about `center`: a ray that passes the center at
/// distance b is deflected away from it by a sin(2 pi s) (1 - s^2)^2, s = (b - r) / l; times 1 - d
/// / z, where the visible surface is at distance z along the view axis and the center at d.
struct RingWave {
    glm::dvec3 center{0};
    double radius = 0;
    double wavelength = 1;
    double amplitude = 0;  ///< a [rad]
};
[[nodiscard]] glm::dvec2 ring_shift(
    const RippleCamera& camera, const RingWave& wave, const glm::dvec2& pixel, double distance);

/// Hot air in the box (or ball) of half-extent 1 in local space.
struct HotAir {
    glm::dmat4 local_from_world{1};
    bool ball = false;
    double shift = 0;   ///< largest shift [px]
    double scale = 1;   ///< [m]
    double raised = 0;  ///< by rising so far [eddies]
    std::uint32_t seed = 0;
};
[[nodiscard]] glm::dvec2
haze_shift(const RippleCamera& camera, const HotAir& air, const glm::dvec2& pixel, double distance);

/// post.scene-ripple: the wave w at a distance from the center, in fractions of the image; and the
/// shift of the lookup at uv.
[[nodiscard]] double screen_wave(double distance, double radius, double amplitude);
[[nodiscard]] glm::dvec2
screen_shift(const glm::dvec2& uv, const glm::dvec2& center, double radius, double amplitude);

}  // namespace limn::oracle
