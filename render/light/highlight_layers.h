#pragma once

#include "render/gpu/buffer_texture.h"
#include "render/graph/frame_graph.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

struct Material;

/// Published in the views that read them: by HighlightMap, empty if no rate of the view reads that
/// map.
struct HighlightMaps {
    struct Map {
        TextureId layers;
        const BufferTexture* layer_of_material = nullptr;  ///< by record
    };
    std::array<Map, 3> maps;
};

inline constexpr std::size_t kMaxHighlightLayers = 64;

/// Which layer of the highlight maps each material reads.
struct HighlightLayers {
    std::vector<float> exponents;  ///< of Blinn's highlight, by layer; [0] is 1: diffuse
    std::vector<std::uint32_t>
        of_record;  ///< by MaterialPool record; 0 where there is no highlight
};

/// Exponent of Blinn's highlight of a Blinn or Phong material; 0: it has another model. Phong's
/// lobe is as wide as Blinn's of four times its exponent (Fisher and Woo, "R.E versus N.H Specular
/// Highlights", 1994).
[[nodiscard]] float highlight_exponent(const Material& material);

/// One layer per distinct exponent. If there are more than kMaxHighlightLayers, an evenly spaced
/// subset of the sorted exponents, and materials read the next one.
[[nodiscard]] HighlightLayers layers_by_exponent(std::span<const Material> materials);

/// One layer per Blinn or Phong material; by exponent if there are too many.
[[nodiscard]] HighlightLayers layers_by_material(std::span<const Material> materials);

}  // namespace limn
