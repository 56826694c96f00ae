#include "content/speech/coarticulation.h"

#include <cmath>
#include <limits>

// Techniques: face.dominance

namespace limn {

float blend_targets(std::span<const DominanceTarget> targets, float time, float rest) {
    double sum = 0.0;
    double weight = 0.0;
    for (const DominanceTarget& target : targets) {
        const double distance = double{time} - double{target.center};
        const double theta = distance < 0.0 ? target.before : target.after;
        const double dominance =
            target.strength * std::exp(-theta * std::pow(std::abs(distance), target.power));
        sum += dominance * target.target;
        weight += dominance;
    }
    return weight > std::numeric_limits<double>::min() ? static_cast<float>(sum / weight) : rest;
}

}  // namespace limn
