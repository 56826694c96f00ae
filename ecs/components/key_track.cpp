#include "ecs/components/key_track.h"

#include "ecs/base/bezier.h"
#include "ecs/base/rotation.h"
#include "ecs/base/text.h"
#include "ecs/field_access.h"

#include <algorithm>
#include <cmath>

// Techniques: anim.key-track

namespace limn {
namespace {

TrackTarget find_field_of(const FieldTrack& track) {
    const std::size_t dot = track.field.find('.');
    const ComponentInfo* const info = find_component(track.field.substr(0, dot));
    if (info == nullptr || info->defaults == nullptr || dot == std::string::npos) {
        return {};
    }
    // Only its place is taken, so nothing writes to the defaults.
    void* const defaults = const_cast<void*>(info->defaults);
    const Result<FieldRef> found = field_at(*info, defaults, track.field.substr(dot + 1));
    if (!found || found->element == nullptr) {
        return {};
    }
    const std::ptrdiff_t offset =
        static_cast<const char*>(found->element) - static_cast<const char*>(defaults);
    const bool is_inside = offset >= 0 && static_cast<std::size_t>(offset) < info->size;
    return is_inside ? TrackTarget{info, found->field, static_cast<std::uint32_t>(offset)}
                     : TrackTarget{};
}

/// `time` mapped to the keys.
float wrap_time(const FieldTrack& track, double time) {
    const double begin = track.times.front();
    const double duration = static_cast<double>(track.times.back()) - begin;
    double t = time - begin;
    if (track.wrap != TrackWrap::Clamp && duration > 0) {
        const double turns = std::floor(t / duration);
        t -= turns * duration;
        if (track.wrap == TrackWrap::PingPong && std::fmod(turns, 2.0) != 0) {
            t = duration - t;
        }
    }
    return static_cast<float>(begin + std::clamp(t, 0.0, duration));
}

Quat quat_at(const float* values) {
    return normalize_or_identity(Quat(values[3], values[0], values[1], values[2]));
}

Vec4 mix_rotation(TrackMode mode, const float* from, const float* to, float u) {
    const Quat a = quat_at(from);
    const Quat b = quat_at(to);
    Quat q = slerp(a, b, u);
    if (mode == TrackMode::Squad) {
        const Quat inner_a = to_same_hemisphere(a, quat_at(from + 8));
        const Quat end = to_same_hemisphere(a, b);
        const Quat inner_b = to_same_hemisphere(end, quat_at(to + 4));
        q = squad(a, inner_a, inner_b, end, u);
    }
    return {q.x, q.y, q.z, q.w};
}

}  // namespace

std::size_t floats_per_key(FieldType type, TrackMode mode) {
    if (type == FieldType::Quat) {
        return mode == TrackMode::Squad ? 12 : mode == TrackMode::Bezier ? 0 : 4;
    }
    const bool is_smooth = type == FieldType::Float || type == FieldType::Double
                           || type == FieldType::Vec2 || type == FieldType::Vec3
                           || type == FieldType::Vec4;
    if (!is_smooth || mode == TrackMode::Slerp || mode == TrackMode::Squad) {
        return 0;
    }
    const auto numbers = static_cast<std::size_t>(number_count(type));
    return mode == TrackMode::Bezier ? 3 * numbers : numbers;
}

Result<TrackTarget> find_track_target(const FieldTrack& track) {
    const TrackTarget target = find_field_of(track);
    if (target.field == nullptr) {
        return fail("key_track: found field {}, expected component.field", track.field);
    }
    const std::size_t stride = floats_per_key(target.field->type, track.mode);
    if (stride == 0) {
        return fail(
            "key_track: {}: found a field that this mode cannot animate, expected a number, a "
            "vector (linear, bezier) or a rotation (slerp, squad)",
            track.field);
    }
    for (std::size_t i = 0; i < track.times.size(); ++i) {
        if (!std::isfinite(track.times[i]) || (i > 0 && !(track.times[i] > track.times[i - 1]))) {
            return fail(
                "key_track: {}: times: found {} s at key {}, expected more than the key before",
                track.field, track.times[i], i);
        }
    }
    if (track.values.size() != stride * track.times.size()) {
        return fail(
            "key_track: {}: found {} values, expected {} for each of {} keys", track.field,
            track.values.size(), stride, track.times.size());
    }
    for (std::size_t i = 0; i < track.values.size(); ++i) {
        if (!std::isfinite(track.values[i])) {
            return fail(
                "key_track: {}: found a value that is not finite at key {}, expected a number",
                track.field, i / stride);
        }
    }
    return target;
}

Vec4 track_value(const FieldTrack& track, FieldType type, double time) {
    const std::size_t stride = floats_per_key(type, track.mode);
    const auto numbers = static_cast<std::size_t>(number_count(type));
    const auto key_value = [&](std::size_t key) {
        Vec4 value(0);
        for (std::size_t i = 0; i < numbers; ++i) {
            value[static_cast<glm::length_t>(i)] = track.values[key * stride + i];
        }
        return value;
    };
    if (track.times.size() == 1) {
        return key_value(0);
    }
    const float now = wrap_time(track, time);
    const auto after = std::upper_bound(track.times.begin() + 1, track.times.end() - 1, now);
    const auto to = static_cast<std::size_t>(after - track.times.begin());
    const float begin = track.times[to - 1];
    const float u = std::clamp((now - begin) / (track.times[to] - begin), 0.0f, 1.0f);
    if (u == 0.0f || u == 1.0f) {
        return key_value(u == 0.0f ? to - 1 : to);
    }
    const float* const a = track.values.data() + (to - 1) * stride;
    const float* const b = track.values.data() + to * stride;
    if (type == FieldType::Quat) {
        return mix_rotation(track.mode, a, b, u);
    }
    Vec4 mixed(0);
    for (std::size_t i = 0; i < numbers; ++i) {
        mixed[static_cast<glm::length_t>(i)] =
            track.mode == TrackMode::Bezier
                ? bezier_point(Bezier<float>{a[i], a[2 * numbers + i], b[numbers + i], b[i]}, u)
                : a[i] * (1.0f - u) + b[i] * u;
    }
    return mixed;
}

}  // namespace limn
