#include "systems/animation/clip_jumps.h"

#include "ecs/components/step_jumps.h"
#include "systems/animation/clip_sampling.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kSameValue = 1e-4f;      // smaller relative differences are no jump
constexpr float kSameCosine = 1e-6f;     // 1 - |cos(angle / 2)| of rotations: 0.16 degrees
constexpr float kInstantaneous = 1e-3f;  // a segment shorter than this, in steps, is a jump

bool differ(float a, float b) {
    return std::abs(a - b) > kSameValue;
}
bool differ(const Vec3& a, const Vec3& b) {
    return glm::distance(a, b) > kSameValue * std::max(glm::length(a), glm::length(b));
}
bool differ(const Quat& a, const Quat& b) {
    return std::abs(glm::dot(glm::normalize(a), glm::normalize(b))) < 1.0f - kSameCosine;
}

/// A jump from one row of keys to another at a time within the step.
struct RowJump {
    float at = kNoJump;
    std::size_t from = 0;
    std::size_t to = 0;
};

/// The key whose value a sheet with step interpolation holds at `time`.
std::size_t step_row(const ClipSheet& sheet, float time) {
    const KeyInterval interval = find_keys(sheet.times, time);
    return std::min(
        interval.u < 1.0f ? interval.first : interval.first + 1, sheet.times.size() - 1);
}

/// A step in time as it is played: forward, or backward.
class PlayedStep {
  public:
    PlayedStep(const ClipStep& step, float duration)
        : step_(step), start_(clip_time(duration, step.from, step.loops)),
          wraps_(step.loops && (step.from < 0.0f || step.from > duration)),
          boundary_(step.from < 0.0f ? 0.0f : duration) {}

    /// Its start within the clip [s].
    [[nodiscard]] float start() const { return start_; }
    [[nodiscard]] bool is_forward() const { return step_.to > step_.from; }
    [[nodiscard]] bool wraps() const { return wraps_; }
    [[nodiscard]] float length() const { return std::abs(step_.to - step_.from); }
    /// Fraction of the step at which the clip is at `time`, after the last wrap.
    [[nodiscard]] float fraction_at(float time) const {
        const float first = wraps_ ? fraction_of(boundary_) : 0.0f;
        return std::clamp(fraction_of(time), first, 1.0f);
    }
    [[nodiscard]] float wrap_fraction() const {
        return std::clamp(fraction_of(boundary_), 0.0f, 1.0f);
    }

  private:
    [[nodiscard]] float fraction_of(float time) const {
        return (time - step_.from) / (step_.to - step_.from);
    }

    const ClipStep& step_;
    float start_;
    bool wraps_;
    float boundary_;  // end of the loop, in the time of `from` [s]
};

RowJump step_key_jump(const ClipSheet& sheet, const PlayedStep& step, float end) {
    const std::size_t from = step_row(sheet, step.start());
    const std::size_t to = step_row(sheet, end);
    if (from == to) {
        return {};
    }
    // Backward, the value of a key ends where the next one begins.
    const std::size_t crossed = step.is_forward() ? to : std::min(to + 1, sheet.times.size() - 1);
    return {step.fraction_at(sheet.times[crossed]), from, to};
}

/// The last instantaneous segment between `from` and `to` [s], in ascending order.
RowJump instantaneous_jump(const ClipSheet& sheet, const PlayedStep& step, float from, float to) {
    RowJump jump;
    const auto first = std::ranges::upper_bound(sheet.times, from) - sheet.times.begin();
    for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(first, 1));
         i < sheet.times.size() && sheet.times[i - 1] < to; ++i) {
        if (sheet.times[i] - sheet.times[i - 1] < kInstantaneous * step.length()) {
            jump = {step.fraction_at(sheet.times[i]), i - 1, i};
        }
    }
    return jump;
}

RowJump sheet_jump(const ClipSheet& sheet, const PlayedStep& step, float end) {
    if (sheet.interpolation == Interpolation::Step) {
        return step_key_jump(sheet, step, end);
    }
    if (step.wraps()) {
        const std::size_t last = sheet.times.size() - 1;
        return {step.wrap_fraction(), step.is_forward() ? last : 0, step.is_forward() ? 0 : last};
    }
    return instantaneous_jump(
        sheet, step, std::min(step.start(), end), std::max(step.start(), end));
}

bool can_jump(const ClipData& clip, const ClipStep& step) {
    return std::isfinite(step.from) && step.from != step.to && clip.duration > 0.0f;
}

/// Lowers the jump times of subjects whose values differ between the two rows.
template <typename T>
void mark_changes(
    const ClipSheet& sheet, const std::vector<std::uint16_t>& subjects,
    const std::vector<T>& values, const RowJump& jump, std::span<float> times) {
    // A row of cubic keys has in-tangents, values and out-tangents.
    const std::size_t count = subjects.size();
    const bool is_cubic = sheet.interpolation == Interpolation::Cubic;
    const std::size_t width = is_cubic ? 3 * count : count;
    const std::size_t value = is_cubic ? count : 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (differ(values[jump.from * width + value + i], values[jump.to * width + value + i])) {
            times[subjects[i]] = std::min(times[subjects[i]], jump.at);
        }
    }
}

}  // namespace

bool may_jump(const ClipData& clip, const ClipStep& step) {
    if (!can_jump(clip, step)) {
        return false;
    }
    const PlayedStep played(step, clip.duration);
    return std::ranges::any_of(clip.sheets, [&](const ClipSheet& sheet) {
        return sheet_jump(sheet, played, step.to).at != kNoJump;
    });
}

void find_clip_jumps(
    const ClipData& clip, const ClipStep& step, std::span<float> joints, std::span<float> weights) {
    if (!can_jump(clip, step)) {
        return;
    }
    const PlayedStep played(step, clip.duration);
    for (const ClipSheet& sheet : clip.sheets) {
        const RowJump jump = sheet_jump(sheet, played, step.to);
        if (jump.at == kNoJump) {
            continue;
        }
        if (!joints.empty()) {
            mark_changes(sheet, sheet.rotating, sheet.rotations, jump, joints);
            mark_changes(sheet, sheet.translating, sheet.translations, jump, joints);
            mark_changes(sheet, sheet.scaling, sheet.scales, jump, joints);
        }
        mark_changes(sheet, sheet.morphing, sheet.weights, jump, weights);
    }
}

void apply_joint_jumps(const SkeletonData& skeleton, std::span<float> at, Pose& pose) {
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (skeleton.parents[i] >= 0) {
            at[i] = std::min(at[i], at[static_cast<std::size_t>(skeleton.parents[i])]);
        }
        if (at[i] != kNoJump) {
            pose.jumps.push_back({static_cast<std::uint16_t>(i), at[i], pose.previous[i]});
            pose.previous[i] = pose.joints[i];
        }
    }
}

void apply_weight_jumps(std::span<const float> at, MorphWeights& morph) {
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (at[i] != kNoJump) {
            morph.jumps.push_back({static_cast<std::uint16_t>(i), at[i], morph.previous[i]});
            morph.previous[i] = morph.weights[i];
        }
    }
}

float first_jump(const Pose* pose, const MorphWeights* morph) {
    float first = kNoJump;
    const auto lower = [&first](const auto& jumps) {
        for (const auto& jump : jumps) {
            first = std::min(first, jump.at);
        }
    };
    if (pose != nullptr) {
        lower(pose->jumps);
    }
    if (morph != nullptr) {
        lower(morph->jumps);
    }
    return first;
}

}  // namespace limn
