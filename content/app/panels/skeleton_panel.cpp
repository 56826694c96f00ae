#include "content/app/panels/skeleton_panel.h"

#include "content/app/panels/field_widgets.h"
#include "content/app/panels/furrow_panel.h"
#include "content/app/panels/hud_style.h"
#include "content/app/panels/undo.h"
#include "content/bake/motion/pose_editing.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/motion/motion_scene.h"
#include "ecs/base/rotation.h"
#include "ecs/components/animation.h"
#include "ecs/world.h"
#include "render/render_view.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

// Techniques: anim.pose-keys, char.fk-keypose, char.ghost-view

namespace limn {
namespace {

constexpr float kCurveBefore = 1.5f;  // [s]
constexpr float kCurveAfter = 1.5f;

ImVec4 panel_color(const Vec3& color) {
    return {color.x, color.y, color.z, 1};
}

/// That of its axis; other axes in their order.
ImU32 color_of_curve(const std::string& name, std::size_t curve) {
    const std::size_t axis = std::string_view("xyz").find(name);
    return ImGui::GetColorU32(
        panel_color(kAxisColors[(axis < 3 ? axis : curve) % kAxisColors.size()]));
}

/// A word in the color of what it stands for, after others on the line.
void legend(const Vec3& color, const char* word) {
    ImGui::SameLine();
    ImGui::TextColored(panel_color(color), "%s", word);
}

Ray ray_at(const RenderView& view, const PanelPointer& pointer) {
    return ray_through(view, pointer.at / Vec2(glm::max(pointer.window, IVec2(1))));
}

void skeleton_heading(const char* text) {
    ImGui::Spacing();
    ImGui::TextColored(kHudAccent, "%s", text);
    ImGui::Separator();
}

}  // namespace

void SkeletonPanel::open(Entity character) {
    if (!character.is_null() && character != character_) {
        const SkeletonOverlay overlay = overlay_;
        reset();
        overlay_ = overlay;
        overlay_.trails.clear();
        overlay_.selected = -1;
        character_ = character;
    }
}

void SkeletonPanel::record(const World& world, double time) {
    if (!is_open()) {
        return;
    }
    if (const auto view = view_character(world, character_)) {
        history_.record(*view, time);
    }
}

std::optional<SkeletonPanel::Posing> SkeletonPanel::posing(const World& world) const {
    const auto view = view_character(world, character_);
    const auto* const keys = world.find<PoseKeys>(character_);
    if (!view || keys == nullptr) {
        return std::nullopt;
    }
    return Posing{*view, *keys};
}

void SkeletonPanel::set_keys(World& world, UndoStack& undo, PoseKeys after, const char* what) {
    Edit edit;
    edit.entity = character_;
    if (world.has<PoseKeys>(character_)) {
        edit.before = AnyComponent::read(world, character_, component_info<PoseKeys>());
    }
    record_edit(
        world, undo, std::move(edit), AnyComponent::of(after),
        fmt::format("{}: pose_keys, {}", entity_label(world, character_), what), last_edit_);
}

void SkeletonPanel::start_poses(World& world, UndoStack& undo) {
    const auto view = view_character(std::as_const(world), character_);
    if (!view) {
        return;
    }
    poses_ = true;
    overlay_.bones = true;
    Edit edit;
    edit.entity = character_;
    if (!world.has<PoseKeys>(character_)) {
        PoseKeys keys;
        set_pose_key(keys, *view->skeleton, 0, local_pose(*view->skeleton, view->joints));
        set_keys(world, undo, keys, "begin");
        release();
        edit.joined = true;
    }
    if (world.has<ClipPlayer>(character_)) {
        edit.before = AnyComponent::read(world, character_, component_info<ClipPlayer>());
    }
    record_edit(
        world, undo, std::move(edit),
        AnyComponent::of(ClipPlayer{.clip = {}, .speed = 0, .loop = false}),
        fmt::format("{}: clip_player", entity_label(world, character_)), last_edit_);
    release();
}

void SkeletonPanel::turn_selected(World& world, UndoStack& undo, const Quat& turn) {
    auto now = posing(std::as_const(world));
    if (!now || overlay_.selected < 0
        || overlay_.selected >= static_cast<int>(now->view.joints.size())) {
        return;
    }
    const auto joint = static_cast<std::uint16_t>(overlay_.selected);
    const SkeletonData& skeleton = *now->view.skeleton;
    LocalPose pose = sample_pose_keys(skeleton, now->keys, now->view.time);
    turn_joint(skeleton, joint, by_limits_ ? limit_turn(skeleton, joint, turn) : turn, pose);
    set_pose_key(now->keys, skeleton, now->view.time, pose);
    set_keys(
        world, undo, std::move(now->keys),
        fmt::format("{} at {:.2f} s", skeleton.joints[joint], now->view.time).c_str());
}

void SkeletonPanel::set_time(World& world, float time) {
    if (world.has<ClipPlayer>(character_)) {
        auto& player = world.get<ClipPlayer>(character_);
        player.time = std::max(time, 0.0f);
        player.speed = 0;
        player.loop = false;  // shows the last key at its time, not the first
    }
}

void SkeletonPanel::set_key(World& world, UndoStack& undo) {
    if (auto now = posing(std::as_const(world))) {
        const SkeletonData& skeleton = *now->view.skeleton;
        set_pose_key(
            now->keys, skeleton, now->view.time,
            sample_pose_keys(skeleton, now->keys, now->view.time));
        set_keys(world, undo, std::move(now->keys), "set key");
        release();
    }
}

void SkeletonPanel::remove_key(World& world, UndoStack& undo) {
    if (auto now = posing(std::as_const(world));
        now && remove_pose_key(now->keys, now->view.time)) {
        set_keys(world, undo, std::move(now->keys), "remove key");
        release();
    }
}

void SkeletonPanel::mirror(World& world, UndoStack& undo) {
    if (auto now = posing(std::as_const(world))) {
        const SkeletonData& skeleton = *now->view.skeleton;
        set_pose_key(
            now->keys, skeleton, now->view.time,
            mirror_pose(skeleton, sample_pose_keys(skeleton, now->keys, now->view.time)));
        set_keys(world, undo, std::move(now->keys), "mirror");
        release();
    }
}

void SkeletonPanel::save(const World& world) {
    const auto now = posing(world);
    if (!now) {
        return;
    }
    Result<ClipData> clip = make_pose_clip(*now->view.skeleton, now->keys);
    if (!clip) {
        message_ = clip.error().message;
        return;
    }
    std::string path;
    do {
        path = fmt::format("limn-poses-{}.glb", ++saved_);
    } while (std::filesystem::exists(path));
    const GltfScene scene =
        make_motion_scene(now->view.skeleton->name, {*now->view.skeleton, *std::move(clip)});
    const Status status = save_glb(path, scene);
    message_ = status ? "saved " + path : status.error().message;
}

bool SkeletonPanel::take_pointer(
    World& world, UndoStack& undo, const RenderView& view, const PanelPointer& pointer) {
    const bool pressed = left_.begins(pointer.left);
    if (!pointer.left && ring_ >= 0) {
        ring_ = -1;
        release();
    }
    const auto character = view_character(std::as_const(world), character_);
    if (!character || (pointer.blocked && ring_ < 0)) {
        return false;
    }
    const int selected = overlay_.selected;
    const bool turns =
        poses_ && selected >= 0 && selected < static_cast<int>(character->joints.size());
    if (turns && pressed) {
        const auto joint = static_cast<std::uint16_t>(selected);
        ring_gizmo_ = make_gizmo(view, character->world_from_character * character->joints[joint]);
        const auto ring = pick_ring(ring_gizmo_, view, pointer.at, pointer.window);
        const auto angle =
            ring ? ring_angle(ring_gizmo_, *ring, ray_at(view, pointer)) : std::nullopt;
        if (angle) {
            ring_ = *ring;
            ring_start_ = *angle;
            ring_turn_ = shown_turn(*character->skeleton, character->joints, joint);
        }
    }
    if (turns && ring_ >= 0) {
        if (const auto angle = ring_angle(ring_gizmo_, ring_, ray_at(view, pointer));
            angle && pointer.motion != Vec2(0)) {
            Vec3 axis(0);
            axis[ring_] = 1;
            const float moved = snap_angle(*angle - ring_start_, radians(snap_));
            turn_selected(world, undo, ring_turn_ * rotation_about(axis, moved));
        }
        return true;
    }
    if (pointer.clicked) {
        std::vector<Vec3> points;
        for (const Affine& joint : character->joints) {
            points.push_back(transform_point(character->world_from_character * joint, Vec3(0)));
        }
        if (const auto joint = pick_joint(points, view, pointer.at, pointer.window)) {
            overlay_.selected = *joint;
            return true;
        }
    }
    return false;
}

void SkeletonPanel::draw_overlay(const RenderView& view, const World& world) const {
    const auto character = view_character(world, character_);
    if (!character) {
        return;
    }
    draw_skeleton_overlay(view, *character, history_, overlay_);
    if (poses_ && overlay_.selected >= 0
        && overlay_.selected < static_cast<int>(character->joints.size())) {
        const Affine& joint = character->joints[static_cast<std::size_t>(overlay_.selected)];
        draw_gizmo(view, make_gizmo(view, character->world_from_character * joint), ring_);
    }
}

void SkeletonPanel::draw(const HudStyle& style, World& world, UndoStack& undo) {
    if (!is_open()) {
        return;
    }
    if (!ImGui::IsAnyItemActive() && ring_ < 0) {
        release();
    }
    bool open = view_character(std::as_const(world), character_).has_value();
    if (open) {
        const float margin = 14.0f * style.scale;
        ImGui::SetNextWindowPos({margin, style.panel_top}, ImGuiCond_FirstUseEver);
        const float room = ImGui::GetIO().DisplaySize.y - style.panel_top - margin;
        ImGui::SetNextWindowSize({330.0f * style.scale, room}, ImGuiCond_FirstUseEver);
        if (ImGui::Begin("Skeleton", &open, ImGuiWindowFlags_NoCollapse)) {
            ImGui::PushItemWidth(150.0f * style.scale);
            const CharacterView view = *view_character(std::as_const(world), character_);
            ImGui::TextColored(
                kHudDim, "%s: %zu joints", entity_label(world, character_).c_str(),
                view.joints.size());
            draw_view();
            draw_poses(style, world, undo);
            // After edits: views point to components.
            if (const auto again = view_character(std::as_const(world), character_)) {
                draw_curves(style, *again);
                draw_joints(style, *again);
            }
            ImGui::PopItemWidth();
        }
        ImGui::End();
    }
    if (!open) {
        close();
    }
}

void SkeletonPanel::draw_view() {
    skeleton_heading("View");
    ImGui::Checkbox("Bones", &overlay_.bones);
    ImGui::SameLine();
    ImGui::Checkbox("Names", &overlay_.names);
    ImGui::SameLine();
    ImGui::Checkbox("Axes", &overlay_.axes);
    ImGui::SameLine();
    ImGui::Checkbox("Limits", &overlay_.limits);
    if (overlay_.axes) {
        ImGui::TextColored(kHudDim, "axes:");
        constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
        for (std::size_t i = 0; i < kAxes.size(); ++i) {
            legend(kAxisColors[i], kAxes[i]);
        }
    }
    if (overlay_.limits) {
        ImGui::TextColored(kHudDim, "limits:");
        legend(kLimitColor, "the arc; bold: the angle now");
    }
    if (overlay_.ghosts > 0 || !overlay_.trails.empty()) {
        ImGui::TextColored(kHudDim, "ghosts, trails:");
        legend(kPastColor, "past");
        legend(kFutureColor, "future");
    }
    ImGui::SliderInt("Ghosts on each side", &overlay_.ghosts, 0, 12);
    ImGui::SliderFloat(
        "Time between", &overlay_.ghost_step, 0.02f, 1, "%.2f s", ImGuiSliderFlags_AlwaysClamp);
    ImGui::BeginDisabled(overlay_.trails.empty());
    ImGui::SliderFloat(
        "Length of trails", &overlay_.trail, 0.1f, 3, "%.1f s", ImGuiSliderFlags_AlwaysClamp);
    ImGui::EndDisabled();
    ImGui::Checkbox("Curves of the selected joint", &curves_);
}

void SkeletonPanel::draw_curves(const HudStyle& style, const CharacterView& view) const {
    if (!curves_) {
        return;
    }
    skeleton_heading("Curves [degrees]");
    if (overlay_.selected < 0 || overlay_.selected >= static_cast<int>(view.joints.size())) {
        ImGui::TextDisabled("select a joint");
        return;
    }
    const JointCurves found = curves_of(
        view, history_, static_cast<std::uint16_t>(overlay_.selected), kCurveBefore, kCurveAfter);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size = {ImGui::GetContentRegionAvail().x, 130.0f * style.scale};
    ImGui::Dummy(size);
    ImDrawList* const list = ImGui::GetWindowDrawList();
    list->AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, IM_COL32(0, 0, 0, 90));
    float low = -1;
    float high = 1;
    for (const ChannelCurve& curve : found.curves) {
        for (const float value : curve.values) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    const auto x_of = [&](float time) {
        return corner.x + (time + kCurveBefore) / (kCurveBefore + kCurveAfter) * size.x;
    };
    const auto y_of = [&](float value) {
        return corner.y + size.y - (value - low) / (high - low) * size.y;
    };
    const double step = nice_plot_step(static_cast<double>(high - low) * 2);
    const ImU32 grid = IM_COL32(255, 255, 255, 40);
    for (double v = std::ceil(static_cast<double>(low) / step) * step;
         v <= static_cast<double>(high); v += step) {
        const float y = y_of(static_cast<float>(v));
        list->AddLine({corner.x, y}, {corner.x + size.x, y}, grid);
        list->AddText(
            {corner.x + 2, y - ImGui::GetFontSize()}, IM_COL32(255, 255, 255, 110),
            fmt::format("{:.0f}", std::round(v) + 0.0).c_str());  // + 0: no "-0"
    }
    list->AddLine({x_of(0), corner.y}, {x_of(0), corner.y + size.y}, IM_COL32(255, 255, 255, 130));
    for (std::size_t c = 0; c < found.curves.size(); ++c) {
        const std::vector<float>& values = found.curves[c].values;
        std::vector<ImVec2> points;
        for (std::size_t i = 0; i < values.size(); ++i) {
            points.emplace_back(x_of(found.begin + static_cast<float>(i) / 60.0f), y_of(values[i]));
        }
        list->AddPolyline(
            points.data(), static_cast<int>(points.size()), color_of_curve(found.curves[c].name, c),
            0, 1.5f);
        list->AddText(
            {corner.x + size.x - static_cast<float>(found.curves.size() - c) * 46 * style.scale,
             corner.y + 2},
            color_of_curve(found.curves[c].name, c), found.curves[c].name.c_str());
    }
}

void SkeletonPanel::draw_joints(const HudStyle& style, const CharacterView& view) {
    skeleton_heading("Joints");
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##joint", "search; T: a trail", &search_);
    ImGui::BeginChild("##joints", {0, std::max(ImGui::GetContentRegionAvail().y, 120.0f)});
    std::vector<int> depths(view.joints.size(), 0);
    for (std::uint16_t j = 0; j < view.joints.size(); ++j) {
        const std::int32_t parent = view.skeleton->parents[j];
        const auto depth = parent < 0 ? 0 : depths[static_cast<std::size_t>(parent)] + 1;
        depths[j] = depth;
        const std::string& name = view.skeleton->joints[j];
        if (name.find(search_) == std::string::npos) {
            continue;
        }
        ImGui::PushID(j);
        const auto trail = std::ranges::find(overlay_.trails, j);
        const bool has_trail = trail != overlay_.trails.end();
        ImGui::PushStyleColor(ImGuiCol_Text, has_trail ? kHudAccent : kHudDim);
        const bool toggles = ImGui::SmallButton("T");
        ImGui::PopStyleColor();
        if (toggles) {
            if (has_trail) {
                overlay_.trails.erase(trail);
            } else {
                overlay_.trails.push_back(j);
            }
        }
        ImGui::SameLine(0, (6.0f + 9.0f * static_cast<float>(depth)) * style.scale);
        if (ImGui::Selectable(name.c_str(), overlay_.selected == static_cast<int>(j))) {
            overlay_.selected = j;
        }
        ImGui::PopID();
    }
    ImGui::EndChild();
}

void SkeletonPanel::draw_poses(const HudStyle& style, World& world, UndoStack& undo) {
    skeleton_heading("Poses");
    if (!poses_) {
        if (ImGui::Button(world.has<PoseKeys>(character_) ? "Edit poses" : "Begin poses")) {
            start_poses(world, undo);
        }
        return;
    }
    const auto now = posing(std::as_const(world));
    if (!now || !world.has<ClipPlayer>(character_)) {
        poses_ = false;  // its beginning was undone
        return;
    }
    draw_timeline(style, world, *now);
    if (ImGui::Button("Set key")) {
        set_key(world, undo);
    }
    ImGui::SameLine();
    ImGui::BeginDisabled(!find_pose_key(now->keys, now->view.time).has_value());
    if (ImGui::Button("Remove key")) {
        remove_key(world, undo);
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Mirror")) {
        mirror(world, undo);
    }
    ImGui::SameLine();
    if (ImGui::Button("Save .glb")) {
        save(std::as_const(world));
    }
    bool smooth = now->keys.smooth;
    if (ImGui::Checkbox("Smooth", &smooth)) {
        PoseKeys after = now->keys;
        after.smooth = smooth;
        set_keys(world, undo, std::move(after), "smooth");
    }
    ImGui::SameLine();
    ImGui::Checkbox("Within limits", &by_limits_);
    ImGui::SliderFloat("Snap", &snap_, 0, 45, snap_ > 0 ? "%.0f deg" : "off");
    if (const auto view = view_character(std::as_const(world), character_)) {
        draw_angles(world, undo, *view);
    }
}

void SkeletonPanel::draw_angles(World& world, UndoStack& undo, const CharacterView& view) {
    if (overlay_.selected < 0 || overlay_.selected >= static_cast<int>(view.joints.size())) {
        ImGui::TextDisabled("click a joint to turn it");
        return;
    }
    const auto joint = static_cast<std::uint16_t>(overlay_.selected);
    ImGui::TextUnformatted(view.skeleton->joints[joint].c_str());
    std::vector<JointAngle> angles =
        joint_angles(*view.skeleton, joint, shown_turn(*view.skeleton, view.joints, joint));
    bool changed = false;
    for (JointAngle& angle : angles) {
        float value = degrees(angle.value);
        if (ImGui::SliderFloat(
                angle.name.c_str(), &value, degrees(angle.min), degrees(angle.max), "%.1f deg")) {
            angle.value = snap_angle(radians(value), radians(snap_));
            changed = true;
        }
    }
    if (changed) {
        turn_selected(world, undo, turn_of_angles(angles));
    }
    if (ImGui::SmallButton("At rest")) {
        turn_selected(world, undo, Quat(1, 0, 0, 0));
    }
}

void SkeletonPanel::draw_timeline(const HudStyle& style, World& world, const Posing& now) {
    const float last = now.keys.keys.empty() ? 0.0f : now.keys.keys.back().time;
    length_ = std::max(length_, last);
    float time = now.view.time;
    const float width = ImGui::GetContentRegionAvail().x - 60.0f * style.scale;
    ImGui::SetNextItemWidth(width);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    if (ImGui::SliderFloat("##time", &time, 0, length_, "%.2f s", ImGuiSliderFlags_AlwaysClamp)) {
        set_time(world, time);
    }
    ImGui::SameLine();
    const bool plays = now.view.speed != 0;
    if (ImGui::Button(plays ? "Stop" : "Play")) {
        auto& player = world.get<ClipPlayer>(character_);
        player.speed = plays ? 0.0f : 1.0f;
        player.loop = !plays;
    }
    // Keys: marks below the slider, which a click goes to.
    for (std::size_t k = 0; k < now.keys.keys.size(); ++k) {
        const float at = now.keys.keys[k].time;
        const float grab = 8.0f * style.scale;
        const float x = corner.x + grab + (width - 2 * grab) * at / std::max(length_, 1e-3f);
        ImGui::GetWindowDrawList()->AddTriangleFilled(
            {x - grab / 2, corner.y + ImGui::GetFrameHeight() + grab},
            {x + grab / 2, corner.y + ImGui::GetFrameHeight() + grab},
            {x, corner.y + ImGui::GetFrameHeight()}, IM_COL32(255, 190, 60, 255));
    }
    ImGui::Dummy({0, 6.0f * style.scale});
    for (std::size_t k = 0; k < now.keys.keys.size(); ++k) {
        ImGui::PushID(static_cast<int>(k));
        if (ImGui::SmallButton(fmt::format("{:.2f}", now.keys.keys[k].time).c_str())) {
            set_time(world, now.keys.keys[k].time);
        }
        ImGui::PopID();
        if (k % 5 != 4 && k + 1 != now.keys.keys.size()) {
            ImGui::SameLine();
        }
    }
    ImGui::SliderFloat("Length", &length_, 0.5f, 20, "%.1f s", ImGuiSliderFlags_AlwaysClamp);
}

}  // namespace limn
