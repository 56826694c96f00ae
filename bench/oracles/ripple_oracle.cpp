#include "bench/oracles/ripple_oracle.h"

#include "ecs/base/gradient_noise.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: post.scene-ripple

namespace limn::oracle {
namespace {

constexpr double kTurn = 6.283185307179586;

/// Vector from the eye to the visible point at `distance` along the view axis.
double along_ray(const RippleCamera& camera, const glm::dvec3& ray, double distance) {
    return distance / glm::dot(ray, camera.forward);
}

}  // namespace

RippleCamera ripple_camera(const RenderView& view) {
    const auto column = [&](int c) {
        const auto& row = view.world_from_camera.row;
        return glm::dvec3(row[0][c], row[1][c], row[2][c]);
    };
    return {
        .eye = column(3),
        .right = column(0),
        .up = column(1),
        .forward = -column(2),
        .tangent = glm::dvec2(view.tangent),
        .size = glm::dvec2(view.width, view.height),
        .near = view.near};
}

glm::dvec3 ray_through(const RippleCamera& camera, const glm::dvec2& pixel) {
    const glm::dvec2 slope = (2.0 * pixel / camera.size - 1.0) * camera.tangent;
    return glm::normalize(camera.forward + slope.x * camera.right + slope.y * camera.up);
}

glm::dvec2 pixel_of(const RippleCamera& camera, const glm::dvec3& direction) {
    const double depth = glm::dot(direction, camera.forward);
    const glm::dvec2 slope = {
        glm::dot(direction, camera.right) / depth, glm::dot(direction, camera.up) / depth};
    return 0.5 * (slope / camera.tangent + 1.0) * camera.size;
}

glm::dvec2 ring_shift(
    const RippleCamera& camera, const RingWave& wave, const glm::dvec2& pixel, double distance) {
    const glm::dvec3 ray = ray_through(camera, pixel);
    const glm::dvec3 center = wave.center - camera.eye;
    const double missed = glm::length(glm::cross(center, ray));
    const double s = (missed - wave.radius) / wave.wavelength;
    const double center_distance = std::max(glm::dot(center, camera.forward), camera.near);
    const double behind = std::max(1 - center_distance / distance, 0.0);
    if (std::abs(s) >= 1 || glm::dot(center, ray) <= 0 || missed == 0 || behind == 0) {
        return {0, 0};
    }
    const double turn = wave.amplitude * std::sin(kTurn * s) * (1 - s * s) * (1 - s * s) * behind;
    // In the plane of ray and center, perpendicular to the ray, away from the center.
    const glm::dvec3 away = glm::normalize(ray * glm::dot(center, ray) - center);
    return pixel_of(camera, std::cos(turn) * ray + std::sin(turn) * away) - pixel;
}

glm::dvec2 haze_shift(
    const RippleCamera& camera, const HotAir& air, const glm::dvec2& pixel, double distance) {
    const glm::dvec3 ray = ray_through(camera, pixel);
    const auto local_at = [&](double t) {
        return glm::dvec3(air.local_from_world * glm::dvec4(camera.eye + t * ray, 1));
    };
    // The entry and exit, by the definition: the outermost inside points of many along the ray,
    // refined.
    const auto inside = [&](double t) {
        const glm::dvec3 p = local_at(t);
        return air.ball ? glm::dot(p, p) < 1
                        : std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1;
    };
    const double closest = along_ray(camera, ray, camera.near);
    const glm::dvec3 from = local_at(0);
    const glm::dvec3 step = local_at(1) - from;
    const double half_range = 2 * std::sqrt(3.0) / glm::length(step);  // half of the longest chord
    const double nearest = -glm::dot(from, step) / glm::dot(step, step);
    double enter = -1;
    double leave = -1;
    constexpr int kSteps = 4000;
    for (int i = 0; i <= kSteps; ++i) {
        const double t = nearest + half_range * (2.0 * i / kSteps - 1);
        if (t >= closest && inside(t)) {
            enter = enter < 0 ? t : enter;
            leave = t;
        }
    }
    const double surface = along_ray(camera, ray, distance);
    if (enter < 0 || leave <= enter || surface <= enter) {
        return {0, 0};
    }
    const double end = std::min(leave, surface);
    const double center_t = 0.5 * (enter + end);
    const glm::dvec3 local = local_at(center_t);
    const glm::dvec3 open = 1.0 - local * local;
    const double fade = air.ball ? 1 - glm::dot(local, local) : open.x * open.y * open.z;
    const glm::dvec3 noise_position =
        (camera.eye + center_t * ray) / air.scale - glm::dvec3(0, air.raised, 0);
    const glm::dvec2 eddy = {
        gradient_noise(Vec3(noise_position), air.seed),
        gradient_noise(Vec3(noise_position), air.seed + 0x9e37u)};
    return std::sqrt(0.5) * air.shift * (end - enter) / (leave - enter) * std::max(fade, 0.0)
           * eddy;
}

double screen_wave(double distance, double radius, double amplitude) {
    const double w0 = std::max(0.0, 1 - distance / radius);
    return w0 * amplitude * std::cos(w0 * 7.853981634);
}

glm::dvec2
screen_shift(const glm::dvec2& uv, const glm::dvec2& center, double radius, double amplitude) {
    const double distance = glm::length(uv - center);
    if (distance == 0) {
        return {0, 0};
    }
    return (uv - center) / distance * screen_wave(distance, radius, amplitude);
}

}  // namespace limn::oracle
