#pragma once

#include "content/app/quality.h"

namespace limn {

/// Adds what there is to say of glare to the report of glow: streaks where diffraction has them,
/// as much light as was asked for, fading as its closed form.
[[nodiscard]] Status measure_glare(HeadlessRenderer& headless, QualityReport& report);

}  // namespace limn
