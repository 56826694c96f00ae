#pragma once

#include "content/load/obj/obj_material.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <span>

namespace limn {

// Images of MTL materials as the textures that the engine has: opacity in the alpha of the color,
// roughness and metalness in one image, relief as normals.

/// Whether red, green and blue are the same in all texels, within rounding and JPEG's errors.
[[nodiscard]] bool is_gray(const ImageData& image);

/// `color`, or white where it is null, with the opacity of `opacity`: the channel, by default alpha
/// where the image has one that varies, else luminance.
[[nodiscard]] ImageData
with_opacity(const ImageData* color, const ImageData& opacity, ObjChannel channel);

/// How alpha is drawn: Opaque where all of it is 1, Mask where few texels are between 0 and 1, as
/// at the edges of a cut-out leaf, else Blend.
[[nodiscard]] AlphaMode alpha_mode_of(const ImageData& image);

/// Tangent-space normals, green up, of a height map: `strength` = 1 lifts white over black by 1 %
/// of the image's width (by eye: files do not say).
[[nodiscard]] ImageData normals_of_heights(const ImageData& heights, float strength, bool clamp);

/// A channel of an image, by default luminance; null: 1 everywhere.
struct ObjScalarMap {
    const ImageData* image = nullptr;
    ObjChannel channel = ObjChannel::Default;
    std::span<const std::uint8_t> table = {};  ///< codes for the codes 0 .. 255; empty: the same
};

/// Green = roughness, blue = metalness, as large as the larger image. One of them is not null.
[[nodiscard]] ImageData
pack_roughness_and_metalness(const ObjScalarMap& roughness, const ObjScalarMap& metalness);

}  // namespace limn
