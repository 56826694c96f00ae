#pragma once

#include "content/app/commands/command_values.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/device_caps.h"

#include <optional>
#include <string>
#include <vector>

namespace limn {

// Shown by `limn bench fakephong`: fakephong.forward-difference, fakephong.metric-efficiency
// Shown by `limn bench gallery`: engine.multi-material, shade.batching
// Shown by `limn bench lights`: engine.visibility-sets
// Shown by `limn bench museum --targets`: engine.opt-framebuffer
// Shown by `limn bench stress-instances`: engine.batching, engine.hier-bounds, shade.stream-kernel

struct BenchReport;
struct HeadlessRenderer;
struct Stage;

/// `limn bench`: times frames, systems and passes of a scene.
struct BenchOptions {
    std::string scene;
    int frames = 300;  ///< measured
    int warmup = 60;   ///< run before, not measured
    IVec2 size = {1280, 720};
    std::vector<Assignment> assignments;  ///< --set
    std::string json;         ///< file, or "-" for stdout instead of the table; empty = none
    std::string csv;          ///< the same
    std::string svg;          ///< file, of `particles` and `faces`; empty = none
    std::string only;         ///< one part of `particles`, `faces` or `characters`; empty = all
    bool targets = false;     ///< also list what passes read and write, and render targets
    bool bottleneck = false;  ///< also measure the stages of the pipeline (bottleneck.h)
    std::size_t most = 0;  ///< particles at the last point of the curves; 0 = the program's default
    std::optional<gpu::Profile> profile;  ///< empty = chosen by the device
    std::string renderer;                 ///< of render_profiles(); empty = the best
};

/// Arguments of the program that measures `particles`, `faces` or `characters`.
[[nodiscard]] std::vector<std::string> bench_program_arguments(const BenchOptions& options);

/// What `limn bench` sets in a level: levels of detail for the image's resolution, as `limn play`
/// chooses them, then what the options assign.
[[nodiscard]] std::vector<Assignment> bench_assignments(const BenchOptions& options);

/// Runs one step and renders one frame, then waits for the GPU, so that no cost spills into the
/// next frame. Adds the times to `report` unless it is null.
void run_bench_frame(
    Stage& stage, HeadlessRenderer& headless, const IVec2& size, BenchReport* report,
    bool few_triangles = false);

/// Scene, size and machine.
[[nodiscard]] BenchReport
machine_report(const Stage& stage, const HeadlessRenderer& headless, const BenchOptions& options);

/// Fails if an option does not apply to the scene.
[[nodiscard]] Status check_bench_options(const BenchOptions& options);
[[nodiscard]] Status run_bench(const BenchOptions& options);

}  // namespace limn
