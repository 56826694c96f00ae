#include "content/bake/photometric_normals.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <cstddef>

// Techniques: face.photometric-normals

namespace limn {

namespace {

/// Determinant of unit lights below which their directions are coplanar, within about a degree.
constexpr double kMinDeterminant = 1e-3;

}  // namespace

Status check_photometric_lights(std::span<const Vec3> to_light) {
    if (to_light.size() < 3) {
        return fail("found {} lights, expected at least 3", to_light.size());
    }
    glm::dmat3 sum(0);
    for (std::size_t i = 0; i < to_light.size(); ++i) {
        const float length = glm::length(to_light[i]);
        if (!(length > 1e-6f && length < 1e6f)) {
            return fail(
                "light {}: found ({}, {}, {}), expected a direction", i + 1, to_light[i].x,
                to_light[i].y, to_light[i].z);
        }
        const glm::dvec3 unit = glm::normalize(glm::dvec3(to_light[i]));
        sum += glm::outerProduct(unit, unit);
    }
    if (glm::determinant(sum) < kMinDeterminant) {
        return fail("found lights that all lie in one plane, expected three directions");
    }
    return Done{};
}

PhotometricPixel
solve_photometric(std::span<const Vec3> to_light, std::span<const float> radiance, float shadow) {
    LIMN_CHECK(to_light.size() == radiance.size());
    glm::dmat3 sum(0);
    glm::dvec3 right(0);
    int lit = 0;
    for (std::size_t i = 0; i < to_light.size(); ++i) {
        if (radiance[i] > shadow && std::isfinite(radiance[i])) {
            const glm::dvec3 light = to_light[i];
            sum += glm::outerProduct(light, light);
            right += light * double{radiance[i]};
            ++lit;
        }
    }
    if (lit < 3 || glm::determinant(sum) < kMinDeterminant) {
        return {};
    }
    const glm::dvec3 g = glm::inverse(sum) * right;
    const double reflectance = glm::length(g);
    if (!(reflectance > 0)) {
        return {};
    }
    return {Vec3(g / reflectance), static_cast<float>(reflectance)};
}

}  // namespace limn
