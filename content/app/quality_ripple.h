#pragma once

#include "content/app/quality.h"

namespace limn {

/// Ripples beside shifts computed by geometry, and what they may not touch.
[[nodiscard]] Result<QualityReport> measure_ripple(HeadlessRenderer& headless);

}  // namespace limn
