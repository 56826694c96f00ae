#include "content/app/panels/model_panel.h"

#include "content/app/panels/hud_style.h"
#include "ecs/components/animation.h"
#include "ecs/components/name.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limn {
namespace {

/// `none`: what is shown without a clip.
std::string clip_label(const Assets& assets, ClipId clip, const char* none) {
    if (clip.index >= assets.clips.size()) {
        return none;
    }
    const ClipData& data = assets.clips[clip.index];
    return fmt::format(
        "{}  {:.2f} s", data.name.empty() ? fmt::format("clip {}", clip.index) : data.name,
        data.duration);
}

void draw_clips(World& world, Entity character) {
    ClipPlayer& player = world.get<ClipPlayer>(character);
    const Assets& assets = world.resource<Assets>();
    const char* const none = world.has<PoseKeys>(character) ? "poses by hand" : "rest pose";
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##clip", clip_label(assets, player.clip, none).c_str())) {
        for (std::uint32_t i = 0; i <= assets.clips.size(); ++i) {
            const ClipId clip = i < assets.clips.size() ? ClipId{i} : ClipId{};
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(clip_label(assets, clip, none).c_str(), clip == player.clip)) {
                player.clip = clip;
                player.time = 0;
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    if (player.clip.index >= assets.clips.size()) {
        return;
    }
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderFloat(
        "##time", &player.time, 0, assets.clips[player.clip.index].duration, "%.2f s");
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderFloat("##speed", &player.speed, -2, 2, "speed %.2f");
    ImGui::Checkbox("loop", &player.loop);
}

/// Names of the weights of `character`, from the meshes that they deform; empty if there are none.
std::vector<std::string> morph_names(const World& world, Entity character, std::size_t count) {
    const Assets& assets = world.resource<Assets>();
    std::vector<std::string> names(count);
    world.query<const MeshInstance, const Deformed>().each(
        [&](const MeshInstance& instance, const Deformed& deformed) {
            if (deformed.character != character || instance.mesh.index >= assets.meshes.size()) {
                return;
            }
            const std::vector<MorphTarget>& targets = assets.meshes[instance.mesh.index].morphs;
            for (std::size_t i = 0; i < targets.size() && deformed.first_morph + i < count; ++i) {
                names[deformed.first_morph + i] = targets[i].name;
            }
        });
    return names;
}

/// The format of a slider: name and weight.
std::string weight_format(std::string name, std::size_t i) {
    if (name.empty()) {
        name = fmt::format("target {}", i);
    }
    for (std::size_t at = 0; (at = name.find('%', at)) != std::string::npos; at += 2) {
        name.insert(at, 1, '%');
    }
    return name + ": %.2f";
}

void draw_morphs(World& world, Entity character) {
    std::vector<float>& weights = world.get<MorphWeights>(character).weights;
    const std::vector<std::string> names = morph_names(world, character, weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        ImGui::SliderFloat("##weight", &weights[i], 0, 1, weight_format(names[i], i).c_str());
        ImGui::PopID();
    }
    if (ImGui::Button("All 0")) {
        std::fill(weights.begin(), weights.end(), 0.0f);
    }
}

}  // namespace

bool ModelPanel::has_choices(const World& world, std::span<const Entity> cameras) {
    const Assets& assets = world.resource<Assets>();
    return cameras.size() > 1 || !assets.clips.empty()
           || !world.query<const MorphWeights>().empty();
}

std::optional<std::size_t> ModelPanel::take_camera() {
    return std::exchange(chosen_, std::nullopt);
}

void ModelPanel::draw(
    const HudStyle& style, World& world, std::span<const Entity> cameras, Entity camera) {
    if (!open) {
        return;
    }
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float margin = 14.0f * style.scale;
    const float width = std::min(280.0f * style.scale, 0.4f * display.x);
    ImGui::SetNextWindowPos(
        {display.x - margin, margin}, ImGuiCond_FirstUseEver, ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, display.y - 2 * margin});
    if (ImGui::Begin(
            "Model", &open, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize)) {
        std::vector<Entity> players;
        world.query<const ClipPlayer>().each(
            [&](Entity entity, const ClipPlayer&) { players.push_back(entity); });
        std::vector<Entity> faces;
        world.query<const MorphWeights>().each(
            [&](Entity entity, const MorphWeights&) { faces.push_back(entity); });
        for (const Entity player : players) {
            ImGui::PushID(static_cast<int>(player.index));
            ImGui::TextColored(kHudAccent, "Clip");
            draw_clips(world, player);
            ImGui::PopID();
        }
        for (const Entity face : faces) {
            ImGui::PushID(static_cast<int>(face.index));
            ImGui::TextColored(kHudAccent, "Morph targets");
            draw_morphs(world, face);
            ImGui::PopID();
        }
        draw_cameras(world, cameras, camera);
    }
    ImGui::End();
}

void ModelPanel::draw_cameras(const World& world, std::span<const Entity> cameras, Entity camera) {
    if (cameras.size() < 2) {
        return;
    }
    ImGui::TextColored(kHudAccent, "Camera");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const Name* const name = world.find<Name>(cameras[i]);
        const std::string label =
            name != nullptr && !name->text.empty() ? name->text : fmt::format("camera {}", i);
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::RadioButton(label.c_str(), cameras[i] == camera)) {
            chosen_ = i;
        }
        ImGui::PopID();
    }
}

}  // namespace limn
