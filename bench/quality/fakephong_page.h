#pragma once

#include "bench/fakephong/fakephong_report.h"
#include "ecs/base/result.h"

#include <span>
#include <string>

namespace limn::fakephong {

/// A paragraph on a method: where it holds, where it breaks, what it costs; every number is
/// measured. `results` must not be empty.
[[nodiscard]] std::string
describe_method(const ShadingMethod& method, std::span<const SceneResult> results);

/// The thesis's chapter of results as HTML sections: Table 6.1 as printed and as measured, counted
/// work, both rankings, arcs, and for each scene and method its image, Phong's, the difference to
/// the power 1/10 and the scanline.
[[nodiscard]] Result<std::string> fakephong_html(std::span<const SceneResult> results);

}  // namespace limn::fakephong
