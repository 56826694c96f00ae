#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>

namespace limn::fakephong {

// Arithmetic that counts itself. A shading method is written once, as plain formulas over Real,
// which count its operations: there is no second list of costs to keep in sync.
//
// Additions include subtractions. Comparisons, negations and copies are free.
// Techniques: fakephong.metric-efficiency

/// The work of a thread since the last reset.
struct Work {
    std::int64_t lightings = 0;  ///< evaluations of an illumination or of a light's coordinates
    std::int64_t additions = 0;
    std::int64_t multiplications = 0;
    std::int64_t divisions = 0;
    std::int64_t roots = 0;
    std::int64_t powers = 0;  ///< powers, sines, cosines and arc cosines
    std::int64_t fetches = 0;
};

[[nodiscard]] inline Work operator-(const Work& a, const Work& b) {
    return {
        a.lightings - b.lightings, a.additions - b.additions, a.multiplications - b.multiplications,
        a.divisions - b.divisions, a.roots - b.roots,         a.powers - b.powers,
        a.fetches - b.fetches};
}
inline Work& operator+=(Work& a, const Work& b) {
    a.lightings += b.lightings;
    a.additions += b.additions;
    a.multiplications += b.multiplications;
    a.divisions += b.divisions;
    a.roots += b.roots;
    a.powers += b.powers;
    a.fetches += b.fetches;
    return a;
}

/// The counters of this thread.
inline thread_local Work counted_work;

/// A double whose operations are counted.
struct Real {
    double value = 0;

    constexpr Real() = default;
    constexpr Real(double v) : value(v) {}  // NOLINT: constants appear in formulas

    friend Real operator+(Real a, Real b) {
        ++counted_work.additions;
        return a.value + b.value;
    }
    friend Real operator-(Real a, Real b) {
        ++counted_work.additions;
        return a.value - b.value;
    }
    friend Real operator*(Real a, Real b) {
        ++counted_work.multiplications;
        return a.value * b.value;
    }
    friend Real operator/(Real a, Real b) {
        ++counted_work.divisions;
        return a.value / b.value;
    }
    friend Real operator-(Real a) { return -a.value; }
    friend bool operator<(Real a, Real b) { return a.value < b.value; }
    friend bool operator>(Real a, Real b) { return a.value > b.value; }
};

[[nodiscard]] inline Real root(Real x) {
    ++counted_work.roots;
    return std::sqrt(x.value);
}
[[nodiscard]] inline Real power(Real base, Real exponent) {
    ++counted_work.powers;
    return std::pow(base.value, exponent.value);
}
[[nodiscard]] inline Real sine(Real x) {
    ++counted_work.powers;
    return std::sin(x.value);
}
[[nodiscard]] inline Real arc_cosine(Real x) {
    ++counted_work.powers;
    return std::acos(x.value);
}
[[nodiscard]] inline Real at_least_zero(Real x) {
    return x > 0.0 ? x : Real(0);  // NaN becomes 0
}
[[nodiscard]] inline Real clamp01(Real x) {
    return x > 1.0 ? Real(1) : at_least_zero(x);
}

/// Coordinates in a texture, or on a plane.
struct Vec2r {
    Real x, y;
};
[[nodiscard]] inline Vec2r operator+(Vec2r a, Vec2r b) {
    return {a.x + b.x, a.y + b.y};
}
[[nodiscard]] inline Vec2r operator-(Vec2r a, Vec2r b) {
    return {a.x - b.x, a.y - b.y};
}
[[nodiscard]] inline Vec2r operator*(Real k, Vec2r a) {
    return {k * a.x, k * a.y};
}

/// A point, a direction or a color.
struct Vec3r {
    Real x, y, z;

    Vec3r() = default;
    Vec3r(Real x_, Real y_, Real z_) : x(x_), y(y_), z(z_) {}
    explicit Vec3r(const glm::dvec3& v) : x(v.x), y(v.y), z(v.z) {}
};
[[nodiscard]] inline Vec3r operator+(Vec3r a, Vec3r b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] inline Vec3r operator-(Vec3r a, Vec3r b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Vec3r operator-(Vec3r a) {
    return {-a.x, -a.y, -a.z};
}
[[nodiscard]] inline Vec3r operator*(Real k, Vec3r a) {
    return {k * a.x, k * a.y, k * a.z};
}
[[nodiscard]] inline Real dot(Vec3r a, Vec3r b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Vec3r cross(Vec3r a, Vec3r b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// v / |v|; `otherwise` where v is zero, tiny or not finite.
[[nodiscard]] inline Vec3r normalize_or(Vec3r v, Vec3r otherwise) {
    const Real squared = dot(v, v);
    if (!(squared.value > 1e-24) || !std::isfinite(squared.value)) {
        return otherwise;
    }
    return (1.0 / root(squared)) * v;
}

[[nodiscard]] inline glm::dvec3 plain(const Vec3r& v) {
    return {v.x.value, v.y.value, v.z.value};
}

}  // namespace limn::fakephong
