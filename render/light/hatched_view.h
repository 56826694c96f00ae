#pragma once

namespace limn {

/// Published in views with hatching (hatching_pass.h): the G-buffer pass stores the strokes.
struct HatchedView {};

}  // namespace limn
