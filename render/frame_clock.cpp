#include "render/frame_clock.h"

#include "render/render_view.h"

namespace limn {
namespace {

constexpr double kMaxFrameGap = 1.0;  // [s] between two frames

}  // namespace

std::optional<float> seconds_since_last(
    FrameClock& clock, std::uint64_t world, double time, const Affine& camera, bool cut) {
    const double seconds = time - clock.time;
    const bool follows = clock.running && clock.world == world && seconds >= 0.0
                         && seconds <= kMaxFrameGap && !cut && !is_cut(clock.camera, camera);
    clock = {true, world, time, camera};
    return follows ? std::optional(static_cast<float>(seconds)) : std::nullopt;
}

}  // namespace limn
