#include "ecs/components/particles.h"

#include <algorithm>
#include <iterator>

namespace limn {
namespace {

/// Straight between the keys around `at`, which is 0 .. 1.
template <typename Key, typename Value>
auto sample_keys(const std::vector<Key>& keys, float at, Value&& value) {
    std::vector<Key> sorted = keys;
    std::stable_sort(
        sorted.begin(), sorted.end(), [](const Key& a, const Key& b) { return a.at < b.at; });
    const auto next =
        std::find_if(sorted.begin(), sorted.end(), [at](const Key& key) { return key.at > at; });
    if (next == sorted.begin()) {
        return value(*next);
    }
    const Key& last = *std::prev(next);
    if (next == sorted.end()) {
        return value(last);
    }
    const float t = (at - last.at) / (next->at - last.at);
    return value(last) + (value(*next) - value(last)) * t;
}

}  // namespace

float sample_curve(const std::vector<CurveKey>& keys, float at) {
    return keys.empty() ? 1.0f
                        : sample_keys(keys, at, [](const CurveKey& key) { return key.value; });
}

Vec4 sample_colors(const std::vector<ColorKey>& keys, float at) {
    return keys.empty() ? Vec4(1) : sample_keys(keys, at, [](const ColorKey& key) {
        return Vec4(key.color, key.opacity);
    });
}

}  // namespace limn
