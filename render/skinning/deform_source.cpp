#include "render/skinning/deform_source.h"

#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>

// Techniques: face.soffd

namespace limn {

DeformSource find_deform_source(
    const World& world, const Assets& assets, Entity entity, MeshId mesh, std::size_t joint_count,
    const Deformed& settings) {
    const std::string& name = assets.meshes[mesh.index].name;
    const bool alive = !settings.character.is_null() && world.alive(settings.character);
    const auto* binding = world.find<SurfaceBindingState>(entity);
    const bool follows_faces = binding != nullptr && !binding->pose.joints.empty();
    const SkinId skin_id = follows_faces ? binding->skin : settings.skin;
    DeformSource source;
    source.pose = follows_faces ? &binding->pose
                  : alive       ? world.find<Pose>(settings.character)
                                : nullptr;
    source.morphs = alive ? world.find<MorphWeights>(settings.character) : nullptr;
    source.deformers = world.find<DeformerState>(entity);
    source.surface = binding != nullptr && binding->anchors != nullptr ? binding : nullptr;
    if (joint_count == 0 && assets.meshes[mesh.index].morphs.empty() && source.deformers == nullptr
        && source.surface == nullptr) {
        source.fault =
            fmt::format("deformed mesh {} has neither joints, morph targets nor deformers", name);
        return source;
    }
    if (source.pose == nullptr && source.morphs == nullptr && source.deformers == nullptr
        && source.surface == nullptr) {
        source.fault = fmt::format(
            "deformed mesh {}: its character {}", name,
            alive ? "has neither Pose nor MorphWeights" : "is gone");
        return source;
    }
    if (skin_id.index == kNoAsset) {
        return source;
    }
    if (skin_id.index >= assets.skins.size()) {
        source.fault = fmt::format(
            "deformed mesh {}: skin {} out of range, there are {}", name, skin_id.index,
            assets.skins.size());
        return source;
    }
    const SkinData& skin = assets.skins[skin_id.index];
    if (skin.joint_from_mesh.size() != skin.joints.size() || skin.joints.size() < joint_count) {
        source.fault = fmt::format(
            "deformed mesh {}: its weights use {} joints, but skin {} has {} and {} matrices", name,
            joint_count, skin.name, skin.joints.size(), skin.joint_from_mesh.size());
        return source;
    }
    const std::size_t joints = source.pose != nullptr ? source.pose->joints.size() : 0;
    const std::span used = std::span(skin.joints).first(joint_count);
    const auto beyond = std::ranges::find_if(used, [&](std::uint16_t j) { return j >= joints; });
    if (beyond != used.end()) {
        source.fault = fmt::format(
            "deformed mesh {}: skin {} uses joint {}, but its character's pose has {}", name,
            skin.name, *beyond, joints);
        source.wanted_joints = *std::ranges::max_element(used) + std::size_t{1};
    }
    source.skin = joint_count > 0 ? &skin : nullptr;
    return source;
}

}  // namespace limn
