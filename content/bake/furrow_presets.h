#pragma once

#include "ecs/components/furrows.h"

#include <span>

namespace limn {

// The settings of the figures of Bando 2001, Table 6.2. The table calls the last two Figure 6.7 (c)
// and (d), text and captions Figure 6.8 (a) and (b).

/// How the skin of a figure is lit.
enum class FurrowLighting : std::uint8_t { Blinn, Brdf1, Brdf2 };

struct FurrowPreset {
    const char* name;
    const char* figure;  ///< "6.5a"
    float noise;
    float bump;
    FurrowLighting lighting;
    float melanin;    ///< 0 .. 1; this and the following are 0 where it has lobes
    float blood;      ///< 0 .. 1
    float specular;   ///< 0 .. 1
    float shininess;  ///< 0 .. 128
    float scale;
};

/// In the order of the table.
[[nodiscard]] std::span<const FurrowPreset> furrow_presets();

/// `style` with the noise, the bump and the scale of `preset`.
[[nodiscard]] FurrowStyle with_preset(FurrowStyle style, const FurrowPreset& preset);

/// Whether furrows must be regrown after the style changed from `a` to `b`; otherwise updating
/// noise and normals suffices.
[[nodiscard]] bool needs_growth(const FurrowStyle& a, const FurrowStyle& b);

}  // namespace limn
