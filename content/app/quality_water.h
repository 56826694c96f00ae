#pragma once

#include "content/app/quality.h"

namespace limn {

/// Open water beside sums of all its waves, heights and speeds beside the laws; ripples that keep
/// the water; what still water mirrors.
[[nodiscard]] Result<QualityReport> measure_water(HeadlessRenderer& headless);

}  // namespace limn
