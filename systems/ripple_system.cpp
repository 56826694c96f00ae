#include "systems/ripple_system.h"

#include <cmath>

// Techniques: post.scene-ripple

namespace limn {

void update_ripples(
    Query<RippleRing> rings, Query<ScreenRipple> screens, Res<const FrameTime> time,
    Commands commands) {
    const float step = time->step;
    rings.each([&](Entity entity, RippleRing& ring) {
        ring.age += step;
        if (ring.period > 0 && ring.age >= ring.period) {
            ring.age = std::fmod(ring.age, ring.period);
        }
        if (ring.period <= 0 && ring.age >= ring.duration) {
            commands.remove<RippleRing>(entity);
        }
    });
    screens.each([&](Entity entity, ScreenRipple& ripple) {
        ripple.age += step;
        if (ripple.age >= ripple.duration) {
            commands.remove<ScreenRipple>(entity);
        }
    });
}

}  // namespace limn
