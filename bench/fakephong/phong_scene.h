#pragma once

#include "ecs/base/result.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::fakephong {

// What the laboratory draws: a mesh, a material, lights and an eye, in double precision and in
// world space. Everything is a plain value; the scenes of the thesis are in phong_models.h.

using glm::dvec2;
using glm::dvec3;

/// Vertices of a mesh; a vertex normal that is zero or not finite is replaced by the facet's.
struct PhongMesh {
    std::vector<dvec3> positions = {};
    std::vector<dvec3> normals = {};                           ///< unit, as many as positions
    std::vector<dvec2> uvs = {};                               ///< as many, or empty: untextured
    std::vector<std::array<std::uint32_t, 3>> triangles = {};  ///< counter-clockwise from the front
};

struct PhongLight {
    bool directional = false;
    dvec3 at = dvec3(0, 0, 1);     ///< position, or direction towards the light (any length)
    dvec3 color = dvec3(1, 1, 1);  ///< no attenuation with distance
};

/// fakephong.illum-blinn: ka O Ia + sum of I (kd O (N.L) + ks (N.H)^n).
struct PhongMaterial {
    dvec3 color = dvec3(1);
    double ambient = 0.1;  ///< ka Ia, 0 .. 1
    double diffuse = 0.9;  ///< kd, 0 .. 1
    double specular = 1;   ///< ks, 0 .. 1
    double exponent = 32;  ///< n, 0 .. 10,000
    double checks = 0;     ///< checkers along u and v that halve the color; 0 = untextured
};

/// A perspective camera; `half_size` is the tangent of half the field of view, the same in both
/// directions.
struct PhongCamera {
    dvec3 eye = dvec3(0, 0, 5);
    dvec3 target = dvec3(0);
    dvec3 up = dvec3(0, 1, 0);
    double half_size = 0.26;
    int size = 256;  ///< pixels along both sides, 1 .. 4096
};

/// Which parts of the illumination are drawn. The thesis measures only highlights.
enum class Channels : std::uint8_t { Full, Diffuse, Specular };

/// The global vector G that fixes the plane basis of Blinn maps (fakephong.blinn-axis).
enum class BlinnAxis : std::uint8_t {
    CameraUp,   ///< the thesis's choice: singular away from the center of the view
    WorldUp,    ///< +y, as in appendix B
    WorstCase,  ///< along the projected normal of each vertex: v = 0, no better than Gouraud
    Custom,     ///< PhongScene::axis_vector
};

/// What is linear on the screen (fakephong.texmap).
enum class Interpolation : std::uint8_t {
    Perspective,  ///< coordinates on a triangle over w, and 1/w: correct; one division per pixel
    Screen,       ///< the coordinates themselves: distorted where w varies
};

struct PhongScene {
    std::string name = {};
    PhongMesh mesh = {};
    PhongMaterial material = {};
    std::vector<PhongLight> lights = {};  ///< 1 .. kMaxLights
    PhongCamera camera = {};
    Channels channels = Channels::Specular;
    BlinnAxis axis = BlinnAxis::CameraUp;
    dvec3 axis_vector = {0, 1, 0};  ///< of BlinnAxis::Custom, of any length
    bool diffuse_texture = false;   ///< Blinn maps: diffuse light is also read from a texture
    Interpolation interpolation = Interpolation::Perspective;
    double environment_exponent = 8;  ///< of the lobes baked in an environment map, about n / 4
    int texture_size = 256;           ///< 0: texture functions are evaluated exactly
    int row = 128;                    ///< the scanline, which should cross the highlight
};

inline constexpr int kMaxLights = 8;

/// Fails with one line that names the field, what was found and what was expected.
[[nodiscard]] Status check_scene(const PhongScene& scene);

}  // namespace limn::fakephong
