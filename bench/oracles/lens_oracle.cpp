#include "bench/oracles/lens_oracle.h"

#include <cmath>

namespace limn::oracle {
namespace {

/// A ray in the plane of the axis: height and slope.
struct Ray {
    double height;
    double slope;
};

/// A ray after `distance` along the axis.
Ray travel(const Ray& ray, double distance) {
    return {ray.height + ray.slope * distance, ray.slope};
}

/// Refraction: a thin lens changes a ray's slope in proportion to its height.
Ray refract(const Ray& ray, double focal_length) {
    return {ray.height, ray.slope - ray.height / focal_length};
}

}  // namespace

double image_diameter(const ThinLens& lens, double distance) {
    // The film is where the rays from the point in focus converge.
    const double rim = lens.aperture / 2;
    const Ray sharp = refract({rim, rim / lens.focus}, lens.focal_length);
    const double film = -sharp.height / sharp.slope;
    const Ray upper = travel(refract({rim, rim / distance}, lens.focal_length), film);
    const Ray lower = travel(refract({-rim, -rim / distance}, lens.focal_length), film);
    return std::abs(upper.height - lower.height);
}

ThinLens lens_of_camera(double fov_y, double film_height, double f_number, double focus) {
    const double film = film_height / 2 / std::tan(fov_y / 2);
    // Rays from the point in focus that pass the lens 1 m off the axis must meet on the film.
    const double turn = 1 / focus + 1 / film;
    const double focal_length = 1 / turn;
    return {focal_length, focal_length / f_number, focus};
}

LensPoint lens_point(int index, int count) {
    const double radius = std::sqrt((index + 0.5) / count);
    const double angle = index * 2.399963229728653;  // the golden angle
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace limn::oracle
