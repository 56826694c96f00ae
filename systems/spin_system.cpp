#include "systems/spin_system.h"

#include "systems/motion_kernels.h"

namespace limn {

void update_spins(Query<const Spin, Transform> spinning, Res<const FrameTime> time) {
    const float dt = time->step;
    if (dt == 0.0f) {
        return;
    }
    spinning.par_chunks(
        [dt](ChunkView, std::span<const Spin> spin, std::span<Transform> transform) {
            turn_rotations(spin, dt, transform);
        });
}

}  // namespace limn
