#pragma once

#include "bench/fakephong/counted.h"
#include "bench/fakephong/phong_scene.h"

namespace limn::fakephong {

// The vectors of shading at one point of a surface and what follows from them: Blinn's
// illumination, and the texture coordinates with which one fetch replaces it. Each call for one
// light counts as one lighting. After spec fakephong.vectors, .illum-blinn, .envmap, .phong-map,
// .blinn-map, .blinn-axis.

/// A point of a surface with its unit normal.
struct SurfacePoint {
    Vec3r position;
    Vec3r normal;
};

/// Light that leaves a point: the part that is tinted by the object's color, and the highlight,
/// which has the light's color.
struct Lit {
    Vec3r tinted;
    Vec3r highlight;
};
[[nodiscard]] inline Lit operator+(const Lit& a, const Lit& b) {
    return {a.tinted + b.tinted, a.highlight + b.highlight};
}
[[nodiscard]] inline Lit operator-(const Lit& a, const Lit& b) {
    return {a.tinted - b.tinted, a.highlight - b.highlight};
}
[[nodiscard]] inline Lit operator*(Real k, const Lit& a) {
    return {k * a.tinted, k * a.highlight};
}

/// Unit, towards the light; zero if the light is at the point.
[[nodiscard]] Vec3r to_light(const PhongLight& light, const Vec3r& position);
/// Unit, towards the eye; zero if the eye is at the point.
[[nodiscard]] Vec3r to_eye(const PhongScene& scene, const Vec3r& position);
/// R = 2 (N.L) N - L: `direction` reflected about `normal`.
[[nodiscard]] Vec3r reflect(const Vec3r& direction, const Vec3r& normal);
/// H = (L + V) / |L + V|; zero where L = -V, which has no highlight.
[[nodiscard]] Vec3r half_vector(const Vec3r& to_light, const Vec3r& to_eye);

/// (N.H)^n, 0 where N.H <= 0. The thesis has no other gate: a light behind the surface is not
/// excluded.
[[nodiscard]] Real blinn_highlight(Real n_h, Real exponent);

/// Equation 3.4 for one light; without the ambient part. Only the parts that scene.channels
/// selects.
[[nodiscard]] Lit
illuminate(const PhongScene& scene, const PhongLight& light, const SurfacePoint& point);
/// The ambient part and all lights.
[[nodiscard]] Lit illuminate(const PhongScene& scene, const SurfacePoint& point);

/// Plane coordinates of the normal projected along H, (u, v) = (U.P, V.P) with P = N - (N.H) H, so
/// that u^2 + v^2 = 1 - (N.H)^2. If N.H < 0 or H is zero, they lie on the rim, which is 0.
[[nodiscard]] Vec2r
blinn_coordinates(const PhongScene& scene, const PhongLight& light, const SurfacePoint& point);

/// The same along L instead of H: the diffuse value is sqrt(1 - u^2 - v^2).
[[nodiscard]] Vec2r
diffuse_coordinates(const PhongScene& scene, const PhongLight& light, const SurfacePoint& point);

/// The same as the vertex program of appendix B, with its defects: the axis is not normalized, it
/// is the world's up, and N.H < 0 is not handled.
[[nodiscard]] Vec2r blinn_coordinates_as_printed(
    const PhongScene& scene, const PhongLight& light, const SurfacePoint& point);

/// Elias: L projected on the plane orthogonal to N; the diffuse value is sqrt(1 - u^2 - v^2).
[[nodiscard]] Vec2r
phong_map_coordinates(const PhongScene& scene, const PhongLight& light, const SurfacePoint& point);

/// The sphere map's (Wx, Wy) / m of the view direction reflected about the normal, in the unit
/// disc; independent of the lights. Zero if W points straight away from the eye (m = 0).
[[nodiscard]] Vec2r sphere_map_coordinates(const PhongScene& scene, const SurfacePoint& point);

/// Right, up and back of the camera, unit.
struct CameraFrame {
    dvec3 right, up, back;
};
[[nodiscard]] CameraFrame camera_frame(const PhongCamera& camera);

}  // namespace limn::fakephong
