#include "systems/animation/clip_sampling.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"
#include "systems/animation/pose_kernels.h"

#include <algorithm>
#include <cmath>

// Techniques: anim.key-lookup, anim.lerp, anim.mocap-keys, char.local-global, char.morph-anim,
//     char.pose-eval

namespace limn {

namespace {

/// Weights of the keys on both sides and their tangents in a Hermite curve.
struct Hermite {
    float from;
    float slope_from;
    float to;
    float slope_to;

    Hermite(float u, float seconds) {
        const float u2 = u * u;
        const float u3 = u2 * u;
        from = 2.0f * u3 - 3.0f * u2 + 1.0f;
        slope_from = (u3 - 2.0f * u2 + u) * seconds;
        to = 3.0f * u2 - 2.0f * u3;
        slope_to = (u3 - u2) * seconds;
    }
    template <typename T>
    [[nodiscard]] T blend(const T* first, const T* second, std::size_t joints) const {
        return from * first[joints] + slope_from * first[2 * joints] + to * second[joints]
               + slope_to * second[0];
    }
};

/// The two rows of a sheet around a time.
class SheetRows {
  public:
    SheetRows(const ClipSheet& sheet, float time)
        : sheet_(sheet), interval_(find_keys(sheet.times, time)),
          second_(std::min(interval_.first + 1, sheet.times.size() - 1)) {
        if (sheet.interpolation == Interpolation::Step) {
            interval_.first = interval_.u < 1.0f ? interval_.first : second_;
            second_ = interval_.first;
            interval_.u = 0.0f;
        }
    }

    /// Calls put(i, value) for each of the row's `count` values.
    template <typename T, typename Put>
    void each_value(const std::vector<T>& values, std::size_t count, Put&& put) const {
        const bool is_cubic = sheet_.interpolation == Interpolation::Cubic;
        const std::size_t width = is_cubic ? 3 * count : count;
        const T* first = values.data() + interval_.first * width;
        const T* second = values.data() + second_ * width;
        if (is_cubic) {
            const Hermite hermite(
                interval_.u, sheet_.times[second_] - sheet_.times[interval_.first]);
            for (std::size_t i = 0; i < count; ++i) {
                put(i, hermite.blend(first + i, second + i, count));
            }
            return;
        }
        const float u = interval_.u;
        for (std::size_t i = 0; i < count; ++i) {
            put(i, first[i] * (1.0f - u) + second[i] * u);
        }
    }

    [[nodiscard]] float u() const { return interval_.u; }
    [[nodiscard]] std::span<const Quat> first(std::size_t count) const {
        return {sheet_.rotations.data() + interval_.first * count, count};
    }
    [[nodiscard]] std::span<const Quat> second(std::size_t count) const {
        return {sheet_.rotations.data() + second_ * count, count};
    }

  private:
    const ClipSheet& sheet_;
    KeyInterval interval_;
    std::size_t second_;
};

void sample_rotations(const ClipSheet& sheet, const SheetRows& rows, std::span<Quat> rotations) {
    const std::size_t count = sheet.rotating.size();
    if (sheet.interpolation == Interpolation::Cubic) {
        rows.each_value(sheet.rotations, count, [&](std::size_t i, const Quat& q) {
            rotations[sheet.rotating[i]] = normalize_or_identity(q);
        });
        return;
    }
    // In batches on the stack, then scattered to the joints.
    constexpr std::size_t kBatch = 64;
    Quat blended[kBatch];
    for (std::size_t begin = 0; begin < count; begin += kBatch) {
        const std::size_t size = std::min(kBatch, count - begin);
        slerp_rotations(
            rows.first(count).subspan(begin, size), rows.second(count).subspan(begin, size),
            rows.u(), {blended, size});
        for (std::size_t i = 0; i < size; ++i) {
            rotations[sheet.rotating[begin + i]] = blended[i];
        }
    }
}

}  // namespace

KeyInterval find_keys(std::span<const float> times, float t) {
    if (times.size() < 2 || !(t > times.front())) {
        return {};
    }
    if (t >= times.back()) {
        return {times.size() - 2, 1.0f};
    }
    const auto after = std::upper_bound(times.begin(), times.end(), t);
    const auto first = after - 1;
    return {
        static_cast<std::size_t>(first - times.begin()),
        std::min((t - *first) / (*after - *first), 1.0f)};
}

float clip_time(float duration, float time, bool loops) {
    if (!std::isfinite(time) || !(duration > 0.0f)) {
        return 0.0f;
    }
    if (!loops) {
        return std::clamp(time, 0.0f, duration);
    }
    const float rest = std::fmod(time, duration);
    return rest < 0.0f ? rest + duration : rest;
}

void sample_clip(const ClipData& clip, float time, LocalPose& pose, std::span<float> weights) {
    for (const ClipSheet& sheet : clip.sheets) {
        const SheetRows rows(sheet, time);
        sample_rotations(sheet, rows, pose.rotations);
        rows.each_value(
            sheet.translations, sheet.translating.size(), [&](std::size_t i, const Vec3& value) {
                pose.translations[sheet.translating[i]] = value;
            });
        rows.each_value(sheet.scales, sheet.scaling.size(), [&](std::size_t i, const Vec3& value) {
            pose.scales[sheet.scaling[i]] = value;
        });
    }
    sample_clip_weights(clip, time, weights);
}

void sample_clip_weights(const ClipData& clip, float time, std::span<float> weights) {
    for (const ClipSheet& sheet : clip.sheets) {
        if (sheet.morphing.empty()) {
            continue;
        }
        const SheetRows rows(sheet, time);
        rows.each_value(sheet.weights, sheet.morphing.size(), [&](std::size_t i, float value) {
            weights[sheet.morphing[i]] = value;
        });
    }
}

void add_morph_weights(const ClipData& clip, float time, float weight, std::span<float> weights) {
    for (const ClipSheet& sheet : clip.sheets) {
        if (sheet.times.size() < 2) {
            continue;
        }
        const SheetRows rows(sheet, time);
        rows.each_value(sheet.weights, sheet.morphing.size(), [&](std::size_t i, float value) {
            if (value > kMinMorphWeight) {
                weights[sheet.morphing[i]] += weight * value;
            }
        });
    }
}

void compute_joint_matrices(
    const SkeletonData& skeleton, const LocalPose& pose, std::span<Affine> matrices) {
    LIMN_CHECK(pose.size() == skeleton.parents.size() && matrices.size() == pose.size());
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        const Affine local = affine_from(pose.translations[i], pose.rotations[i], pose.scales[i]);
        const std::int32_t parent = skeleton.parents[i];
        matrices[i] = parent < 0 ? local : matrices[static_cast<std::size_t>(parent)] * local;
    }
}

}  // namespace limn
