#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Techniques: engine.light-loops, fakephong.blinn-axis, light.gouraud, light.infinite-approx,
//     shade.control-flow

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

/// How surfaces get from lit points to lit pixels: Phong shading and what stands in for it (the
/// fakephong entries of the specification; render/light/shading_rates.h). All but Pixel are
/// forward, in ObjectMajor order.
enum class ShadingRate : std::uint8_t {
    Pixel,  ///< lit per pixel, with interpolated normals (light.phong-pixel)

    // Lit points of triangles, whose colors are interpolated:
    Vertex,       ///< linear through the vertices (light.gouraud)
    Subdivided,   ///< linear in quarters, through vertices and midpoints of edges
    Quadratic,    ///< quadratic through the same six points
    Cubic,        ///< cubic through ten points
    HwQuadratic,  ///< quadratic, with the HardwareDefects of the thesis's appendix A

    // Normals of triangles, lit per pixel:
    NormalsQuadratic,  ///< quadratic through vertices and midpoints, not renormalized
    NormalsSpherical,  ///< along great circles
    Taylor,            ///< second-order Taylor series of the lit normal about the centroid

    // Lit vertices, and a part of the light from textures per pixel. That of Blinn and Phong
    // surfaces only; others are as with Vertex:
    BlinnMap,        ///< highlights, by linear coordinates of each light
    QuadraticBlinn,  ///< highlights, by quadratic coordinates of each light
    HwBlinn,         ///< as BlinnMap, with the HardwareDefects of appendix B
    PhongMap,        ///< diffuse light, by linear coordinates of each light; no highlights
    Environment,     ///< highlights of all lights in one map, as if infinitely far away

    // Vectors to lights at vertices, in tangent space, and normal maps per pixel. Of Blinn and
    // Phong surfaces only:
    BumpVertex,  ///< all of them (bump.vertex-light-space)
    BumpAuto,    ///< those of fine meshes; others as with Pixel (bump.strategy)
};
inline constexpr int kShadingRates = 16;

/// The global vector G that fixes the plane basis of Blinn and Phong maps (fakephong.blinn-axis).
enum class BlinnAxis : std::uint8_t {
    CameraUp,   ///< the thesis's choice: singular away from the center of the view
    WorldUp,    ///< +y, as in appendix B
    WorstCase,  ///< along the projected normal of each vertex: v = 0, no better than Gouraud
    Custom,     ///< Rendering::blinn_vector
};

/// How a map of highlights is laid out for the rate Environment (fakephong.envmap).
enum class HighlightLayout : std::uint8_t {
    Sphere,      ///< coordinates at vertices, as in the thesis: bent near silhouettes
    Longitude,   ///< latitude and longitude; here and below coordinates at pixels
    Cube,        ///< six faces
    Paraboloid,  ///< two discs, toward the camera and away from it
};

/// What the thesis's programs for the hardware of 2002 get wrong. Without all of them HwQuadratic
/// is Quadratic and HwBlinn is BlinnMap.
struct HardwareDefects {
    bool first_light = true;
    bool color_register = true;
    bool midpoint_normals = true;
    bool axis_length = true;
    bool world_up = true;
    bool lit_backs = true;
};

LIMN_FIELDS(HardwareDefects) {
    LIMN_FIELD(first_light, "hw_quadratic, hw_blinn: lights after the first are left out");
    LIMN_FIELD(
        color_register,
        "hw_quadratic: the position in a triangle is rounded to 8 bits, as colors are");
    LIMN_FIELD(
        midpoint_normals,
        "hw_quadratic: normals of midpoints are scaled with the object and not renormalized");
    LIMN_FIELD(
        axis_length, "hw_blinn: the axis of the map is not normalized, so coordinates shrink");
    LIMN_FIELD(world_up, "hw_blinn: the axis is +y, whatever blinn_axis says");
    LIMN_FIELD(lit_backs, "hw_blinn: normals that point away from the halfway vector are lit, too");
}

/// Their names, for fields that hold one.
inline constexpr const char* kShadingRateNames =
    "pixel vertex subdivided quadratic cubic hw_quadratic normals_quadratic normals_spherical "
    "taylor "
    "blinn_map quadratic_blinn hw_blinn phong_map environment bump_vertex "
    "bump_auto";

/// Antialiasing method.
enum class Antialiasing : std::uint8_t {
    Auto,  ///< temporal where it is played; `limn render` averages samples instead
    None,
    Temporal,  ///< accumulates reprojected previous frames (TAA)
};

/// The dearest way in which surfaces show detail; materials that want more fall to it
/// (relief.selection, the ladder of SurfaceDetail).
enum class DetailLimit : std::uint8_t {
    Full,
    Relief,  ///< no outlines and no holes of reliefs, no displacement
    Occlusion,
    Parallax,
    Normal,
    Flat,
};
inline constexpr int kDetailLimits = 6;
inline constexpr const char* kDetailLimitNames = "full relief occlusion parallax normal flat";

/// What gives the lobes of Blinn, Phong, Skin and Strand.
enum class LobeSource : std::uint8_t {
    Computed,  ///< arithmetic
    Table,     ///< a texture of the cosines of diffuse light and highlight (shade.phong-lut)
    Factors,   ///< a texture for each factor, which are recombined (shade.factorise)
};

/// What gives unit vectors to lights and halfway to the viewer, and unit normals, at the pixels of
/// BumpVertex.
enum class Normalization : std::uint8_t {
    Computed,    ///< arithmetic
    CubeBytes,   ///< a lookup in a cube map of bytes (env.normalise-cube)
    CubeFloats,  ///< a lookup in one of half floats
};

/// How shaders run through the directional lights.
enum class LightLoops : std::uint8_t {
    Uniform,   ///< a loop whose count is a uniform
    Unrolled,  ///< the count is a constant of the program: no loop is left (shade.control-flow)
    Auto,      ///< unrolled where few lights and little code make it pay (branch_cost.h)
};

/// Resource: rendering settings. Absent: the defaults.
struct Rendering {
    LightMethod lights = LightMethod::Clustered;
    ShadingRate shading = ShadingRate::Pixel;
    BlinnAxis blinn_axis = BlinnAxis::CameraUp;
    Vec3 blinn_vector = {0, 1, 0};
    bool blinn_diffuse = false;
    HighlightLayout highlight_layout = HighlightLayout::Sphere;
    bool screen_interpolation = false;
    HardwareDefects hardware = {};
    DetailLimit surface_detail = DetailLimit::Full;
    float plain_below = 0;  ///< size in a view [px]
    LobeSource lobes = LobeSource::Computed;
    Normalization normalization = Normalization::Computed;
    LightLoops light_loops = LightLoops::Uniform;
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
        .doc =
            "shading per pixel, or a method that stands in for it: colors interpolated between 3 "
            "(vertex), 6 (subdivided, quadratic, hw_quadratic) or 10 (cubic) lit points of each "
            "triangle; normals other than linear (normals_*, taylor); textures, which blinn and "
            "phong materials read highlights from (blinn_map, quadratic_blinn, hw_blinn, "
            "environment) or diffuse light (phong_map); vectors to lights in the tangent space of "
            "vertices, for normal maps of blinn and phong materials (bump_vertex), or only "
            "where edges are short for the distance of lamps (bump_auto)",
        .values = kShadingRateNames);
    LIMN_FIELD(
        blinn_axis, .doc = "vector that fixes the texture coordinates of blinn_map and the like",
        .values = "camera_up world_up worst_case custom");
    LIMN_FIELD(blinn_vector, "of blinn_axis custom, in world space, of any length");
    LIMN_FIELD(
        blinn_diffuse,
        "blinn_map, quadratic_blinn: diffuse light is read in a texture, too; of four lights at "
        "most, by further ones vertices are lit");
    LIMN_FIELD(
        highlight_layout,
        .doc = "environment: the map of highlights; sphere: coordinates from vertices, which bend "
               "near silhouettes; otherwise directions from vertices and coordinates at pixels",
        .values = "sphere longitude cube paraboloid");
    LIMN_FIELD(
        screen_interpolation,
        "forward shading interpolates on the screen, without the perspective divide, as hardware "
        "and forward differences once did; colors and textures swim where triangles lean away");
    LIMN_FIELD(hardware, "defects of hw_quadratic and hw_blinn");
    LIMN_FIELD(
        surface_detail,
        .doc = "the dearest way in which surfaces show detail: materials whose `detail` is dearer "
               "fall to it",
        .values = kDetailLimitNames);
    LIMN_FIELD(
        plain_below,
        "surfaces whose box is smaller than this in a view have neither normal maps nor relief; "
        "depends only on that view (no hysteresis, so that frames of a farm are those of one "
        "process), a probe's and a mirror's too; not with normal_mips, object normals or double "
        "depth; 0: all have theirs",
        "px", 0, 16384);
    LIMN_FIELD(
        lobes,
        .doc = "the light that blinn, phong, skin and strand materials reflect: computed, looked "
               "up in a table, or recombined from tables of its factors",
        .values = "computed table factors");
    LIMN_FIELD(
        normalization,
        .doc = "unit vectors at the pixels of bump_vertex: computed, or looked up in a cube map of "
               "bytes or of half floats",
        .values = "computed cube_bytes cube_floats");
    LIMN_FIELD(
        light_loops,
        .doc = "the loop over directional lights: with a uniform count, or unrolled for their "
               "number, a program for each; auto: where it pays",
        .values = "uniform unrolled auto");
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
