#pragma once

#include "content/app/commands/headless.h"
#include "content/app/commands/stage.h"
#include "ecs/base/math.h"
#include "render/render_view.h"

#include <ctime>
#include <memory>

namespace limn::bench {

/// A level with its OpenGL, drawn again and again.
struct Drawing {
    std::unique_ptr<Stage> stage;
    HeadlessRenderer headless;

    /// Processor time of a frame, of all threads [ms].
    double draw(const IVec2& size) {
        const auto now = [] {
            std::timespec time{};
            clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
            return 1e3 * static_cast<double>(time.tv_sec)
                   + 1e-6 * static_cast<double>(time.tv_nsec);
        };
        const double begin = now();
        const RenderView view = make_render_view(
            stage->world, stage->scene.camera, {.width = size.x, .height = size.y});
        render_frame(*headless.renderer, stage->world, view);
        frame_graph(*headless.renderer).wait_for_timings();
        return now() - begin;
    }
};

}  // namespace limn::bench
