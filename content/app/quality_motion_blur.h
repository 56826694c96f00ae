#pragma once

#include "content/app/quality.h"

namespace limn {

[[nodiscard]] Result<QualityReport> measure_motion_blur(HeadlessRenderer& headless);

}  // namespace limn
