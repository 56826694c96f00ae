#pragma once

#include "ecs/components/rendering.h"
#include "render/effect.h"
#include "render/gpu/texture.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace limn {

// A cube map in place of normalize() (Rendering::normalization, env.normalise-cube): a lookup with
// a vector of any length gives the unit vector along it, as graphics hardware without arithmetic
// for it did at each pixel. Filtered linearly, and across faces.
//
// Reads    Rendering
// Writes   definitions and bindings of LightingInputs
// Order    before surfaces are lit
// Shaders  lib/normalization.glsl, in bump_vertex.frag
//
// In bytes a component is off by up to 1/255, a direction by up to 0.39 degrees, which shows as
// bands and speckles in narrow highlights.
// After M. Kilgard, "A Practical and Robust Bump-mapping Technique for Today's GPUs", 2000.
// Techniques: env.normalise-cube

inline constexpr int kNormalizationSize = 64;  ///< of a face [texels]

/// Unit vectors of the texel centers of six faces of size x size texels, in the order of
/// cube_map.h, rows of s.
[[nodiscard]] std::vector<Vec3> make_normalization_cube(int size);

/// The same as bytes, four to a texel: 0 .. 255 for -1 .. 1; the last is 255.
[[nodiscard]] std::vector<std::uint8_t> normalization_bytes(int size);

/// RGBA8 or RGBA16F. `source` is not Computed.
[[nodiscard]] gpu::Texture make_normalization_texture(Normalization source, int size);

struct NormalizationEffect {
    std::optional<gpu::Texture> cube = {};
    Normalization source = Normalization::Computed;  ///< of `cube`

    static Result<NormalizationEffect> create(gpu::Device&, const RenderSettings&) {
        return NormalizationEffect{};
    }
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
};

}  // namespace limn
