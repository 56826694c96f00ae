#include "render/frame_clock.h"

#include "render/render_view.h"

namespace limn {
namespace {

constexpr double kMaxFrameGap = 1.0;  // [s] between two frames

}  // namespace

std::optional<float>
seconds_since_last(FrameClock& clock, std::uint64_t world, double time, const Affine& camera) {
    const double seconds = time - clock.time;
    const bool cut = !clock.running || clock.world != world || seconds < 0.0
                     || seconds > kMaxFrameGap || is_cut(clock.camera, camera);
    clock = {true, world, time, camera};
    return cut ? std::nullopt : std::optional(static_cast<float>(seconds));
}

}  // namespace limn
