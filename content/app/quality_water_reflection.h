#pragma once

#include "content/app/quality.h"

namespace limn {

struct HeadlessRenderer;

/// What still water mirrors, beside the picture of a camera mirrored in its surface: by a planar
/// reflection, and out of the picture itself where that holds what is mirrored.
void measure_water_reflections(HeadlessRenderer& headless, QualityReport& report);

}  // namespace limn
