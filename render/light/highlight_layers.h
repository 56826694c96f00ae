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

/// Published in the views of which a rate reads them: by HighlightMap, empty if none reads that
/// one.
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
    std::vector<float> exponents;  ///< by layer, of Blinn's highlight; [0] is 1: diffuse
    std::vector<std::uint32_t>
        of_record;  ///< by MaterialPool record; 0 where there is no highlight
};

/// Exponent of Blinn's highlight of a Blinn or Phong material; 0: it has another model. Phong's
/// lobe is as wide as Blinn's of four times its exponent (Fisher and Woo, "R.E versus N.H Specular
/// Highlights", 1994).
[[nodiscard]] float highlight_exponent(const Material& material);

/// A layer for every exponent, whatever the number of materials. If they are more than
/// kMaxHighlightLayers, as many of them, evenly spaced among them in order, and materials read the
/// next one.
[[nodiscard]] HighlightLayers layers_by_exponent(std::span<const Material> materials);

/// A layer for every Blinn or Phong material; by exponent if they are too many.
[[nodiscard]] HighlightLayers layers_by_material(std::span<const Material> materials);

}  // namespace limn
