#pragma once

#include "content/app/quality.h"

namespace limn {

/// Beside ten million photons through the same waves, and by the laws of light.
[[nodiscard]] Result<QualityReport> measure_caustics(HeadlessRenderer& headless);

}  // namespace limn
