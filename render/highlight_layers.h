#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

struct Material;

inline constexpr std::size_t kMaxHighlightLayers = 64;

/// Which layer of the highlight maps each material reads: one per exponent, whatever the number of
/// materials and lights.
struct HighlightLayers {
    std::vector<float> exponents;  ///< by layer, of Blinn's highlight; [0] is 1: diffuse
    std::vector<std::uint32_t>
        of_record;  ///< by MaterialPool record; 0 where there is no highlight
};

/// Exponent of Blinn's highlight of a Blinn or Phong material; 0: it has another model. Phong's
/// lobe is as wide as Blinn's of four times its exponent (Fisher and Woo, "R.E versus N.H Specular
/// Highlights", 1994).
[[nodiscard]] float highlight_exponent(const Material& material);

/// A layer for every exponent. If they are more than kMaxHighlightLayers, as many of them, evenly
/// spaced among them in order, and materials read the next one.
[[nodiscard]] HighlightLayers assign_highlight_layers(std::span<const Material> materials);

}  // namespace limn
