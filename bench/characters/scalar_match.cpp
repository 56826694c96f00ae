#include "bench/characters/scalar_match.h"

namespace limn::bench {

std::size_t
nearest_by_hand(const float* rows, std::size_t count, std::size_t width, const float* query) {
    std::size_t nearest = 0;
    float least = 3e38f;
    for (std::size_t i = 0; i < count; ++i) {
        const float* const row = rows + i * width;
        float sum = 0;
        for (std::size_t k = 0; k < width; ++k) {
            const float off = row[k] - query[k];
            sum += off * off;
        }
        if (sum < least) {
            least = sum;
            nearest = i;
        }
    }
    return nearest;
}

}  // namespace limn::bench
