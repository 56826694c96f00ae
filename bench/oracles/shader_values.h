#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/device.h"

#include <span>
#include <string>
#include <vector>

namespace limn::oracle {

/// Evaluates GLSL code: `body` runs once for each of `inputs`, which is in the vec4 `x`, and writes
/// its result to the vec4 `y`. `before` precedes it: includes and functions. Fails with the
/// compiler's message.
[[nodiscard]] Result<std::vector<Vec4>> evaluate_shader(
    gpu::Device& device, const std::string& before, const std::string& body,
    std::span<const Vec4> inputs);

}  // namespace limn::oracle
