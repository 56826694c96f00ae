#pragma once

#include "ecs/base/hash.h"
#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Wrinkle furrows: fine lines in skin, grown along two vector fields on a surface (Bando, "Human
// Skin Simulation by Generating Wrinkles along Vector Fields", 2001). This header has the author's
// settings and the flattened surface that furrows are drawn on. Field 0 is the first field (F1),
// field 1 the second (F2); a vector's magnitude, 0 .. 2, is how pronounced furrows are.
// Techniques: wrinkle.furrow.functions

/// Furrow parameters as linear functions of the local field magnitude x; k is FurrowStyle::scale.
/// Pairs are {value at x = 0, increase with x}.
struct FurrowFunctions {
    Vec2 angle = {1.0f, -0.4f};
    Vec2 length = {4, 1};
    Vec2 density = {1, 6};
    float width = 1;
    float depth = 0.25f;
    Vec2 limit = {30, -10};
    bool operator==(const FurrowFunctions&) const = default;
};

LIMN_FIELDS(FurrowFunctions) {
    LIMN_FIELD(
        angle, "maximum angle between field and segment: at magnitude 0, and change per unit",
        "rad", -1.2, 1.2);
    LIMN_FIELD(length, "length of a segment, times the scale", "px", 0, 64);
    LIMN_FIELD(density, "margin in which no other furrow starts, times the scale", "px", 0, 64);
    LIMN_FIELD(width, "width of a furrow, times magnitude and scale", "px", 0, 32);
    LIMN_FIELD(depth, "depth of a furrow, times the squared magnitude; 1 is the deepest", "", 0, 1);
    LIMN_FIELD(limit, "maximum number of segments in half a furrow, minus one", "", -100, 100);
}

struct FurrowStyle {
    FurrowFunctions functions = {};
    float scale = 1;
    float noise = 0;
    float bump = 0.5f;
    int seed = 1;
    bool literal_turn = false;
    bool operator==(const FurrowStyle&) const = default;
};

LIMN_FIELDS(FurrowStyle) {
    LIMN_FIELD(functions, "furrow parameters as functions of the field magnitude");
    LIMN_FIELD(scale, "scale of all furrow lengths", "", 0.5, 2);
    LIMN_FIELD(noise, "roughness: height removed at random", "", 0, 1);
    LIMN_FIELD(bump, "height of the relief", "px", 0, 1);
    LIMN_FIELD(seed, "random seed", "", 0, 2147483647);
    LIMN_FIELD(literal_turn, "every segment turns by the maximum angle, to one side");
}

/// Sets the two fields at one point of a surface.
struct FurrowArrow {
    Vec3 at = {0, 0, 0};
    Vec3 first = {0, 1, 0};
    Vec3 second = {1, 0, 0};
    float weight = 1;
    bool operator==(const FurrowArrow&) const = default;
};

LIMN_FIELDS(FurrowArrow) {
    LIMN_FIELD(at, "position; the nearest vertex is set", "m");
    LIMN_FIELD(
        first, "first field there; its magnitude, at most 2, is the strength of the furrows");
    LIMN_FIELD(second, "second field there");
    LIMN_FIELD(weight, "influence on the fields around it", "", 0, 10);
}

/// How a surface is flattened.
enum class FurrowProjection : std::uint8_t {
    Uv,        ///< by its texture coordinates
    Planar,    ///< viewed from +z
    Cylinder,  ///< unrolled around the axis x = z = 0
};

/// A triangle of a FurrowMap. Attributes are stored as the value at corner 0 and the increase per
/// pixel to the right and downwards. Read by furrow_trace.comp as floats.
struct FurrowTriangle {
    Vec2 corner[3];  ///< [px], clockwise on the screen: rows run downwards
    Vec2 field[2];   ///< both fields at corner 0, in pixel directions
    Vec2 field_right[2];
    Vec2 field_down[2];
    Vec3 normal;  ///< at corner 0: s to the right, t up, z outwards
    Vec3 normal_right;
    Vec3 normal_down;
};
static_assert(sizeof(FurrowTriangle) == 27 * sizeof(float));

/// A surface flattened to an image whose rows run from top to bottom; pixel (i, j) has its center
/// at (i + 0.5, j + 0.5). Where triangles overlap, the first one wins.
struct FurrowMap {
    IVec2 size = {512, 512};  ///< [px]
    bool wrap_s = false;      ///< the image repeats to the right
    bool wrap_t = false;      ///< the image repeats downwards
    std::vector<FurrowTriangle> triangles;
    std::uint32_t stream[2] = {0, 1};  ///< random numbers of the two fields
};

/// The two vectors of a vertex: first and second field.
using FurrowVectors = std::array<Vec3, 2>;

/// Grown furrows, without noise. h1 and h2 are kept separate for wrinkles that deepen one field.
struct FurrowGrowth {
    IVec2 size = {0, 0};              ///< [px]
    std::vector<std::int32_t> cover;  ///< triangle of the map per pixel, or -1
    std::vector<float> first;         ///< h1: furrows of field 0; 1 = skin without a furrow .. 0
    std::vector<float> second;        ///< h2: furrows of field 1
    std::vector<float> height;        ///< the minimum of both
};

/// The settings that furrows still show while edits of Furrows are pending.
struct FurrowHold {
    bool waits = false;
    std::vector<FurrowArrow> spread = {};
    std::vector<FurrowArrow> grown = {};
    FurrowStyle style = {};
    bool operator==(const FurrowHold&) const = default;
};

LIMN_FIELDS(FurrowHold) {
    LIMN_FIELD(waits, "edits are pending until their step: interpolate, generate, remake");
    LIMN_FIELD(spread, "arrows that the fields were last interpolated from");
    LIMN_FIELD(grown, "arrows that furrows were last grown from");
    LIMN_FIELD(style, "style that furrows were last grown with");
}

/// With a MeshInstance: grows furrows over the mesh at rest, in its texture coordinates, into
/// images that its material uses. They follow every edit.
struct Furrows {
    ImageId normals = {};
    ImageId heights = {};
    bool tiles = false;
    std::vector<FurrowArrow> arrows = {};
    FurrowStyle style = {};
    FurrowHold hold = {};
    bool operator==(const Furrows&) const = default;
};

LIMN_FIELDS(Furrows) {
    LIMN_FIELD(normals, "square image to write normals to, green up; keeps its size");
    LIMN_FIELD(heights, "image of that size to write heights to: white is skin without a furrow");
    LIMN_FIELD(tiles, "the image repeats in both directions");
    LIMN_FIELD(arrows, "the fields at some points; if empty, one points upwards, the other across");
    visit_fields(self.style, visit);
    LIMN_FIELD(hold, "what is shown while edits are pending");
}

/// How Furrows are visualized on the mesh (wrinkle.furrow.view-modes).
enum class FurrowMode : std::uint8_t {
    Overview,  ///< skin without furrows
    Vectors,   ///< white faces, vertices, and the fields there
    Height,    ///< the height of furrows as brightness
    Wrinkles,  ///< skin with furrows
};

/// With Furrows: visualizes how they are made. Drawn over the image, in the rest pose.
struct FurrowView {
    FurrowMode mode = FurrowMode::Vectors;
    bool only_edited = false;
    float length = 0;
    int selected = -1;
    bool operator==(const FurrowView&) const = default;
};

LIMN_FIELDS(FurrowView) {
    LIMN_FIELD(
        mode,
        .doc = "overview: skin without furrows; vectors: white faces with vertices in blue, the "
               "first field in red, the second in green; height: furrows are dark; wrinkles: skin",
        .values = "overview vectors height wrinkles");
    LIMN_FIELD(only_edited, "fields are drawn only where arrows set them");
    LIMN_FIELD(
        length, "length of a vector of magnitude 1; 0: automatic, below the vertex spacing", "m", 0,
        1e6);
    LIMN_FIELD(selected, "highlighted vertex; -1: none", "", -1, 2147483647);
}

/// What is grown for each Furrows; rows of images from top to bottom.
struct FurrowSkin {
    Furrows source;  ///< settings it was made from, with `mesh` and `flat`
    MeshId mesh;
    std::uint32_t mesh_version = 0;
    bool flat = false;                  ///< the images show smooth skin
    std::vector<FurrowVectors> field;   ///< per vertex, as shown
    std::vector<std::uint32_t> edited;  ///< vertices that arrows set, in their order
    float spacing = 0;                  ///< mean length of the edges of the mesh [m]
    FurrowMap map;
    FurrowGrowth growth;
    std::vector<float> height;          ///< with noise
    std::vector<std::uint8_t> normals;  ///< RGBA of the normal map
    std::vector<std::uint8_t> heights;  ///< RGBA of the height map
    std::string fault;                  ///< why nothing was grown; empty on success
    std::uint32_t version = 0;          ///< changes with any of the above
};

template <>
struct ComponentTraits<FurrowSkin> : DefaultTraits {
    static constexpr bool saved = false;  // follows from Furrows
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// Length at which a vector of magnitude 1 is drawn [m].
[[nodiscard]] inline float furrow_vector_length(const FurrowView& view, const FurrowSkin& skin) {
    constexpr float kOfSpacing = 0.6f;  // by eye
    return view.length > 0 ? view.length : kOfSpacing * skin.spacing;
}

/// Random numbers for the turn of a segment in one half of furrow `furrow` of field `stream`.
[[nodiscard]] inline Random furrow_turns(
    const FurrowStyle& style, std::uint32_t stream, std::uint32_t furrow, bool backward,
    std::uint32_t segment) {
    return {
        static_cast<std::uint64_t>(style.seed), furrow, name_hash("furrow_trace") + stream,
        segment * 2 + (backward ? 1 : 0)};
}

/// Random numbers for the noise of pixels 4 `group` .. 4 `group` + 3.
[[nodiscard]] inline Random furrow_noise(const FurrowStyle& style, std::size_t group) {
    return {static_cast<std::uint64_t>(style.seed), group, name_hash("furrow_noise"), 0};
}

}  // namespace limn
