#pragma once

#include "content/app/quality.h"

namespace limn {

/// Glow beside a convolution in double precision, and what a lens may not do to light.
[[nodiscard]] Result<QualityReport> measure_glow(HeadlessRenderer& headless);

}  // namespace limn
