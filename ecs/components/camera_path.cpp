#include "ecs/components/camera_path.h"

#include "ecs/base/rotation.h"

#include <algorithm>
#include <cmath>

// Techniques: anim.camera-upright

namespace limn {

namespace {

constexpr float kStill = 1e-6f;  // keys nearer than this are at one position [m]

/// Four points of the spline and the segment between the inner two.
struct Segment {
    Vec3 before;
    Vec3 from;
    Vec3 to;
    Vec3 after;
};

/// One cubic segment in Hermite form.
struct Curve {
    Vec3 from;
    Vec3 to;
    Vec3 velocity_from;  ///< dp/du at u = 0
    Vec3 velocity_to;    ///< dp/du at u = 1
};

Vec3 position_on(const Curve& c, float u) {
    const float u2 = u * u;
    const float u3 = u2 * u;
    return (2.0f * u3 - 3.0f * u2 + 1.0f) * c.from + (u3 - 2.0f * u2 + u) * c.velocity_from
           + (3.0f * u2 - 2.0f * u3) * c.to + (u3 - u2) * c.velocity_to;
}

Vec3 velocity_on(const Curve& c, float u) {
    const float u2 = u * u;
    return (6.0f * u2 - 6.0f * u) * (c.from - c.to)
           + (3.0f * u2 - 4.0f * u + 1.0f) * c.velocity_from
           + (3.0f * u2 - 2.0f * u) * c.velocity_to;
}

/// The segment's cubic with centripetal knots: knot spacing is the square root of the distance.
Curve centripetal(const Segment& s) {
    const float mid = std::sqrt(glm::length(s.to - s.from));
    if (mid < kStill) {
        return {s.from, s.from, Vec3(0), Vec3(0)};
    }
    // A neighbor at the same position gives no direction: the curve starts straight.
    const auto knot = [mid](const Vec3& a, const Vec3& b) {
        const float d = std::sqrt(glm::length(b - a));
        return d < kStill ? mid : d;
    };
    const float first = knot(s.before, s.from);
    const float last = knot(s.to, s.after);
    const Vec3 before = glm::length(s.from - s.before) < kStill ? 2.0f * s.from - s.to : s.before;
    const Vec3 after = glm::length(s.after - s.to) < kStill ? 2.0f * s.to - s.from : s.after;
    const Vec3 between = (s.to - s.from) / mid;
    Curve c{s.from, s.to, {}, {}};
    c.velocity_from = mid * ((s.from - before) / first - (s.to - before) / (first + mid) + between);
    c.velocity_to = mid * (between - (after - s.from) / (mid + last) + (after - s.to) / last);
    return c;
}

/// Arc length up to `u`, by five-point Gauss-Legendre quadrature on each of four parts.
float length_until(const Curve& c, float u) {
    constexpr float kPoints[] = {
        0.0f, 0.5384693101f, -0.5384693101f, 0.9061798459f, -0.9061798459f};
    constexpr float kWeights[] = {
        0.5688888889f, 0.4786286705f, 0.4786286705f, 0.2369268851f, 0.2369268851f};
    constexpr int kParts = 4;
    const float half = 0.5f * u / static_cast<float>(kParts);
    float length = 0.0f;
    for (int part = 0; part < kParts; ++part) {
        const float mid = half * static_cast<float>(2 * part + 1);
        for (int i = 0; i < 5; ++i) {
            length += kWeights[i] * half * glm::length(velocity_on(c, mid + half * kPoints[i]));
        }
    }
    return length;
}

/// The u at a fraction of the arc length: bisection, then Newton's method.
float parameter_at(const Curve& c, float fraction) {
    const float target = std::clamp(fraction, 0.0f, 1.0f) * length_until(c, 1.0f);
    float low = 0.0f;
    float high = 1.0f;
    for (int i = 0; i < 6; ++i) {
        const float mid = 0.5f * (low + high);
        (length_until(c, mid) < target ? low : high) = mid;
    }
    float u = 0.5f * (low + high);
    for (int i = 0; i < 3; ++i) {
        const float speed = glm::length(velocity_on(c, u));
        if (speed < kStill) {
            break;
        }
        u = std::clamp(u - (length_until(c, u) - target) / speed, low, high);
    }
    return u;
}

/// Cubic through (0, a) and (1, b) with these slopes.
template <typename T>
T hermite(const T& a, const T& b, const T& slope_a, const T& slope_b, float u) {
    const float u2 = u * u;
    const float u3 = u2 * u;
    return (2.0f * u3 - 3.0f * u2 + 1.0f) * a + (u3 - 2.0f * u2 + u) * slope_a
           + (3.0f * u2 - 2.0f * u3) * b + (u3 - u2) * slope_b;
}

/// Slope between two segments with these mean speeds that keeps the cubics monotone.
float monotone_slope(float before, float after) {
    return before > 0.0f && after > 0.0f ? 2.0f * before * after / (before + after) : 0.0f;
}

/// The keys around a time. A loop wraps at its ends; otherwise the end keys are repeated.
class KeyWindow {
  public:
    KeyWindow(const CameraPath& path, double time) : path_(path) {
        const std::vector<CameraKey>& keys = path.keys;
        const double first = keys.front().time;
        const double duration = camera_duration(path);
        double t = time - first;
        if (path.loop && duration > 0.0) {
            t -= std::floor(t / duration) * duration;
        }
        t = std::clamp(t, 0.0, duration) + first;
        const auto next = std::find_if(keys.begin() + 1, keys.end() - 1, [t](const CameraKey& key) {
            return static_cast<double>(key.time) > t;
        });
        index_ = next - keys.begin() - 1;
        const double step = duration_of(index_);
        u_ = step > 0.0 ? static_cast<float>(
                 std::clamp((t - static_cast<double>(keys[index_].time)) / step, 0.0, 1.0))
                        : 1.0f;
    }

    /// Fraction of the time between from() and to(), 0 .. 1.
    [[nodiscard]] float u() const { return u_; }
    [[nodiscard]] const CameraKey& from() const { return key(index_); }
    [[nodiscard]] const CameraKey& to() const { return key(index_ + 1); }

    [[nodiscard]] Segment segment(std::ptrdiff_t offset) const {
        const std::ptrdiff_t i = index_ + offset;
        return {key(i - 1).position, key(i).position, key(i + 1).position, key(i + 2).position};
    }
    /// Seconds from key to key; 0 beyond the ends.
    [[nodiscard]] double step(std::ptrdiff_t offset) const { return duration_of(index_ + offset); }

    [[nodiscard]] const CameraKey& key_at(std::ptrdiff_t offset) const {
        return key(index_ + offset);
    }

  private:
    /// Beyond the ends: wrapped in a loop, otherwise clamped.
    [[nodiscard]] const CameraKey& key(std::ptrdiff_t i) const {
        const std::ptrdiff_t segments = static_cast<std::ptrdiff_t>(path_.keys.size()) - 1;
        if (path_.loop) {
            i = i < 0 ? i + segments : i > segments ? i - segments : i;
        }
        return path_.keys[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, segments))];
    }

    [[nodiscard]] double duration_of(std::ptrdiff_t i) const {
        const std::ptrdiff_t segments = static_cast<std::ptrdiff_t>(path_.keys.size()) - 1;
        if (path_.loop) {
            i = (i + segments) % segments;
        } else if (i < 0 || i >= segments) {
            return 0.0;
        }
        const std::size_t at = static_cast<std::size_t>(i);
        return std::max(
            static_cast<double>(path_.keys[at + 1].time) - static_cast<double>(path_.keys[at].time),
            0.0);
    }

    const CameraPath& path_;
    std::ptrdiff_t index_ = 0;
    float u_ = 0.0f;
};

Vec3 position_at(const KeyWindow& keys) {
    const Curve curve = centripetal(keys.segment(0));
    const float length = length_until(curve, 1.0f);
    const float duration = static_cast<float>(keys.step(0));
    if (length < kStill || duration <= 0.0f) {
        return keys.u() < 1.0f ? keys.from().position : keys.to().position;
    }
    const auto mean_speed = [&](std::ptrdiff_t offset) {
        const float step = static_cast<float>(keys.step(offset));
        return step > 0.0f ? length_until(centripetal(keys.segment(offset)), 1.0f) / step : 0.0f;
    };
    const float speed = length / duration;
    const float start = keys.step(-1) > 0.0 ? monotone_slope(mean_speed(-1), speed)
                                            : speed;  // along the curve, at from()
    const float end = keys.step(1) > 0.0 ? monotone_slope(speed, mean_speed(1)) : speed;
    const float fraction = hermite(0.0f, 1.0f, start / speed, end / speed, keys.u());
    return position_on(curve, parameter_at(curve, fraction));
}

/// For look_at and roll: a cubic in time through the keys, with central-difference slopes.
template <typename Member>
auto smooth_at(const KeyWindow& keys, Member CameraKey::*member) {
    const float duration = static_cast<float>(keys.step(0));
    const auto slope = [&](std::ptrdiff_t offset) {
        const float before = static_cast<float>(keys.step(offset - 1));
        const float after = static_cast<float>(keys.step(offset));
        const Member change = keys.key_at(offset + 1).*member - keys.key_at(offset - 1).*member;
        return before + after > 0.0f ? change * (duration / (before + after)) : change * 0.0f;
    };
    return hermite(keys.from().*member, keys.to().*member, slope(0), slope(1), keys.u());
}

bool have_same_pose(const CameraKey& a, const CameraKey& b) {
    return a.position == b.position && a.look_at == b.look_at && a.rotation == b.rotation
           && a.roll == b.roll;
}

}  // namespace

CameraPose camera_pose(const CameraPath& path, double time, const Vec3& target) {
    if (path.keys.empty()) {
        return {};
    }
    Vec3 position = path.keys[0].position;
    Vec3 look_at = path.keys[0].look_at;
    Quat rotation = path.keys[0].rotation;
    float roll = path.keys[0].roll;
    if (path.keys.size() > 1) {
        const KeyWindow keys(path, time);
        position = position_at(keys);
        look_at = smooth_at(keys, &CameraKey::look_at);
        roll = smooth_at(keys, &CameraKey::roll);
        rotation = slerp(keys.from().rotation, keys.to().rotation, keys.u());
    }
    switch (path.aim) {
    case CameraAim::LookAt:
        return {position, look_along(look_at - position, roll)};
    case CameraAim::Target:
        return {position, look_along(target - position, roll)};
    case CameraAim::Rotation:
        break;
    }
    const Quat level = path.upright ? upright_rotation(rotation) : rotation;
    return {position, level * glm::angleAxis(roll, Vec3(0, 0, 1))};
}

std::optional<double> camera_cut(const CameraPath& path, double from, double to) {
    const std::vector<CameraKey>& keys = path.keys;
    const double duration = camera_duration(path);
    std::optional<double> last;
    const auto add = [&](double time) {
        if (path.loop && duration > 0.0) {  // its last repetition
            time += std::max(std::floor((to - time) / duration), 0.0) * duration;
        }
        if (time > from && time <= to) {
            last = std::max(last.value_or(time), time);
        }
    };
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        if (keys[i + 1].time <= keys[i].time && !have_same_pose(keys[i], keys[i + 1])) {
            add(static_cast<double>(keys[i].time));
        }
    }
    if (path.loop && duration > 0.0 && !have_same_pose(keys.back(), keys.front())) {
        add(static_cast<double>(keys.back().time));
    }
    return last;
}

double camera_duration(const CameraPath& path) {
    return path.keys.empty() ? 0.0
                             : std::max(
                                 static_cast<double>(path.keys.back().time)
                                     - static_cast<double>(path.keys.front().time),
                                 0.0);
}

Quat look_along(const Vec3& direction, float roll) {
    const Vec3 ahead = normalize_or(direction, Vec3(0, 0, -1));
    // Looking straight up or down: as if the camera was tilted from -z.
    const bool is_vertical = std::abs(ahead.y) > 1.0f - 1e-6f;
    const Vec3 up = is_vertical ? Vec3(0, 0, ahead.y > 0.0f ? 1 : -1) : Vec3(0, 1, 0);
    const Vec3 right = glm::normalize(glm::cross(ahead, up));
    const Quat level = glm::quat_cast(Mat3(right, glm::cross(right, ahead), -ahead));
    return glm::normalize(level * glm::angleAxis(roll, Vec3(0, 0, 1)));
}

Quat upright_rotation(const Quat& rotation) {
    const Vec3 ahead = rotation * Vec3(0, 0, -1);
    if (glm::length(glm::cross(ahead, Vec3(0, 1, 0))) < 1e-4f) {
        return rotation;  // straight up or down: roll is undefined, keep it
    }
    return look_along(ahead);
}

}  // namespace limn
