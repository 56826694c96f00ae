// Phong shading, the reference for all comparisons, and other interpolations of normals
// (fakephong.phong, fakephong.normal-interp-variants): illumination at every pixel.

#include "bench/fakephong/shading_method.h"

// Techniques: fakephong.normal-interp-variants, fakephong.phong

namespace limn::fakephong {
namespace {

/// From unit `a` to unit `b` along the great circle; `otherwise` if they are opposite.
Vec3r slerp(const Vec3r& a, const Vec3r& b, Real t, const Vec3r& otherwise) {
    const Real cosine = dot(a, b);
    if (cosine > 1.0 - 1e-9) {
        return normalize_or(a + t * (b - a), otherwise);
    }
    if (cosine < -1.0 + 1e-9) {
        return otherwise;
    }
    const Real angle = arc_cosine(cosine);
    const Real scale = 1.0 / sine(angle);
    return (scale * sine((1.0 - t) * angle)) * a + (scale * sine(t * angle)) * b;
}

}  // namespace

void prepare_phong(const ShadingContext& /*context*/, const Facet& facet, FacetSetup& setup) {
    setup.facet = facet;
}

Lit shade_phong(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return illuminate(*context.scene, point_at(setup.facet, s, t));
}

void prepare_quadratic_normals(
    const ShadingContext& /*context*/, const Facet& facet, FacetSetup& setup) {
    setup.facet = facet;
    std::array<Vec3r, 6> normals;
    const auto points = six_points(facet);
    for (std::size_t i = 0; i < 6; ++i) {
        normals[i] = points[i].normal;
    }
    setup.normal = quadratic_through(normals);
}

Lit shade_quadratic_normals(
    const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    const auto& [a, b, c] = setup.facet.corners;
    const Vec3r position = (1.0 - s - t) * a.position + s * b.position + t * c.position;
    return illuminate(*context.scene, {position, evaluate_quadratic(setup.normal, s, t)});
}

void prepare_spherical_normals(
    const ShadingContext& /*context*/, const Facet& facet, FacetSetup& setup) {
    setup.facet = facet;
}

// Two great circles: along the edge from corner 1 to corner 2, then from corner 0 to there.
Lit shade_spherical_normals(
    const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    const auto& [a, b, c] = setup.facet.corners;
    const Real away = s + t;
    const Vec3r position = (1.0 - away) * a.position + s * b.position + t * c.position;
    const Real along = away > 0.0 ? t / away : Real(0);
    const Vec3r edge = slerp(b.normal, c.normal, along, setup.facet.face_normal);
    return illuminate(
        *context.scene, {position, slerp(a.normal, edge, away, setup.facet.face_normal)});
}

}  // namespace limn::fakephong
