#pragma once

#include "content/app/quality.h"

namespace limn {

/// Every shadow method of the engine, of a spot, a point light and a sun, beside rays.
[[nodiscard]] Result<QualityReport> measure_shadows(HeadlessRenderer& headless);

}  // namespace limn
