#pragma once

#include "bench/quality/quality.h"

namespace limn {

/// The part of `limn quality wrinkles` for wrinkles of compressed skin: the length of isometric
/// folds, the error table of normals lifted to the sphere, Oat's compositing, and the compression
/// of a crowd.
[[nodiscard]] Status measure_wrinkle_methods(HeadlessRenderer& headless, QualityReport& report);

}  // namespace limn
