#pragma once

#include "content/app/quality_scene.h"

namespace limn {

/// The corner of a court: columns before a wall with a pointed gate at x = -0.6, z = -2.6, a ball
/// in a ring on a block, a railing of thin bars. All of it is closed, so that it can cast volumes,
/// and all of it casts. No lights.
void furnish_court(QualityScene& scene);

/// Of all that.
[[nodiscard]] RenderView court_view(int width, int height);

}  // namespace limn
