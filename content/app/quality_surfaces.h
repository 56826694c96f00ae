#pragma once

#include "content/app/quality.h"

namespace limn {

/// A plate of each reflection model under a lamp and a spot, pixel by pixel beside the oracle.
[[nodiscard]] Result<QualityReport> measure_surfaces(HeadlessRenderer& headless);

}  // namespace limn
