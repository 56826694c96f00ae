// Colors that are polynomials over a triangle, through illuminated samples (fakephong.gouraud,
// .gouraud-subdivided, .quadratic, .cubic, .hw-quadratic).

#include "bench/fakephong/shading_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// Techniques: fakephong.cubic, fakephong.gouraud, fakephong.gouraud-subdivided,
//     fakephong.hw-quadratic, fakephong.quadratic

namespace limn::fakephong {
namespace {

std::array<Lit, 6>
illuminate_six(const PhongScene& scene, const std::array<SurfacePoint, 6>& points) {
    std::array<Lit, 6> lit;
    for (std::size_t i = 0; i < 6; ++i) {
        lit[i] = illuminate(scene, points[i]);
    }
    return lit;
}

/// Stores what the pixels of the facet evaluate.
template <std::size_t n>
void keep(FacetSetup& setup, const std::array<Lit, n>& lit) {
    std::copy(lit.begin(), lit.end(), setup.lit.begin());
}

Lit evaluate_quadratic_color(const FacetSetup& setup, Real s, Real t) {
    const auto& c = setup.lit;
    return c[0] + s * c[1] + t * c[2] + (s * s) * c[3] + (s * t) * c[4] + (t * t) * c[5];
}

}  // namespace

// ---- Gouraud: three corners

void prepare_gouraud(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    const auto lit = [&](std::size_t i) { return illuminate(*context.scene, facet.corners[i]); };
    keep(setup, linear_through(lit(0), lit(1), lit(2)));
}

Lit shade_gouraud(const ShadingContext& /*context*/, const FacetSetup& setup, Real s, Real t) {
    return evaluate_linear(setup.lit, s, t);
}

// ---- subdivided: corners and midpoints, linear in each quarter

void prepare_subdivided(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    keep(setup, illuminate_six(*context.scene, six_points(facet)));
}

Lit shade_subdivided(const ShadingContext& /*context*/, const FacetSetup& setup, Real s, Real t) {
    const auto& r = setup.lit;
    const auto quarter = [](const Lit& a, const Lit& b, const Lit& c, Real u, Real v) {
        return a + u * (b - a) + v * (c - a);
    };
    const Real u = 2.0 * s;
    const Real v = 2.0 * t;
    if (u > 1.0) {
        return quarter(r[1], r[2], r[3], u - 1.0, v);
    }
    if (v > 1.0) {
        return quarter(r[5], r[3], r[4], u, v - 1.0);
    }
    if (u + v > 1.0) {
        return quarter(r[3], r[5], r[1], 1.0 - u, 1.0 - v);
    }
    return quarter(r[0], r[1], r[5], u, v);
}

// ---- quadratic: corners and midpoints

void prepare_quadratic(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    keep(setup, quadratic_through(illuminate_six(*context.scene, six_points(facet))));
}

Lit shade_quadratic(const ShadingContext& /*context*/, const FacetSetup& setup, Real s, Real t) {
    return evaluate_quadratic_color(setup, s, t);
}

// ---- cubic: corners, two points on each edge, the centroid; Lagrange's form

void prepare_cubic(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    constexpr double kNodes[10][2] = {{0, 0}, {3, 0}, {0, 3}, {1, 0}, {2, 0},
                                      {2, 1}, {1, 2}, {0, 2}, {0, 1}, {1, 1}};
    for (std::size_t i = 0; i < 10; ++i) {
        const auto& [s, t] = kNodes[i];
        setup.lit[i] = illuminate(*context.scene, point_at(facet, s / 3, t / 3));
    }
}

Lit shade_cubic(const ShadingContext& /*context*/, const FacetSetup& setup, Real b, Real c) {
    const Real a = 1.0 - b - c;
    const Real a1 = 3.0 * a - 1.0;
    const Real b1 = 3.0 * b - 1.0;
    const Real c1 = 3.0 * c - 1.0;
    const Real ab = 4.5 * a * b;
    const Real bc = 4.5 * b * c;
    const Real ca = 4.5 * c * a;
    const auto& r = setup.lit;
    return (0.5 * a * a1 * (a1 - 1.0)) * r[0] + (0.5 * b * b1 * (b1 - 1.0)) * r[1]
           + (0.5 * c * c1 * (c1 - 1.0)) * r[2] + (ab * a1) * r[3] + (ab * b1) * r[4]
           + (bc * b1) * r[5] + (bc * c1) * r[6] + (ca * c1) * r[7] + (ca * a1) * r[8]
           + (27.0 * a * b * c) * r[9];
}

// ---- appendix A: quadratic in vertex and pixel programs, with their limits. Midpoint normals are
// normalized before the world matrix, which is the identity here; like `lit`, there are no
// highlights behind the surface; s and t are passed in a color register of 8 bits; one light.

void prepare_hardware_quadratic(
    const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    const PhongScene& scene = *context.scene;
    std::array<Lit, 6> lit;
    const auto points = six_points(facet);
    for (std::size_t i = 0; i < 6; ++i) {
        const PhongLight& light = scene.lights[0];
        lit[i] = illuminate(scene, light, points[i]);
        if (!(dot(points[i].normal, to_light(light, points[i].position)) > 0.0)) {
            lit[i].highlight = {0, 0, 0};
        }
        if (scene.channels != Channels::Specular) {
            lit[i].tinted = lit[i].tinted + Vec3r(dvec3(scene.material.ambient));
        }
    }
    keep(setup, quadratic_through(lit));
}

Lit shade_hardware_quadratic(
    const ShadingContext& /*context*/, const FacetSetup& setup, Real s, Real t) {
    const auto in_register = [](Real x) { return Real(std::round(clamp01(x).value * 255) / 255); };
    return evaluate_quadratic_color(setup, in_register(s), in_register(t));
}

}  // namespace limn::fakephong
