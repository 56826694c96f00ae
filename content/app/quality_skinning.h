#pragma once

#include "content/app/quality.h"

namespace limn {

/// Vertices moved by joints and morph targets beside double precision.
[[nodiscard]] Result<QualityReport> measure_skinning(HeadlessRenderer& headless);

}  // namespace limn
