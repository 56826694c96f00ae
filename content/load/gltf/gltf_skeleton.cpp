#include "content/load/gltf/gltf_skeleton.h"

#include <cstddef>
#include <cstdint>
#include <utility>

// Techniques: char.skeleton-hierarchy

namespace limn {
namespace {

/// The skeleton below a first joint with this name.
SkeletonData with_scene_joint(const std::string& name, const SkeletonData& skeleton) {
    SkeletonData below = skeleton;
    below.name = name;
    below.joints.insert(below.joints.begin(), name);
    below.parents.insert(below.parents.begin(), -1);
    for (std::size_t j = 1; j < below.parents.size(); ++j) {
        ++below.parents[j];
    }
    below.rest.translations.insert(below.rest.translations.begin(), Vec3(0));
    below.rest.rotations.insert(below.rest.rotations.begin(), Quat(1, 0, 0, 0));
    below.rest.scales.insert(below.rest.scales.begin(), Vec3(1));
    for (JointFreedom& freedom : below.freedoms) {
        ++freedom.joint;
    }
    return below;
}

}  // namespace

void add_skeleton(GltfScene& scene, const std::string& name, const SkeletonData& skeleton) {
    scene.skeleton = with_scene_joint(name, skeleton);
    const SkeletonData& below = scene.skeleton;
    const auto first = static_cast<std::int32_t>(scene.nodes.size());
    for (std::size_t j = 1; j < below.joints.size(); ++j) {
        GltfNode& node = scene.nodes.emplace_back();
        node.name = below.joints[j];
        node.parent = below.parents[j] == 0 ? -1 : first + below.parents[j] - 1;
        node.transform.position = below.rest.translations[j];
        node.transform.rotation = below.rest.rotations[j];
        node.transform.scale = below.rest.scales[j];
        scene.joints.push_back(static_cast<std::int32_t>(j));
    }
}

ClipData below_scene(ClipData clip) {
    for (ClipSheet& sheet : clip.sheets) {
        for (auto* list : {&sheet.rotating, &sheet.translating, &sheet.scaling}) {
            for (std::uint16_t& joint : *list) {
                ++joint;
            }
        }
    }
    for (ClipContact& contact : clip.contacts) {
        ++contact.joint;
    }
    return clip;
}

SkinData below_scene(SkinData skin) {
    for (std::uint16_t& joint : skin.joints) {
        ++joint;
    }
    return skin;
}

}  // namespace limn
