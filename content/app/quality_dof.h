#pragma once

#include "content/app/quality.h"

namespace limn {

[[nodiscard]] Result<QualityReport> measure_dof(HeadlessRenderer& headless);

}  // namespace limn
