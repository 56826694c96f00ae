#pragma once

#include "render/effect.h"

#include <span>

namespace limn {

/// The image as an ordered list of effects (image.cpp). Add an effect here, or pass a list of your
/// own in RenderSettings::image.
[[nodiscard]] std::span<const EffectEntry> standard_image();

/// Fewer of them, for slow machines (render_profile.h).
[[nodiscard]] std::span<const EffectEntry> plain_image();

}  // namespace limn
