#include "ecs/components/script.h"

#include <algorithm>
#include <cmath>

namespace limn {

std::string key_action(std::string_view key) {
    return "key " + std::string(key);
}

bool is_due(const ScriptEvent& event, std::uint64_t frame, float step) {
    const double length = static_cast<double>(step);
    const auto first = static_cast<std::uint64_t>(std::llround(event.time / length));
    if (!event.key.empty() || event.times == 0 || frame < first) {
        return false;
    }
    if (event.times == 1) {
        return frame == first;
    }
    // Rounded once, so that the number of steps between occurrences is constant.
    const auto period =
        std::max<std::uint64_t>(static_cast<std::uint64_t>(std::llround(event.every / length)), 1);
    return (frame - first) % period == 0 && (frame - first) / period < event.times;
}

}  // namespace limn
