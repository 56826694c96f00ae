#pragma once

#include "bench/fakephong/blinn_illumination.h"
#include "bench/fakephong/lookup_texture.h"
#include "bench/fakephong/phong_scene.h"

#include <array>
#include <span>
#include <string_view>

namespace limn::fakephong {

// A method of shading is two functions: one that runs once per triangle, and one per pixel. The
// rasterizer (phong_raster.h) is the same for all, so that their images differ only by the method
// and their counted work can be compared.

/// One triangle. Its points are p(s, t) = p0 + s (p1 - p0) + t (p2 - p0): s, t >= 0, s + t <= 1.
struct Facet {
    std::array<SurfacePoint, 3> corners;
    Vec3r face_normal;  ///< unit; replaces normals that cancel
};

/// Data shared by all triangles of a scene.
struct ShadingContext {
    const PhongScene* scene = nullptr;
    LookupTexture blinn;        ///< highlights of Blinn maps
    LookupTexture diffuse;      ///< of Phong maps
    LookupTexture environment;  ///< highlights of all lights, in a sphere map
};
/// `scene` must outlive it.
[[nodiscard]] ShadingContext make_shading_context(const PhongScene& scene);

/// What a method stores per triangle; each uses the parts it needs.
struct FacetSetup {
    Facet facet;
    std::array<Lit, 10> lit;      ///< samples, or coefficients of a polynomial in s and t
    std::array<Vec3r, 6> normal;  ///< coefficients of normals
    std::array<std::array<Vec2r, 6>, kMaxLights> at;  ///< coefficients of texture coordinates
    std::array<std::array<Vec2r, 6>, kMaxLights> diffuse_at;     ///< of PhongScene::diffuse_texture
    std::array<std::array<Real, 6>, kMaxLights> diffuse_series;  ///< of N.L
    std::array<std::array<Real, 6>, kMaxLights> specular_series;  ///< of N.H
};

struct ShadingMethod {
    std::string_view id;    ///< of the spec entry, without "fakephong."
    std::string_view name;  ///< as in the thesis
    int lightings;          ///< per triangle and light, in prepare
    int exact_points;       ///< of the 3 corners and 3 edge midpoints, how many are exact
    void (*prepare)(const ShadingContext& context, const Facet& facet, FacetSetup& setup);
    Lit (*shade)(const ShadingContext& context, const FacetSetup& setup, Real s, Real t);
    int degree = 0;             ///< of its light as a polynomial in s and t; 0: not a polynomial
    bool diffuse_only = false;  ///< it has no highlights; its diffuse light is compared
};

/// All of them; the first is Phong shading, the reference, then the six columns of Table 6.1 in
/// order.
[[nodiscard]] std::span<const ShadingMethod> shading_methods();
/// The method with that id, or null.
[[nodiscard]] const ShadingMethod* find_method(std::string_view id);
inline constexpr std::size_t kTableColumns = 6;  ///< of Table 6.1: shading_methods()[1 .. 6]

// ---- points of a triangle

/// p(s, t), with the linear normal renormalized.
[[nodiscard]] SurfacePoint point_at(const Facet& facet, Real s, Real t);

/// Corner 0, midpoint 01, corner 1, midpoint 12, corner 2, midpoint 20, as (s, t).
inline constexpr double kSixPoints[6][2] = {{0, 0}, {0.5, 0}, {1, 0}, {0.5, 0.5}, {0, 1}, {0, 0.5}};
/// The samples there. A midpoint has the average position and the normalized sum of the normals.
[[nodiscard]] std::array<SurfacePoint, 6> six_points(const Facet& facet);

// ---- polynomials in s and t, of anything that can be added and scaled

/// c0 + c1 s + c2 t through three corners.
template <typename T>
[[nodiscard]] std::array<T, 3> linear_through(const T& r0, const T& r1, const T& r2) {
    return {r0, r1 - r0, r2 - r0};
}
template <typename T, std::size_t n>
[[nodiscard]] T evaluate_linear(const std::array<T, n>& c, Real s, Real t) {
    return c[0] + s * c[1] + t * c[2];
}

/// Equation 4.2: C0 + C1 s + C2 t + C3 s^2 + C4 s t + C5 t^2 through samples at kSixPoints.
template <typename T>
[[nodiscard]] std::array<T, 6> quadratic_through(const std::array<T, 6>& r) {
    return {
        r[0],
        4.0 * r[1] - 3.0 * r[0] - r[2],
        4.0 * r[5] - 3.0 * r[0] - r[4],
        2.0 * (r[0] - 2.0 * r[1] + r[2]),
        4.0 * (r[0] - r[1] + r[3] - r[5]),
        2.0 * (r[0] - 2.0 * r[5] + r[4])};
}
template <typename T>
[[nodiscard]] T evaluate_quadratic(const std::array<T, 6>& c, Real s, Real t) {
    return c[0] + s * c[1] + t * c[2] + (s * s) * c[3] + (s * t) * c[4] + (t * t) * c[5];
}

// ---- the methods, one pair of functions each

#define LIMN_SHADING(name)                                                                         \
    void prepare_##name(const ShadingContext& context, const Facet& facet, FacetSetup& setup);     \
    [[nodiscard]] Lit shade_##name(                                                                \
        const ShadingContext& context, const FacetSetup& setup, Real s, Real t)

LIMN_SHADING(phong);              // per_pixel_shading.cpp
LIMN_SHADING(quadratic_normals);  // six normals, not renormalized
LIMN_SHADING(spherical_normals);
LIMN_SHADING(gouraud);  // polynomial_shading.cpp
LIMN_SHADING(subdivided);
LIMN_SHADING(quadratic);
LIMN_SHADING(cubic);
LIMN_SHADING(hardware_quadratic);  // appendix A
LIMN_SHADING(taylor);              // taylor_shading.cpp
LIMN_SHADING(environment);         // texture_shading.cpp
LIMN_SHADING(phong_map);
LIMN_SHADING(blinn_map);
LIMN_SHADING(quadratic_blinn);
LIMN_SHADING(hardware_blinn);  // appendix B

#undef LIMN_SHADING

}  // namespace limn::fakephong
