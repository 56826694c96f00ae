#include "ecs/components/beam.h"

#include "ecs/base/hash.h"

#include <algorithm>
#include <cmath>

namespace limn {

void make_bolt(
    const Vec3& start, const Vec3& end, float jag, std::uint32_t detail, Random& random,
    std::vector<Vec3>& points) {
    const std::size_t pieces = std::size_t{1} << std::min(detail, 16u);
    const Vec3 span = end - start;
    const float length = glm::length(span);
    const Vec3 right = any_perpendicular(normalize_or(span, Vec3(0, 1, 0)));
    const Vec3 up = glm::cross(normalize_or(span, Vec3(0, 1, 0)), right);
    points.assign(pieces + 1, start);
    points.back() = end;
    float radius = 0.5f * jag * length;  // halves with the pieces: at most twice that in all
    for (std::size_t half = pieces / 2; half > 0; half /= 2, radius *= 0.5f) {
        for (std::size_t i = half; i < pieces; i += 2 * half) {
            const float angle = random.uniform(0, 2 * kPi);
            const float by = radius * std::sqrt(random.uniform());
            points[i] = 0.5f * (points[i - half] + points[i + half])
                        + by * (std::cos(angle) * right + std::sin(angle) * up);
        }
    }
}

Random beam_random(const Beam& beam, Entity entity, double time) {
    const double shape = std::floor(std::max(time, 0.0) * static_cast<double>(beam.rate));
    return {
        beam.seed != 0 ? beam.seed : entity.bits(), 0, name_hash("beam shapes"),
        static_cast<std::uint64_t>(shape)};
}

}  // namespace limn
