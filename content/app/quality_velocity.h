#pragma once

#include "content/app/quality.h"

namespace limn {

/// Motion over the picture beside rays in double precision.
[[nodiscard]] Result<QualityReport> measure_velocity(HeadlessRenderer& headless);

}  // namespace limn
