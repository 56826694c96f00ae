#pragma once

#include "content/app/quality.h"

namespace limn {

/// A floor under hundreds of lamps by every LightMethod, and the clusters' lists of random lights.
[[nodiscard]] Result<QualityReport> measure_lights_quality(HeadlessRenderer& headless);

}  // namespace limn
