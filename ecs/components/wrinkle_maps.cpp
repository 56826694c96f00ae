#include "ecs/components/wrinkle_maps.h"

#include "ecs/base/math.h"

#include <algorithm>
#include <cstddef>

// Techniques: wrinkle.maps.animation, wrinkle.maps.weights

namespace limn {
namespace {

/// One row per WrinklePreset, in the order of kWrinkleRegions: brows (left, right, middle), lips,
/// cheeks (left, right), upper cheeks (left, right), chin.
constexpr std::array<float, kWrinkleRegions.size()> kPresets[] = {
    {0, 0, 0, 0, 0, 0, 0, 0, 0},          {-1, -1, -1, -1, -1, -1, -1, -1, -1},
    {1, 1, 1, 1, 1, 1, 1, 1, 1},          {1, 1, 1, 1, 0, 0, 0, 0, 0.6f},
    {1, 1, 1, 0, 0, 0, 0.2f, 0.2f, 0.2f}, {0, 0, 0, -0.3f, 1, 1, 0.9f, 0.9f, 0},
    {0, 0, 0, 1, 0, 0, 0, 0, 1},
};

}  // namespace

std::array<float, kWrinkleRegions.size()> region_weights(const WrinkleWeights& weights) {
    const auto row = static_cast<std::size_t>(weights.preset);
    std::array<float, kWrinkleRegions.size()> found =
        row < std::size(kPresets) ? kPresets[row] : kPresets[0];
    for (std::size_t i = 0; i < found.size(); ++i) {
        const float own = finite_or(weights.*kWrinkleRegions[i], 0.0f);
        found[i] = std::clamp(found[i] + own, -1.0f, 1.0f);
    }
    return found;
}

}  // namespace limn
