#include "render/skinning/skin_palette.h"

#include "ecs/base/rotation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

// Techniques: char.skin-bone-offset, char.skin-vertex-offset

namespace limn {
namespace {

Mat3 linear_part(const Affine& a) {
    return glm::transpose(Mat3(Vec3(a.row[0]), Vec3(a.row[1]), Vec3(a.row[2])));
}

Vec3 translation_of(const Affine& a) {
    return {a.row[0].w, a.row[1].w, a.row[2].w};
}

Quat rotation_of(const Affine& a) {
    return extract_rotation(linear_part(a)).value_or(Quat(1, 0, 0, 0));
}

template <typename T>
bool shows_before(const std::vector<ValueJump<T>>& jumps, std::size_t index, const StepTime& time) {
    const ValueJump<T>* const jump = jumps.empty() ? nullptr : find_jump(jumps, index);
    return jump != nullptr && time.is_before(jump->at);
}

}  // namespace

void make_joint_palette(
    const SkinData* skin, const Pose* pose, const StepTime& time, std::vector<Affine>& palette,
    std::size_t joints) {
    palette.clear();
    if (skin == nullptr || pose == nullptr) {
        return;
    }
    const bool moves = time.alpha != 1.0f && pose->previous.size() == pose->joints.size();
    const std::size_t count = std::min(joints, skin->joints.size());
    palette.reserve(count);
    for (const std::uint16_t j : std::span(skin->joints).first(count)) {
        palette.push_back(
            shows_before(pose->jumps, j, time) ? find_jump(pose->jumps, j)->before
            : moves ? mix_affine(pose->previous[j], pose->joints[j], time.alpha)
                    : pose->joints[j]);
    }
}

void make_palette(
    const SkinData* skin, const Pose* pose, Skinning skinning, const StepTime& time,
    std::vector<Affine>& palette, std::size_t joints) {
    make_joint_palette(skin, pose, time, palette, joints);
    for (std::size_t i = 0; i < palette.size(); ++i) {
        const Affine posed = palette[i] * skin->joint_from_mesh[i];
        palette[i] = skinning == Skinning::Linear
                         ? posed
                         : affine_from(translation_of(posed), rotation_of(posed), Vec3(1));
    }
}

void make_morph_weights(
    const MorphWeights* morphs, std::size_t first, std::size_t count, const StepTime& time,
    std::vector<float>& weights) {
    weights.assign(count, 0.0f);
    if (morphs == nullptr) {
        return;
    }
    const bool moves = time.alpha != 1.0f && morphs->previous.size() == morphs->weights.size();
    for (std::size_t i = 0; i < count && first + i < morphs->weights.size(); ++i) {
        const float now = morphs->weights[first + i];
        const float before = moves ? morphs->previous[first + i] : now;
        const float mixed = shows_before(morphs->jumps, first + i, time)
                                ? find_jump(morphs->jumps, first + i)->before
                            : moves ? before + time.alpha * (now - before)
                                    : now;
        weights[i] = std::isfinite(mixed) ? mixed : 0.0f;
    }
}

void append_texels(
    const std::vector<Affine>& palette, Skinning skinning, std::vector<Vec4>& texels) {
    for (const Affine& joint : palette) {
        if (skinning == Skinning::Linear) {
            texels.insert(texels.end(), {joint.row[0], joint.row[1], joint.row[2]});
            continue;
        }
        const Quat rotation = rotation_of(joint);
        const Quat dual = 0.5f * (Quat(0, translation_of(joint)) * rotation);
        texels.emplace_back(rotation.x, rotation.y, rotation.z, rotation.w);
        texels.emplace_back(dual.x, dual.y, dual.z, dual.w);
    }
}

}  // namespace limn
