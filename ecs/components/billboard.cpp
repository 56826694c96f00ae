#include "ecs/components/billboard.h"

#include <algorithm>
#include <cmath>

namespace limn {

std::uint32_t billboard_frame(float frame_rate, std::uint32_t count, double time) {
    const double frame = std::floor(time * static_cast<double>(frame_rate) + 1e-6);
    if (!(frame > 0) || !std::isfinite(frame) || count == 0) {
        return 0;
    }
    return static_cast<std::uint32_t>(std::fmod(frame, count));
}

std::optional<double>
billboard_life(const Billboard& billboard, float frame_rate, std::uint32_t count) {
    if (billboard.loop || !(frame_rate > 0)) {
        return std::nullopt;
    }
    return static_cast<double>(std::max(count, 1u)) / static_cast<double>(frame_rate);
}

}  // namespace limn
