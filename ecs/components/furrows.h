#pragma once

#include "ecs/base/hash.h"
#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

// Wrinkle furrows: fine lines of skin, grown along two vector fields over a surface (Bando, "Human
// Skin Simulation by Generating Wrinkles along Vector Fields", 2001). What an author writes is
// here, and the surface laid flat that furrows are drawn on. Field 0 is the first field (F1), field
// 1 the second (F2); a vector's magnitude, 0 .. 2, is how pronounced furrows are.

/// How the local magnitude x of a field becomes a furrow; k is FurrowStyle::scale. Pairs are {value
/// at x = 0, increase with x}.
struct FurrowFunctions {
    Vec2 angle = {1.0f, -0.4f};
    Vec2 length = {4, 1};
    Vec2 density = {1, 6};
    float width = 1;
    float depth = 0.25f;
    Vec2 limit = {30, -10};
};

LIMN_FIELDS(FurrowFunctions) {
    LIMN_FIELD(
        angle, "largest turn between field and segment: at magnitude 0, and more with each 1",
        "rad", -1.2, 1.2);
    LIMN_FIELD(length, "of a segment, times the scale", "px", 0, 64);
    LIMN_FIELD(density, "band in which no other furrow starts, times the scale", "px", 0, 64);
    LIMN_FIELD(width, "of a furrow, times magnitude and scale", "px", 0, 32);
    LIMN_FIELD(depth, "times the magnitude squared; 1 is the deepest", "", 0, 1);
    LIMN_FIELD(limit, "segments of half a furrow, less one", "", -100, 100);
}

struct FurrowStyle {
    FurrowFunctions functions = {};
    float scale = 1;
    float noise = 0;
    float bump = 0.5f;
    int seed = 1;
    bool literal_turn = false;
};

LIMN_FIELDS(FurrowStyle) {
    LIMN_FIELD(functions, "how the magnitude of a field becomes a furrow");
    LIMN_FIELD(scale, "of all lengths of furrows", "", 0.5, 2);
    LIMN_FIELD(noise, "roughness: height taken away at random", "", 0, 1);
    LIMN_FIELD(bump, "height of the relief", "px", 0, 1);
    LIMN_FIELD(seed, "random seed", "", 0, 2147483647);
    LIMN_FIELD(literal_turn, "every segment turns by the largest angle, to one side");
}

/// Sets the two fields at one point of a surface.
struct FurrowArrow {
    Vec3 at = {0, 0, 0};
    Vec3 first = {0, 1, 0};
    Vec3 second = {1, 0, 0};
    float weight = 1;
};

LIMN_FIELDS(FurrowArrow) {
    LIMN_FIELD(at, "sets the vertex that is nearest to this point", "m");
    LIMN_FIELD(first, "first field there; its magnitude, at most 2, is the furrows' strength");
    LIMN_FIELD(second, "second field there");
    LIMN_FIELD(weight, "on the fields around", "", 0, 10);
}

/// How a surface is laid flat.
enum class FurrowProjection : std::uint8_t {
    Uv,        ///< by its texture coordinates
    Planar,    ///< seen from +z
    Cylinder,  ///< unrolled around the axis x = z = 0
};

/// A triangle of a FurrowMap. What varies over it is a value at corner 0 with the increase per
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

/// A surface laid flat on an image whose rows run from top to bottom; pixel (i, j) has its center
/// at (i + 0.5, j + 0.5). Of triangles that overlap the first counts.
struct FurrowMap {
    IVec2 size = {512, 512};  ///< [px]
    bool wrap_s = false;      ///< the image repeats to the right
    bool wrap_t = false;      ///< the image repeats downwards
    std::vector<FurrowTriangle> triangles;
    std::uint32_t stream[2] = {0, 1};  ///< random numbers of the two fields
};

/// Random numbers for the turn of a segment: of field `stream`, furrow `furrow`, its half.
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
