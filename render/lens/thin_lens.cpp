#include "render/lens/thin_lens.h"

#include "ecs/base/text.h"
#include "ecs/components/camera.h"

#include <algorithm>
#include <cmath>

// Techniques: post.circle-of-confusion

namespace limn {
namespace {

Vec2 point_on_disc(const Vec2& square) {
    const Vec2 p = 2.0f * square - 1.0f;
    if (p.x == 0.0f && p.y == 0.0f) {
        return p;
    }
    const bool wide = std::abs(p.x) > std::abs(p.y);
    const float radius = wide ? p.x : p.y;
    const float angle = wide ? 0.25f * kPi * (p.y / p.x) : 0.5f * kPi - 0.25f * kPi * (p.x / p.y);
    return radius * Vec2(std::cos(angle), std::sin(angle));
}

Vec2 corner(const LensView& lens, int i) {
    const float angle =
        lens.blade_rotation + 2 * kPi * static_cast<float>(i) / static_cast<float>(lens.blades);
    return {std::cos(angle), std::sin(angle)};
}

}  // namespace

double focal_length(double fov_y, double sensor_height, double focus_distance) {
    const double film_distance = 0.5 * sensor_height / std::tan(0.5 * fov_y);
    return 1 / (1 / film_distance + 1 / focus_distance);
}

double
circle_of_confusion(double focal_length, double f_number, double focus_distance, double distance) {
    LIMN_CHECK(focus_distance > focal_length && focal_length > 0);

    const double widest = square(focal_length) / (f_number * (focus_distance - focal_length));
    return widest * std::abs(1 - focus_distance / distance);
}

Result<LensView> make_lens_view(const Lens& lens, const Camera& camera) {
    if (!(lens.f_number > 0)) {
        return fail("lens: f_number is {}, expected more than 0", lens.f_number);
    }
    if (!(lens.focus_distance > 0)) {
        return fail(
            "lens: focus_distance is {} m, expected more than 0 (in front of the camera)",
            lens.focus_distance);
    }
    if (!(lens.sensor_height > 0 && std::isfinite(lens.sensor_height))) {
        return fail("lens: sensor_height is {} m, expected more than 0", lens.sensor_height);
    }
    const double length = focal_length(
        static_cast<double>(camera.fov_y), static_cast<double>(lens.sensor_height),
        static_cast<double>(lens.focus_distance));
    LensView view;
    view.aperture_radius = static_cast<float>(0.5 * length / static_cast<double>(lens.f_number));
    view.focus_distance = lens.focus_distance;
    view.blades = lens.blades >= 3 ? lens.blades : 0;
    view.blade_rotation = std::isfinite(lens.blade_rotation) ? lens.blade_rotation : 0.0f;
    view.max_blur = lens.max_blur > 0 ? std::min(lens.max_blur, 0.25f) : 0.0f;
    view.method = lens.method;
    return view;
}

float circle_scale(const LensView& lens, float tangent_y, int height) {
    return lens.aperture_radius * static_cast<float>(height) / tangent_y;
}

Vec2 point_on_aperture(const LensView& lens, const Vec2& square) {
    if (lens.blades < 3) {
        return point_on_disc(square);
    }
    const float blades = static_cast<float>(lens.blades);
    const int i = std::clamp(static_cast<int>(square.x * blades), 0, lens.blades - 1);
    const float along = square.x * blades - static_cast<float>(i);
    const Vec2 a = corner(lens, i);
    const Vec2 b = corner(lens, i + 1);
    return std::sqrt(square.y) * (a + along * (b - a));
}

}  // namespace limn
