#pragma once

#include "ecs/components/rendering.h"

#include <cstdint>
#include <iterator>

namespace limn {

// The methods of shading, as shaders. A method is a value of ShadingRate, a row here, and shaders
// of a few lines, one per vertex or triangle and one per pixel, on top of lib/facet.glsl,
// lib/facet_pixel.glsl, lib/map_vertex.glsl and lib/map_pixel.glsl.
// Techniques: fakephong.pipeline

/// Textures that replace a part of the lighting (highlight_map_pass.h).
enum class HighlightMap : std::uint8_t {
    None,
    Blinn,        ///< indexed by the plane coordinates of a light
    Environment,  ///< indexed by the reflected view direction
};

struct ShadingRateRow {
    ShadingRate rate;
    const char* vertex;
    const char* geometry;  ///< "": none
    const char* fragment;
    HighlightMap map = HighlightMap::None;
    int single_lights = 0;       ///< maximum lights with separate terms (lib/single_lights.glsl)
    bool reads_diffuse = false;  ///< as Rendering::blinn_diffuse says
};

inline constexpr int kMaxSingleLights = 8;   ///< limited by the varyings between shader stages
inline constexpr int kMaxBumpLights = 4;     ///< the same with three vectors of each
inline constexpr int kMaxDiffuseLights = 4;  ///< the same with Rendering::blinn_diffuse

/// In the order of ShadingRate.
inline constexpr ShadingRateRow kShadingRateRows[] = {
    {ShadingRate::Pixel, "mesh.vert", "", "forward_list.frag"},
    {ShadingRate::Vertex, "gouraud.vert", "", "gouraud.frag"},
    {ShadingRate::Subdivided, "sampled.vert", "six_samples.geom", "subdivided.frag"},
    {ShadingRate::Quadratic, "sampled.vert", "six_samples.geom", "quadratic.frag"},
    {ShadingRate::Cubic, "sampled.vert", "ten_samples.geom", "cubic.frag"},
    {ShadingRate::HwQuadratic, "sampled.vert", "hw_quadratic.geom", "hw_quadratic.frag",
     HighlightMap::None, 1},
    {ShadingRate::NormalsQuadratic, "sampled.vert", "facet_normals.geom", "normals_quadratic.frag"},
    {ShadingRate::NormalsSpherical, "sampled.vert", "facet_normals.geom", "normals_spherical.frag"},
    {ShadingRate::Taylor, "sampled.vert", "taylor.geom", "taylor.frag", HighlightMap::None,
     kMaxSingleLights},
    {ShadingRate::BlinnMap, "blinn_map.vert", "", "blinn_map.frag", HighlightMap::Blinn,
     kMaxSingleLights, true},
    {ShadingRate::QuadraticBlinn, "sampled.vert", "quadratic_blinn.geom", "quadratic_blinn.frag",
     HighlightMap::Blinn, kMaxSingleLights, true},
    {ShadingRate::HwBlinn, "hw_blinn.vert", "", "blinn_map.frag", HighlightMap::Blinn,
     kMaxSingleLights},
    {ShadingRate::PhongMap, "phong_map.vert", "", "phong_map.frag", HighlightMap::Blinn,
     kMaxSingleLights},
    {ShadingRate::Environment, "environment_map.vert", "", "environment_map.frag",
     HighlightMap::Environment, 1},
    {ShadingRate::BumpVertex, "bump_vertex.vert", "", "bump_vertex.frag", HighlightMap::None,
     kMaxBumpLights},
    {ShadingRate::BumpAuto, "mesh.vert", "", "forward_list.frag"},  // and the one before
};
static_assert(std::size(kShadingRateRows) == kShadingRates);

[[nodiscard]] constexpr const ShadingRateRow& row_of(ShadingRate rate) {
    return kShadingRateRows[static_cast<std::size_t>(rate)];
}

}  // namespace limn
