#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Lighting algorithm. All give the same image at different cost (`limn bench lights`). Blended
/// surfaces always use clustered lighting.
enum class LightMethod : std::uint8_t {
    Clustered,    ///< deferred; one pass, each pixel with the lights of its cluster
    FullScreen,   ///< deferred; a full-screen pass per light
    Volumes,      ///< deferred; a pass per light over the pixels inside its volume
    ObjectMajor,  ///< forward; each object once, with the lights that reach it
    LightMajor,   ///< forward; for each light, the objects that it reaches
};

inline constexpr int kLightMethods = 5;

/// Frequency at which shading is evaluated.
enum class ShadingRate : std::uint8_t {
    Pixel,  ///< per pixel, with interpolated normals (light.phong-pixel)
    // The others are forward, in ObjectMajor order. These light points of triangles and interpolate
    // the colors:
    Vertex,      ///< linear through the vertices (light.gouraud)
    Subdivided,  ///< linear in quarters, through vertices and midpoints of edges
    Quadratic,   ///< quadratic through the same six points (fakephong.quadratic)
    Cubic,       ///< cubic through ten points (fakephong.cubic)
    // These light pixels by other interpolants of normals (fakephong.normal-interp-variants):
    NormalsQuadratic,  ///< quadratic through vertices and midpoints, not renormalized
    NormalsSpherical,  ///< along great circles
};
inline constexpr int kShadingRates = 7;

/// Their names, for fields that hold one.
inline constexpr const char* kShadingRateNames =
    "pixel vertex subdivided quadratic cubic normals_quadratic normals_spherical";

/// Antialiasing method.
enum class Antialiasing : std::uint8_t {
    Auto,  ///< temporal where it is played; `limn render` averages samples instead
    None,
    Temporal,  ///< accumulates reprojected previous frames (TAA)
};

/// Resource: rendering settings. Absent: the defaults.
struct Rendering {
    LightMethod lights = LightMethod::Clustered;
    ShadingRate shading = ShadingRate::Pixel;
    Antialiasing antialiasing = Antialiasing::Auto;
    bool infinite_viewer = false;  ///< shading uses one view direction for the whole image
    float particle_share = 1;      ///< of those that the GPU moves, see below
    float level_rows = 1080;       ///< of the image that MeshLevels are chosen for [px]
};

LIMN_FIELDS(Rendering) {
    LIMN_FIELD(
        lights, .doc = "lighting algorithm; all give the same image",
        .values = "clustered full_screen volumes object_major light_major");
    LIMN_FIELD(
        shading,
        .doc = "shading per pixel, or per vertex, or interpolated between 6 (subdivided: in "
               "quarters; quadratic) or 10 (cubic) points of each triangle; per pixel by normals "
               "that are quadratic or spherical over it",
        .values = kShadingRateNames);
    LIMN_FIELD(
        antialiasing,
        .doc = "antialiasing method; auto: temporal when played, samples when rendered",
        .values = "auto none temporal");
    LIMN_FIELD(infinite_viewer, "highlights use one view direction, as if infinitely far away");
    LIMN_FIELD(
        particle_share,
        "share of the particles moved by the GPU that are moved and drawn, larger by as much; "
        "rounded down to 1, 1/2, 1/4 ...",
        "", 0.0009765625, 1);
    LIMN_FIELD(
        level_rows,
        "rows of the image that mesh_levels are chosen for; `play` sets it to the rows it draws",
        "px", 16, 16384);
}

}  // namespace limn
