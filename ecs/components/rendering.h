#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// In what order surfaces and lights meet. The picture is the same; what it costs is not
/// (`limn bench lights`). Blended surfaces are lit by clusters whatever the method.
enum class LightMethod : std::uint8_t {
    Clustered,    ///< one pass over the G-buffer, each pixel with the lights of its cell
    FullScreen,   ///< a pass over the whole G-buffer for every light
    Volumes,      ///< the same for the pixels alone whose surface lies in the light's volume
    ObjectMajor,  ///< each object once, with the lights that reach it
    LightMajor,   ///< for each light the objects that it reaches
};

inline constexpr int kLightMethods = 5;

/// Where surfaces are lit.
enum class ShadingRate : std::uint8_t {
    Pixel,   ///< normals in between, lit at every pixel (light.phong-pixel)
    Vertex,  ///< lit at the vertices, colors in between (light.gouraud); as ObjectMajor does
};

/// How edges become smooth.
enum class Antialiasing : std::uint8_t {
    None,
    Temporal,  ///< from picture to picture, following what moves
};

/// Resource: how pictures are made. Absent: the defaults.
struct Rendering {
    LightMethod lights = LightMethod::Clustered;
    ShadingRate shading = ShadingRate::Pixel;
    Antialiasing antialiasing = Antialiasing::None;
    bool infinite_viewer = false;  ///< shading sees the camera in the same direction everywhere
};

template <typename Visitor>
void visit_fields(Rendering& rendering, Visitor&& visit) {
    visit(
        "lights", rendering.lights,
        {.doc = "in what order surfaces and lights meet; the picture is the same",
         .values = "clustered full_screen volumes object_major light_major"});
    visit(
        "shading", rendering.shading, {.doc = "where surfaces are lit", .values = "pixel vertex"});
    visit(
        "antialiasing", rendering.antialiasing,
        {.doc = "how edges become smooth", .values = "none temporal"});
    visit(
        "infinite_viewer", rendering.infinite_viewer,
        {.doc = "highlights as if seen from infinitely far along the view axis"});
}

}  // namespace limn
