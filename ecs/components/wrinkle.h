#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Skin that wrinkles where it is compressed (wrinkle.compression.*). A deformed mesh defines where
// it may wrinkle, and across which direction (MeshData::regions); the wrinkle map of its material
// has the shape of the wrinkles; a WrinkleSurface sets how compression raises them and how they
// are drawn.
// Techniques: face.wrinkle-options, wrinkle.fold-light, wrinkle.natural-width, wrinkle.resting,
//     wrinkle.smoothing
// Source of wrinkle.smoothing: Taubin 1995
// Source of wrinkle.resting: Takema et al. 1997; Akazaki et al. 2002
// Source of wrinkle.natural-width: Wagner 1929; Steigmann 1990
// Source of wrinkle.fold-light: Oren and Nayar 1994; Jimenez et al. 2016

/// How wrinkles are drawn.
enum class WrinkleMethod : std::uint8_t {
    None,   ///< not at all
    Alpha,  ///< darkened slopes: C (1 - I W), without lighting (wrinkle.compression.alpha-shading)
    Directional,  ///< only slopes that face down the map, as if lit from above
    Bump,         ///< slopes times I: wrinkles as high as I (wrinkle.compression.interp-bump)
    Sphere,       ///< x and y of the normal times I, lifted to the unit sphere (.normal-fit)
    Isometric,    ///< slopes just steep enough to preserve the length of the skin
    Blend,  ///< wrinkles at full height, whose lighting is blended with smooth skin's (.bump-blend)
    StrainView,  ///< visualizes the strain by colors and crosses (face.strain)
    Model,       ///< a fitted map, polynomial in the strain (face.wrinkle-model)
    Photo,       ///< as in a photograph: baked shading that does not move (face.wrinkle-options)
};

inline constexpr const char* kWrinkleMethodNames =
    "none alpha directional bump sphere isometric blend strain_view model photo";

/// Weights of the triangles at a vertex in its compression (wrinkle.compression.vertex-weight).
enum class WrinkleWeight : std::uint8_t {
    Angle,    ///< at the vertex: independent of the tessellation
    Area,     ///< of the triangle
    Uniform,  ///< depends on the tessellation; for comparison
};

/// What measures how compressed skin is.
enum class WrinkleDriver : std::uint8_t {
    Chord,   ///< the length of triangles across the wrinkles
    Edge,    ///< the lengths of edges, whatever their direction (Volino and Magnenat-Thalmann)
    Strain,  ///< the shortest direction in the tangent plane (face.strain)
    Radial,  ///< nothing: strongest at `center`, none beyond `radius` (Pelachaud et al.)
};

/// How the wrinkles of two layers combine to one relief (wrinkle.compression.overlap).
enum class WrinkleCombine : std::uint8_t {
    Slopes,       ///< heights add up, in any order
    Independent,  ///< the second layer covers the first as much as it is raised; for comparison
};

/// Folds of a region that remain when its skin is at rest, as with age.
struct RestingFolds {
    std::string region{};
    float shortening = 0.1f;
};

LIMN_FIELDS(RestingFolds) {
    LIMN_FIELD(region, "region of the mesh, by name");
    LIMN_FIELD(
        shortening, "fraction by which its skin is too long: it folds as if compressed by that", "",
        0, 0.5);
}

struct WrinkleSurface {
    WrinkleMethod method = WrinkleMethod::Isometric;
    std::vector<std::string> regions{};
    std::vector<std::string> second_regions{};
    bool second_turned = false;
    WrinkleCombine combine = WrinkleCombine::Slopes;
    WrinkleDriver driver = WrinkleDriver::Chord;
    WrinkleWeight weight = WrinkleWeight::Angle;
    bool mean_length = false;
    bool interpolate = true;
    bool fade = false;
    bool bounce = true;
    float lambda = 1.05f;
    float beta = 4;
    float slack = 0.03f;
    float share = 0.3f;
    float narrowing = 0;
    float smoothing = 0;
    std::vector<RestingFolds> resting{};
    std::string resting_shape{};
    Vec3 center = {0, 0, 0};
    float radius = 0.1f;
    float activation = 1;
    float shade_from = 0;
    float none_from = 0;
    float displacement = 0;
    float displacement_until = 1.2f;
};

/// The driver that is used: the strain where that is drawn.
inline WrinkleDriver used_driver(const WrinkleSurface& surface) {
    const bool strain =
        surface.method == WrinkleMethod::StrainView || surface.method == WrinkleMethod::Model;
    return strain ? WrinkleDriver::Strain : surface.driver;
}

LIMN_FIELDS(WrinkleSurface) {
    LIMN_FIELD(
        method,
        .doc =
            "how wrinkles are drawn; strain_view: instead of wrinkles the strain of the skin, red "
            "where it is compressed by 0.3 in some direction, blue where stretched, with a cross "
            "along the principal directions, on all of any deformed mesh; model: the wrinkle "
            "texture is a model fitted to the strain, for a mesh with tangents; photo: as in a "
            "photograph, lit from the top of the map whatever the lights",
        .values = kWrinkleMethodNames);
    LIMN_FIELD(
        regions,
        "regions of the mesh that wrinkle, by name; empty: all of them, or the whole of a mesh "
        "without regions if the driver is not chord");
    LIMN_FIELD(
        second_regions,
        "if set, the wrinkle map has two layers: x and y of the normals of the second one in "
        "blue and alpha, raised across these regions by the chords there; for alpha, bump and "
        "isometric");
    LIMN_FIELD(
        second_turned,
        "the second layer is raised by shortening along the wrinkles of its regions, or of the "
        "first layer's regions if it names none");
    LIMN_FIELD(
        combine, .doc = "slopes of both layers are added, or the second one covers the first",
        .values = "slopes independent");
    LIMN_FIELD(
        driver,
        .doc = "what raises wrinkles: shortening of triangles across them, of edges, in the "
               "direction of least stretch, or none: an activation around a center",
        .values = "chord edge strain radial");
    LIMN_FIELD(
        weight,
        .doc = "weights of the triangles at a vertex: their angle there, their area, or equal",
        .values = "angle area uniform");
    LIMN_FIELD(
        mean_length,
        "a vertex averages lengths and squares the mean; otherwise it averages squared lengths, "
        "which needs no square roots; not for strain");
    LIMN_FIELD(
        interpolate,
        "interpolates strengths between vertices; otherwise each triangle has that of one vertex, "
        "for comparison");
    LIMN_FIELD(
        fade,
        "light fades out where it grazes the smooth skin, and none reaches its back; such skin "
        "emits nothing");
    LIMN_FIELD(
        bounce,
        "isometric: the walls of a fold shade each other, and light bounces between them, so that "
        "deep folds take on the color of the skin instead of turning black; off: each slope is lit "
        "by itself, as always on skin that emits light");
    LIMN_FIELD(
        lambda,
        "factor of the squared length ratio: wrinkles begin where the product is 1; above 1 some "
        "compression does not wrinkle; not for isometric",
        "", 0.1, 10);
    LIMN_FIELD(beta, "how abruptly wrinkles rise; not for isometric", "", 0.1, 50);
    LIMN_FIELD(slack, "isometric: shortening that skin absorbs without folding", "", 0, 1);
    LIMN_FIELD(
        share, "isometric: fraction of the shortening beyond slack that becomes folds", "", 0, 1);
    LIMN_FIELD(
        narrowing,
        "Poisson's ratio: skin stretched along its folds narrows by this fraction of the stretch "
        "without folding (skin: 0.3 to 0.5; 0: stretch along the folds is ignored); for chord, "
        "unless mean_length",
        "", 0, 0.5);
    LIMN_FIELD(
        smoothing,
        "how far the measured compression diffuses, in edge lengths, so that folds on a coarse "
        "mesh do not show its triangles; not for radial",
        "", 0, 2);
    LIMN_FIELD(
        resting, "regions whose skin folds at rest, and more easily when it is compressed; not for "
                 "radial, strain_view and model");
    LIMN_FIELD(
        resting_shape, "shape of the mesh whose weight, 0 to 1, scales `resting`, as `age` of "
                       "a head that grows old; none: in full");
    LIMN_FIELD(center, "radial: where wrinkles are strongest, in mesh space at rest", "m");
    LIMN_FIELD(radius, "radial: distance at which wrinkles end", "m", 1e-6, 1e6);
    LIMN_FIELD(activation, "factor of all strengths; radial: strength at the center", "", 0, 1);
    LIMN_FIELD(
        shade_from,
        "distance from the camera beyond which slopes are only darkened, as by alpha (always so on "
        "a mesh without tangents); fades in over the last fifth; 0: never",
        "m", 0, 1e6);
    LIMN_FIELD(
        none_from, "distance beyond which there are no wrinkles, likewise; 0: never", "m", 0, 1e6);
    LIMN_FIELD(
        displacement,
        "fraction of their height by which folds also displace the skin, so that its silhouette "
        "and shadow fold, where a fold spans four edges of the mesh or more (mesh refined); for "
        "bump and isometric; 0: folds affect only the lighting",
        "", 0, 1);
    LIMN_FIELD(
        displacement_until,
        "distance from the camera beyond which folds displace nothing; fades over the last fifth; "
        "0: never",
        "m", 0, 1e6);
}

/// A triangle at a vertex, and its weight in the vertex's compression.
struct WrinkleCorner {
    std::uint32_t corner = 0;  ///< in WrinkleRest::corners; its triangle is corner / 3
    float weight = 0.0f;       ///< sum 1 at each vertex
};

/// A mesh at rest with one direction across its wrinkles, prepared for measuring how much its skin
/// has shortened in that direction. An edge is a triangle whose second and third vertex are the
/// same. A triangle that is measured in two directions appears twice.
struct WrinkleRest {
    std::vector<std::uint32_t> corners;  ///< three vertices per triangle
    std::vector<Vec2> across;  ///< per triangle the unit direction in its plane as x e1 + y e2, e1
                               ///< and e2 the edges from its first vertex [1/m]; (0, 0): none
    std::vector<WrinkleCorner> around;  ///< triangles that have a direction, vertex after vertex
    std::vector<std::uint32_t> first;   ///< offsets into `around`, one per vertex plus the end
    bool mean_length = false;           ///< see WrinkleSurface
    bool wide = false;                  ///< triangles around a vertex need not have it as a corner
    /// Triangles from this index on add by how much longer they are, max(ratio - 1, 0).
    std::uint32_t stretch_from = ~0u;
};

inline constexpr int kFoldSteps = 16;

/// How steep the folds of a wrinkle map must be to take up an excess of length e = rest / now - 1:
/// factors on its slopes, divided by sqrt(e), at e = i / (kFoldSteps - 1).
using FoldTable = std::array<float, kFoldSteps>;

/// Whether its wrinkles have two layers.
inline bool has_layers(const WrinkleSurface& surface) {
    return used_driver(surface) == WrinkleDriver::Chord
           && (surface.method == WrinkleMethod::Alpha || surface.method == WrinkleMethod::Bump
               || surface.method == WrinkleMethod::Isometric)
           && (!surface.second_regions.empty() || surface.second_turned);
}

/// Weight of what ends at a distance: 1 until the last fifth before `end`, 0 beyond it; always 1 if
/// `end` is 0.
inline float fade_until(float end, float distance) {
    const float t = end > 0 ? std::clamp((distance / end - 0.8f) / 0.2f, 0.0f, 1.0f) : 0.0f;
    return 1 - t * t * (3 - 2 * t);
}

/// Whether its folds displace the skin.
inline bool is_displaced(const WrinkleSurface& surface) {
    const bool covered = has_layers(surface) && surface.combine == WrinkleCombine::Independent;
    return surface.displacement > 0 && !covered
           && (surface.method == WrinkleMethod::Bump || surface.method == WrinkleMethod::Isometric);
}

/// What the wrinkle system prepares for each WrinkleSurface on a mesh that has such regions.
struct WrinkleState {
    /// None for a radial driver; for strain three, along u, v and (u + v) / sqrt(2) of axes u and v
    /// in the tangent plane of each vertex; otherwise one, and that of the second layer.
    std::vector<WrinkleRest> rests;
    std::vector<float> mask;     ///< per vertex: 0 .. 1 of the wrinkles
    std::vector<float> resting;  ///< per vertex: shortening of folds that remain at rest; or empty
    /// Index of the shape whose weight scales `resting`, or kNoAsset: unscaled.
    std::uint32_t resting_shape = kNoAsset;
    std::vector<float> second_mask;  ///< of a second layer, whose rest is the second one; or empty
    FoldTable folds = {};
    /// Strain of a mesh with tangents, per vertex: the angle from the axis u to the tangent [rad],
    /// and the side of the bitangent, 1 or -1. Or empty.
    std::vector<Vec2> frames;
    /// Displaced skin: per vertex the fold height of both layers at the slopes of the map [m of the
    /// mesh at rest]. Or empty: the mesh can show none.
    std::vector<Vec2> heights;
    float largest_fold = 0;    ///< bound on how far folds displace a vertex [m]
    std::uint64_t source = 0;  ///< hash of the mesh, its version, the map and the regions
};

template <>
struct ComponentTraits<WrinkleState> : DefaultTraits {
    static constexpr bool saved = false;  // follows from the mesh
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
