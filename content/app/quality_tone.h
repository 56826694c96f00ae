#pragma once

#include "content/app/quality.h"

namespace limn {

/// A court by lamplight with a bright garden behind its gate, measured and developed on the GPU and
/// in double precision.
[[nodiscard]] Result<QualityReport> measure_tone(HeadlessRenderer& headless);

}  // namespace limn
