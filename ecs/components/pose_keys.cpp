#include "ecs/components/pose_keys.h"

#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

// Techniques: anim.pose-keys, char.fk-keypose

namespace limn {
namespace {

Result<std::uint16_t> find_posed_joint(const SkeletonData& skeleton, const std::string& name) {
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    if (found == skeleton.joints.end()) {
        return fail("found no joint \"{}\" in skeleton {}", name, skeleton.name);
    }
    return static_cast<std::uint16_t>(found - skeleton.joints.begin());
}

bool is_finite_pose(const KeyedJoint& posed) {
    const Quat& q = posed.turn;
    return is_finite(posed.shift) && std::isfinite(q.x + q.y + q.z + q.w);
}

/// Turns and shifts of all joints at the keys; key k of joint j is at k * joints + j.
struct PoseTable {
    std::vector<Quat> turns;
    std::vector<Vec3> shifts;
    std::vector<bool> is_turned;  ///< by joint, at some key
    std::vector<bool> is_shifted;
};

Status
fill_key(const SkeletonData& skeleton, const PoseKey& key, std::size_t row, PoseTable& table) {
    for (const KeyedJoint& posed : key.joints) {
        const std::uint16_t joint = LIMN_TRY(find_posed_joint(skeleton, posed.joint));
        if (!is_finite_pose(posed)) {
            return fail("joint \"{}\" has numbers that are not finite", posed.joint);
        }
        const Quat turn = normalize_or_identity(posed.turn);
        table.turns[row * skeleton.joints.size() + joint] = turn;
        table.shifts[row * skeleton.joints.size() + joint] = posed.shift;
        table.is_turned[joint] = table.is_turned[joint] || turn != Quat(1, 0, 0, 0);
        table.is_shifted[joint] = table.is_shifted[joint] || posed.shift != Vec3(0);
    }
    return Done{};
}

/// Tangents of Catmull and Rom (1974) at unequal times; 0 at both ends.
template <typename T>
std::vector<T>
hermite_rows(const std::vector<T>& values, std::size_t width, const std::vector<float>& times) {
    const std::size_t keys = times.size();
    std::vector<T> rows;
    if (width == 0) {
        return rows;
    }
    for (std::size_t k = 0; k < keys; ++k) {
        std::vector<T> tangents(width, values[0] * 0.0f);
        for (std::size_t c = 0; c < width && k > 0 && k + 1 < keys; ++c) {
            tangents[c] = (values[(k + 1) * width + c] - values[(k - 1) * width + c])
                          / (times[k + 1] - times[k - 1]);
        }
        rows.insert(rows.end(), tangents.begin(), tangents.end());
        const auto row = values.begin() + static_cast<std::ptrdiff_t>(k * width);
        rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(width));
        rows.insert(rows.end(), tangents.begin(), tangents.end());
    }
    return rows;
}

ClipSheet make_sheet(
    const SkeletonData& skeleton, const PoseTable& table, std::vector<float> times, bool smooth) {
    ClipSheet sheet;
    sheet.times = std::move(times);
    const std::size_t joints = skeleton.joints.size();
    for (std::uint16_t j = 0; j < joints; ++j) {
        if (table.is_turned[j]) {
            sheet.rotating.push_back(j);
        }
        if (table.is_shifted[j]) {
            sheet.translating.push_back(j);
        }
    }
    const std::size_t width = sheet.rotating.size();
    for (std::size_t k = 0; k < sheet.times.size(); ++k) {
        for (const std::uint16_t j : sheet.rotating) {
            const Quat q = glm::normalize(skeleton.rest.rotations[j] * table.turns[k * joints + j]);
            sheet.rotations.push_back(
                k == 0 ? q
                       : to_same_hemisphere(sheet.rotations[sheet.rotations.size() - width], q));
        }
        for (const std::uint16_t j : sheet.translating) {
            sheet.translations.push_back(
                skeleton.rest.translations[j] + table.shifts[k * joints + j]);
        }
    }
    if (smooth) {
        sheet.interpolation = Interpolation::Cubic;
        sheet.rotations = hermite_rows(sheet.rotations, width, sheet.times);
        sheet.translations =
            hermite_rows(sheet.translations, sheet.translating.size(), sheet.times);
    }
    return sheet;
}

}  // namespace

Result<ClipData> make_pose_clip(const SkeletonData& skeleton, const PoseKeys& keys) {
    ClipData clip;
    clip.name = "poses";
    if (keys.keys.empty()) {
        return clip;
    }
    const std::size_t joints = skeleton.joints.size();
    PoseTable table = {
        std::vector<Quat>(keys.keys.size() * joints, Quat(1, 0, 0, 0)),
        std::vector<Vec3>(keys.keys.size() * joints, Vec3(0)), std::vector<bool>(joints, false),
        std::vector<bool>(joints, false)};
    std::vector<float> times;
    for (std::size_t k = 0; k < keys.keys.size(); ++k) {
        const float time = keys.keys[k].time;
        if (!std::isfinite(time) || time < 0 || (k > 0 && time <= times.back())) {
            return fail(
                "key {}: found time {} s, expected more than that of the key before", k, time);
        }
        if (const Status filled = fill_key(skeleton, keys.keys[k], k, table); !filled) {
            return fail("key {}: {}", k, filled.error().message);
        }
        times.push_back(time);
    }
    clip.duration = times.back();
    ClipSheet sheet = make_sheet(skeleton, table, std::move(times), keys.smooth);
    if (!sheet.rotating.empty() || !sheet.translating.empty()) {
        clip.sheets.push_back(std::move(sheet));
    }
    return clip;
}

}  // namespace limn
