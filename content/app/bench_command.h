#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn bench`: how long everything takes.
struct BenchOptions {
    std::string scene;
    int frames = 300;  ///< measured
    int warmup = 60;   ///< run before, not measured
    IVec2 size = {1280, 720};
    std::string json;  ///< file, or "-" for stdout instead of the table; empty = none
    std::string csv;   ///< the same
};

[[nodiscard]] Status run_bench(const BenchOptions& options);

}  // namespace limn
