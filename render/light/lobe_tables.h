#pragma once

#include "ecs/components/rendering.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/texture.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace limn {

struct Material;

// Lookup tables in place of the arithmetic of Blinn, Phong, Skin and Strand (Rendering::lobes):
//
//   Table    T(u, v) = (u, v^n), a layer per exponent, u and v the cosines of diffuse light and
//            highlight (shade.phong-lut)
//   Factors  v^n alone, a row per exponent, and sqrt(1 - x^2), which the cosines of strands are
//            recombined from (shade.factorise)
//
// Reads    materials
// Writes   definitions and bindings of LightingInputs
// Order    before surfaces are lit
// Shaders  lib/lobe_tables.glsl
//
// A highlight has the exponent of its material, whatever normal_mips would lower it to.

inline constexpr int kLobeTableSize = 256;  ///< samples of a cosine
inline constexpr std::size_t kMaxLobeExponents = 64;

/// Exponents of the materials that have a lobe, ascending, and for each material the index of its
/// exponent; if there are more than kMaxLobeExponents, the next of an evenly spaced subset.
struct LobeExponents {
    std::vector<float> exponents;
    std::vector<std::uint32_t> of_material;  ///< 0 for other models
};
[[nodiscard]] LobeExponents lobe_exponents(std::span<const Material> materials);

/// (u, v^n) at u, v = 0, 1 / (size - 1) ... 1, rows of u; v^n is 0 where u is 0.
[[nodiscard]] std::vector<Vec2> bake_lobe_table(float exponent, int size);

/// f at size points from `begin` to 1.
[[nodiscard]] std::vector<float>
bake_factor(const std::function<float(float)>& f, float begin, int size);

struct LobeTableEffect {
    std::optional<gpu::Texture> tables = {};
    std::vector<float> baked = {};
    LobeSource source = LobeSource::Computed;  ///< of `tables`
    BufferTexture layer_of_material = BufferTexture("lobe table layers", GL_R32UI);

    static Result<LobeTableEffect> create(gpu::Device&, const RenderSettings&) {
        return LobeTableEffect{};
    }
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
};

}  // namespace limn
