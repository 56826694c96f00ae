#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/device.h"

#include <span>
#include <string>
#include <vector>

namespace limn::oracle {

/// What shader code makes of numbers: `body` is run once for each of `inputs`, finds it in the vec4
/// `x` and leaves its answer in the vec4 `y`. `before` stands above it: includes and functions.
/// Fails with the compiler's message.
[[nodiscard]] Result<std::vector<Vec4>> evaluate_shader(
    gpu::Device& device, const std::string& before, const std::string& body,
    std::span<const Vec4> inputs);

}  // namespace limn::oracle
