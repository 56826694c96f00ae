#pragma once

#include <cmath>
#include <type_traits>

namespace limn {

// Functions of a point, templated on the number type, evaluate one point (float) or four at
// once (Four), with the same operations and identical bits.

/// A number of each of four points.
using Four = float __attribute__((vector_size(16)));

/// The coordinates of one point or of four.
template <typename Number>
struct PointOf {
    Number x, y, z;
};

[[nodiscard]] inline float smaller_of(float a, float b) {
    return b < a ? b : a;
}
[[nodiscard]] inline Four smaller_of(const Four& a, const Four& b) {
    return b < a ? b : a;
}
[[nodiscard]] inline float larger_of(float a, float b) {
    return a < b ? b : a;
}
[[nodiscard]] inline Four larger_of(const Four& a, const Four& b) {
    return a < b ? b : a;
}

template <typename Function>
[[nodiscard]] float map_each(float a, Function&& function) {
    return function(a);
}
/// `function` of each of the four.
template <typename Function>
[[nodiscard]] Four map_each(const Four& a, Function&& function) {
    return Four{function(a[0]), function(a[1]), function(a[2]), function(a[3])};
}

template <typename Number>
[[nodiscard]] Number root_of(const Number& a) {
    return map_each(a, [](float one) { return std::sqrt(one); });
}
template <typename Number>
[[nodiscard]] Number absolute(const Number& a) {
    return map_each(a, [](float one) { return std::abs(one); });
}

/// `value` for each point.
template <typename Number>
[[nodiscard]] Number same_for_all(float value) {
    return Number{} + value;
}

/// Within 0 .. 1.
template <typename Number>
[[nodiscard]] Number saturated(const Number& a) {
    return smaller_of(larger_of(a, same_for_all<Number>(0)), same_for_all<Number>(1));
}

/// `conditions`: a comparison of two Numbers.
template <typename Conditions>
[[nodiscard]] bool any_of(const Conditions& conditions) {
    if constexpr (std::is_integral_v<Conditions>) {
        return conditions != 0;
    } else {
        return (conditions[0] | conditions[1] | conditions[2] | conditions[3]) != 0;
    }
}

}  // namespace limn
