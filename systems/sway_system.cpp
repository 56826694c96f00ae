#include "systems/sway_system.h"

#include "systems/motion_kernels.h"

namespace limn {

void update_sways(Query<const Sway, Transform> swaying, Res<const FrameTime> time) {
    const double now = time->time;
    swaying.par_chunks(
        [now](ChunkView, SplitSpan<const Sway> sway, std::span<Transform> transform) {
            sway_positions(
                {sway.field<&Sway::center>(), sway.field<&Sway::amplitude>(),
                 sway.field<&Sway::frequency>(), sway.field<&Sway::phase>()},
                now, transform);
        });
}

}  // namespace limn
