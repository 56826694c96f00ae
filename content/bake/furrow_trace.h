#pragma once

#include "ecs/components/furrows.h"

#include <cstdint>
#include <vector>

namespace limn {

// Furrows of one field, drawn one after another until there is no room for another start.
//
// A furrow starts at its center and runs along the field, then against it: a straight segment along
// the field at its start, rotated at random by up to the angle of the style, then the next, until
// the furrow is long enough or meets another furrow of the field or the border of the surface,
// where it ends. It is surrounded by a band in which no other furrow starts. First the centroids of
// all triangles are tried, which spreads furrows sparsely, then all pixels. After Bando 2001,
// section 3.3; choices where that is silent:
//
//   - a segment turns by a random angle in -+angle, which FurrowStyle::literal_turn replaces by the
//     angle itself, as printed;
//   - the halves of a furrow may cross each other;
//   - a furrow owns the pixels that its segments cross, and those whose centers it covers: no other
//     furrow of its field enters them, so that it ends there;
//   - deep is dark: the printed color is the depth, but white is high;
//   - furrows narrower than a pixel cover a fraction of it.
//
// Every step depends on the previous ones, so all arithmetic is repeatable (repeatable_math.h); the
// version on the GPU, furrow_trace.comp, is bit-identical.

/// The six furrow functions evaluated at one point, in pixels and radians.
struct FurrowShape {
    float angle = 0;    ///< -kMaxFurrowTurn .. kMaxFurrowTurn
    float length = 0;   ///< of a segment, at least kMinFurrowStep
    float density = 0;  ///< width of the band
    float width = 0;
    float depth = 0;  ///< 0 .. 1
    int limit = 0;    ///< segments that follow
};

inline constexpr float kMaxFurrowTurn = 1.2f;  // [rad]; range of repeatable_cos_sin
inline constexpr float kMinFurrowStep = 0.5f;  // [px], so that furrows advance

/// The shape at this field magnitude, which is clamped to 0 .. 2.
[[nodiscard]] FurrowShape furrow_shape(const FurrowStyle& style, float magnitude);

/// Per pixel: index of the first triangle of the map that covers its center, or -1. Row by row.
[[nodiscard]] std::vector<std::int32_t> cover_furrow_map(const FurrowMap& map);

/// A segment as drawn; `to` may lie beyond an image that repeats.
struct FurrowSegment {
    Vec2 from = {0, 0};        ///< [px]
    Vec2 to = {0, 0};          ///< [px]
    float band = 0;            ///< width of the band [px]
    std::uint32_t furrow = 0;  ///< its id
    bool backward = false;     ///< belongs to the half that runs against the field
    bool met = false;          ///< ends at another furrow or the border
};

/// Id 0 is none; the furrow that starts at triangle i has i + 1, the one at pixel i the number of
/// triangles + i + 1.
inline constexpr std::uint32_t kFurrowBand = 0x80000000u;

/// Furrows of one field.
struct FurrowDrawing {
    std::vector<std::uint32_t>
        cells;  ///< per pixel: id of the furrow that owns it, | kFurrowBand in a band
    std::vector<float> height;  ///< per pixel, 1: skin without a furrow .. 0
};

/// A drawing without furrows.
[[nodiscard]] FurrowDrawing make_furrow_drawing(const FurrowMap& map);

/// Draws one half of a furrow of `field` (0 or 1) from `start` [px], which must lie within the
/// image. `cover` is that of cover_furrow_map. Appends what it draws to `segments`, if any.
void trace_half_furrow(
    const FurrowMap& map, const std::vector<std::int32_t>& cover, const FurrowStyle& style,
    int field, std::uint32_t furrow, const Vec2& start, bool backward, FurrowDrawing& drawing,
    std::vector<FurrowSegment>* segments = nullptr);

/// Draws all furrows of `field`. Afterwards every covered pixel is in a band.
[[nodiscard]] FurrowDrawing trace_furrows(
    const FurrowMap& map, const std::vector<std::int32_t>& cover, const FurrowStyle& style,
    int field, std::vector<FurrowSegment>* segments = nullptr);

}  // namespace limn
