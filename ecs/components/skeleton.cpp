#include "ecs/components/skeleton.h"

#include "ecs/base/text.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.clip-layout

namespace limn {

namespace {

using limn::is_finite;
bool is_finite(float x) {
    return std::isfinite(x);
}
bool is_finite(const Quat& q) {
    return is_finite(Vec4(q.x, q.y, q.z, q.w));
}
template <typename T>
bool are_finite(const std::vector<T>& values) {
    return std::all_of(
        values.begin(), values.end(), [](const T& value) { return is_finite(value); });
}

bool has_length(const Quat& q) {
    return glm::dot(q, q) > 1e-12f;
}

/// Rotations must not be 0 to be normalized; cubic rows are exempt, since they also hold tangents.
bool are_rotations(const ClipSheet& sheet) {
    return sheet.interpolation == Interpolation::Cubic
           || std::all_of(sheet.rotations.begin(), sheet.rotations.end(), has_length);
}

/// Checks the values of `subjects`: indices of joints or morph weights, each less than `count`.
template <typename T>
Status check_rows(
    const std::string& where, const char* what, const ClipSheet& sheet,
    const std::vector<std::uint16_t>& subjects, const std::vector<T>& values, std::size_t count) {
    const std::size_t row = subjects.size() * (sheet.interpolation == Interpolation::Cubic ? 3 : 1);
    if (values.size() != sheet.times.size() * row) {
        return fail(
            "{}: {} {}, expected {} for {} keys", where, values.size(), what,
            sheet.times.size() * row, sheet.times.size());
    }
    std::vector<bool> is_named(count, false);
    for (const std::uint16_t subject : subjects) {
        if (subject >= count) {
            return fail("{}: {} of index {}, expected less than {}", where, what, subject, count);
        }
        if (is_named[subject]) {
            return fail("{}: {} of index {} twice", where, what, subject);
        }
        is_named[subject] = true;
    }
    if (!are_finite(values)) {
        return fail("{}: {} that are not finite", where, what);
    }
    return Done{};
}

bool is_valid(const JointFreedom& freedom, std::size_t joints) {
    const float length = glm::length(freedom.axis);
    return freedom.joint < joints && std::abs(length - 1) < 1e-3f && freedom.min <= freedom.middle
           && freedom.middle <= freedom.max && is_finite(freedom.min) && is_finite(freedom.max)
           && freedom.stiffness >= 0 && freedom.stiffness <= 1;
}

Status check_freedoms(const SkeletonData& skeleton) {
    std::size_t of_joint = 0;
    for (std::size_t i = 0; i < skeleton.freedoms.size(); ++i) {
        const JointFreedom& freedom = skeleton.freedoms[i];
        const bool is_next = i > 0 && freedom.joint == skeleton.freedoms[i - 1].joint;
        of_joint = is_next ? of_joint + 1 : 1;
        const bool is_sorted = i == 0 || skeleton.freedoms[i - 1].joint <= freedom.joint;
        if (!is_valid(freedom, skeleton.joints.size()) || of_joint > 3 || !is_sorted) {
            return fail(
                "skeleton {}: freedom {}, of joint {}, is invalid: expected ascending joints, at "
                "most three of each, unit axes, min <= middle <= max, stiffness 0 to 1",
                skeleton.name, i, freedom.joint);
        }
    }
    return Done{};
}

Status check_marks(const ClipData& clip, std::size_t joints) {
    float begin = 0;
    for (const ClipContact& contact : clip.contacts) {
        const bool is_inside =
            contact.begin >= begin && contact.end >= contact.begin && contact.end <= clip.duration;
        if (!is_inside || contact.joint >= joints) {
            return fail(
                "clip {}: a contact of joint {} from {} to {} s, expected a joint less than {} and "
                "ascending times within 0 to {} s",
                clip.name, contact.joint, contact.begin, contact.end, joints, clip.duration);
        }
        begin = contact.begin;
    }
    float time = 0;
    for (const ClipEvent& event : clip.events) {
        if (!(event.time >= time && event.time <= clip.duration)) {
            return fail(
                "clip {}: event {} at {} s, expected ascending times within 0 to {} s", clip.name,
                event.name, event.time, clip.duration);
        }
        time = event.time;
    }
    return Done{};
}

Status check_times(const std::string& where, const std::vector<float>& times) {
    if (times.empty()) {
        return fail("{}: no keys", where);
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i])) {
            return fail("{}: the time of key {} is not finite", where, i);
        }
        if (i > 0 && times[i] <= times[i - 1]) {
            return fail(
                "{}: key {} at {} s, expected later than {} s", where, i, times[i], times[i - 1]);
        }
    }
    return Done{};
}

}  // namespace

Status check_skeleton(const SkeletonData& skeleton) {
    const std::size_t count = skeleton.joints.size();
    const std::string& name = skeleton.name;
    if (count == 0) {
        return fail("skeleton {}: no joints", name);
    }
    if (skeleton.parents.size() != count || skeleton.rest.translations.size() != count
        || skeleton.rest.rotations.size() != count || skeleton.rest.scales.size() != count) {
        return fail("skeleton {}: arrays of different lengths for {} joints", name, count);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t parent = skeleton.parents[i];
        if (i == 0 ? parent != -1 : parent < 0 || static_cast<std::size_t>(parent) >= i) {
            return fail(
                "skeleton {}: joint {} ({}) has the parent {}, expected {}", name, i,
                skeleton.joints[i], parent, i == 0 ? "-1, it is the root" : "an earlier joint");
        }
        if (!is_finite(skeleton.rest.translations[i]) || !is_finite(skeleton.rest.rotations[i])
            || !is_finite(skeleton.rest.scales[i]) || !has_length(skeleton.rest.rotations[i])) {
            return fail(
                "skeleton {}: joint {} ({}) has an invalid rest transform", name, i,
                skeleton.joints[i]);
        }
    }
    return check_freedoms(skeleton);
}

Status check_clip(const ClipData& clip, std::size_t joints, std::size_t morphs) {
    for (std::size_t i = 0; i < clip.sheets.size(); ++i) {
        const ClipSheet& sheet = clip.sheets[i];
        const std::string where = format_text("clip {}, sheet {}", clip.name, i);
        if (Status status = check_times(where, sheet.times); !status) {
            return status;
        }
        for (Status status :
             {check_rows(where, "rotations", sheet, sheet.rotating, sheet.rotations, joints),
              check_rows(
                  where, "translations", sheet, sheet.translating, sheet.translations, joints),
              check_rows(where, "scales", sheet, sheet.scaling, sheet.scales, joints),
              check_rows(where, "weights", sheet, sheet.morphing, sheet.weights, morphs)}) {
            if (!status) {
                return status;
            }
        }
        if (!are_rotations(sheet)) {
            return fail("{}: a rotation of length 0", where);
        }
    }
    return check_marks(clip, joints);
}

Status check_skin(const SkinData& skin, std::size_t joints) {
    if (skin.joints.empty() || skin.joints.size() != skin.joint_from_mesh.size()) {
        return fail(
            "skin {}: {} matrices for {} joints, expected one each", skin.name,
            skin.joint_from_mesh.size(), skin.joints.size());
    }
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        if (skin.joints[i] >= joints) {
            return fail(
                "skin {}: joint {}, expected less than {}", skin.name, skin.joints[i], joints);
        }
        const float volume = glm::determinant(Mat3(to_mat4(skin.joint_from_mesh[i])));
        const Vec4* row = skin.joint_from_mesh[i].row;
        const bool has_finite_origin = std::isfinite(row[0].w + row[1].w + row[2].w);
        if (!std::isfinite(volume) || !has_finite_origin || std::abs(volume) < 1e-24f) {
            return fail("skin {}: the matrix of joint {} has no inverse", skin.name, i);
        }
    }
    return Done{};
}

std::size_t used_joints(const SkinWeights& weights) {
    const auto last = std::max_element(weights.joints.begin(), weights.joints.end());
    return last != weights.joints.end() ? *last + 1u : 0u;
}

std::size_t clip_size(const ClipData& clip) {
    std::size_t size = 0;
    for (const ClipSheet& sheet : clip.sheets) {
        size += sheet.times.size() + 4 * sheet.rotations.size() + 3 * sheet.translations.size()
                + 3 * sheet.scales.size() + sheet.weights.size();
    }
    return size;
}

}  // namespace limn
