#include "bench/fakephong/shading_method.h"
#include "bench/fakephong/taylor_series.h"

// Techniques: fakephong.taylor

namespace limn::fakephong {
namespace {

/// Value of the series at (`x`, `y`) from the centroid.
Real evaluate_series(const std::array<Real, 6>& f, Real x, Real y) {
    return f[0] + f[1] * x + f[2] * y + 0.5 * (f[3] * (x * x) + f[5] * (y * y)) + f[4] * (x * y);
}

}  // namespace

std::array<Real, 6> taylor_series(const Vec3r& l, const Vec3r& a, const Vec3r& b, const Vec3r& c) {
    const Real dot_c = dot(l, c);
    const Real dot_x = dot(l, a);
    const Real dot_y = dot(l, b);
    const Real q = dot(c, c);
    if (!(q > 1e-24)) {
        return {};
    }
    const Real q_x = 2.0 * dot(a, c);
    const Real q_y = 2.0 * dot(b, c);
    const Real q_xx = 2.0 * dot(a, a);
    const Real q_xy = 2.0 * dot(a, b);
    const Real q_yy = 2.0 * dot(b, b);
    const Real q1 = 1.0 / root(q);  // q^(-1/2)
    const Real q3 = q1 / q;         // q^(-3/2)
    const Real q5 = q3 / q;         // q^(-5/2)
    return {
        dot_c * q1,
        dot_x * q1 - 0.5 * dot_c * q_x * q3,
        dot_y * q1 - 0.5 * dot_c * q_y * q3,
        0.75 * dot_c * q_x * q_x * q5 - dot_x * q_x * q3 - 0.5 * dot_c * q_xx * q3,
        0.75 * dot_c * q_x * q_y * q5 - 0.5 * (dot_x * q_y + dot_y * q_x) * q3
            - 0.5 * dot_c * q_xy * q3,
        0.75 * dot_c * q_y * q_y * q5 - dot_y * q_y * q3 - 0.5 * dot_c * q_yy * q3};
}

// The series is in s and t instead of screen x and y: without perspective they are affine functions
// of each other, so that it is the same polynomial; with perspective it remains a function on the
// triangle. Lights and eye count as infinitely far: L and H are evaluated at the centroid.

void prepare_taylor(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    const auto& [p0, p1, p2] = facet.corners;
    const Vec3r a = p1.normal - p0.normal;
    const Vec3r b = p2.normal - p0.normal;
    const Vec3r c = (1.0 / 3.0) * (p0.normal + p1.normal + p2.normal);
    const Vec3r centroid = (1.0 / 3.0) * (p0.position + p1.position + p2.position);
    const PhongScene& scene = *context.scene;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Vec3r l = to_light(scene.lights[i], centroid);
        setup.diffuse_series[i] = taylor_series(l, a, b, c);
        setup.specular_series[i] = taylor_series(half_vector(l, to_eye(scene, centroid)), a, b, c);
    }
}

Lit shade_taylor(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    const PhongScene& scene = *context.scene;
    const PhongMaterial& material = scene.material;
    const Real x = s - 1.0 / 3.0;
    const Real y = t - 1.0 / 3.0;
    Lit sum;
    if (scene.channels != Channels::Specular) {
        sum.tinted = Vec3r(dvec3(material.ambient));
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Vec3r color = Vec3r(scene.lights[i].color);
        if (scene.channels != Channels::Specular) {
            const Real n_l = clamp01(evaluate_series(setup.diffuse_series[i], x, y));
            sum.tinted = sum.tinted + (material.diffuse * n_l) * color;
        }
        if (scene.channels != Channels::Diffuse) {
            const Real n_h = clamp01(evaluate_series(setup.specular_series[i], x, y));
            sum.highlight = sum.highlight
                            + (material.specular * blinn_highlight(n_h, material.exponent)) * color;
        }
    }
    return sum;
}

}  // namespace limn::fakephong
