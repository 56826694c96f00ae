#include "content/app/panels/furrow_panel.h"

#include "content/app/panels/field_widgets.h"
#include "content/app/panels/hud_style.h"
#include "content/app/panels/undo.h"
#include "content/bake/furrow_presets.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/material/furrow_pass.h"
#include "render/render_view.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>

// Techniques: wrinkle.furrow.editor

namespace limn {
namespace {

/// The edited entity's components in the world.
struct Target {
    const Furrows* furrows = nullptr;
    const FurrowSkin* skin = nullptr;
    const FurrowView* view = nullptr;
    const MeshData* mesh = nullptr;
    Affine world_from_mesh = {};
};

std::optional<Target> find_target(const World& world, Entity entity) {
    const auto* const assets = world.find_resource<Assets>();
    if (!world.alive(entity) || assets == nullptr) {
        return std::nullopt;
    }
    const auto* const instance = world.find<MeshInstance>(entity);
    const auto* const transform = world.find<WorldTransform>(entity);
    Target target = {
        world.find<Furrows>(entity), world.find<FurrowSkin>(entity),
        world.find<FurrowView>(entity)};
    if (target.furrows == nullptr || target.skin == nullptr || target.view == nullptr
        || !target.skin->fault.empty() || instance == nullptr || transform == nullptr
        || instance->mesh.index >= assets->meshes.size()) {
        return std::nullopt;
    }
    target.mesh = &assets->meshes[instance->mesh.index];
    target.world_from_mesh = transform->world;
    return target.skin->field.size() == target.mesh->positions.size() ? std::optional(target)
                                                                      : std::nullopt;
}

ViewedMesh viewed_by(const RenderView& view, const Target& target, const IVec2& window) {
    const Mat4 world_from_mesh = to_mat4(target.world_from_mesh);
    const Vec3 eye = transform_point(view.world_from_camera, {0, 0, 0});
    return {
        target.mesh, view.unjittered_from_world * world_from_mesh,
        Vec3(glm::inverse(world_from_mesh) * Vec4(eye, 1)), Vec2(window)};
}

std::optional<std::uint32_t> selected_vertex(const Target& target) {
    const int selected = target.view->selected;
    return selected >= 0 && static_cast<std::size_t>(selected) < target.mesh->positions.size()
               ? std::optional(static_cast<std::uint32_t>(selected))
               : std::nullopt;
}

const Material* material_of(const World& world, Entity entity) {
    const auto* const assets = world.find_resource<Assets>();
    const auto* const instance = world.find<MeshInstance>(entity);
    return assets != nullptr && instance != nullptr
                   && instance->material.index < assets->materials.size()
               ? &assets->materials[instance->material.index]
               : nullptr;
}

/// Radius of the tips in window pixels; the rendered image may have fewer rows [px].
float tip_radius(const RenderView& view, const IVec2& window) {
    const float rows = static_cast<float>(std::max(view.height, 1));
    return furrow_mark_pixels(view.height, kFurrowTipRadius) * static_cast<float>(window.y) / rows;
}

void draw_heading(const char* text) {
    ImGui::Spacing();
    ImGui::TextColored(kHudAccent, "%s", text);
    ImGui::Separator();
}

bool slider(const char* label, float& value, float low, float high) {
    return ImGui::SliderFloat(label, &value, low, high, "%.2f", ImGuiSliderFlags_AlwaysClamp);
}

}  // namespace

void FurrowPanel::open(World& world, Entity entity) {
    if (!world.has<Furrows>(entity)) {
        return;
    }
    close(world);
    entity_ = entity;
    path_ = fmt::format("{}.furrows.json", entity_label(world, entity));
    std::ranges::replace(path_, '/', '-');
    if (const auto* const view = std::as_const(world).find<FurrowView>(entity)) {
        before_ = *view;
    }
    world.add(entity, FurrowView{});
}

void FurrowPanel::close(World& world) {
    if (world.alive(entity_) && world.has<FurrowView>(entity_)) {
        if (before_) {
            world.get<FurrowView>(entity_) = *before_;
        } else {
            world.remove<FurrowView>(entity_);
        }
    }
    reset();
}

void FurrowPanel::select(World& world, int vertex) {
    world.get<FurrowView>(entity_).selected = vertex;
}

void FurrowPanel::set_furrows(
    World& world, UndoStack& undo, const Furrows& after, const char* what) {
    Edit edit;
    edit.entity = entity_;
    edit.before = AnyComponent::read(world, entity_, component_info<Furrows>());
    record_edit(
        world, undo, std::move(edit), AnyComponent::of(after),
        fmt::format("{}: furrows.{}", entity_label(world, entity_), what), last_edit_);
}

void FurrowPanel::set_material(
    World& world, UndoStack& undo, const FurrowLook& look, const char* what) {
    const Material* const material = material_of(std::as_const(world), entity_);
    if (material == nullptr) {
        return;
    }
    Edit edit;
    edit.part = LevelPart::Material;
    edit.material = std::as_const(world).find<MeshInstance>(entity_)->material.index;
    edit.before = AnyComponent::of(*material);
    Material after = *material;
    set_furrow_look(after, look);
    const std::string label = fmt::format("{}: {}", material->name, what);
    record_edit(world, undo, std::move(edit), AnyComponent::of(after), label, last_edit_);
}

void FurrowPanel::drag_tip(
    World& world, UndoStack& undo, const RenderView& view, const PanelPointer& pointer) {
    const auto target = find_target(std::as_const(world), entity_);
    const auto vertex = target ? selected_vertex(*target) : std::nullopt;
    if (!vertex || pointer.motion == Vec2(0)) {
        return;
    }
    const ViewedMesh viewed = viewed_by(view, *target, pointer.window);
    const Vec3 dragged = drag_furrow_tip(
        target->mesh->positions[*vertex], target->mesh->normals[*vertex],
        furrow_vector_length(*target->view, *target->skin), ray_of(viewed, pointer.at));
    Furrows after = *target->furrows;
    FurrowArrow& arrow = edit_furrow_vertex(after, *target->skin, *target->mesh, *vertex);
    (*tip_ == 0 ? arrow.first : arrow.second) = dragged;
    set_furrows(world, undo, after, *tip_ == 0 ? "first" : "second");
}

bool FurrowPanel::take_pointer(
    World& world, UndoStack& undo, const RenderView& view, const PanelPointer& pointer) {
    if (!is_open()) {
        return false;
    }
    const bool pressed = left_.begins(pointer.left);
    if (!pointer.left && !pointer.right && !ImGui::IsAnyItemActive()) {
        tip_.reset();
        last_edit_.clear();
        light_.release();
    }
    const auto target = find_target(std::as_const(world), entity_);
    if (!target || (pointer.blocked && !tip_)) {
        return false;
    }
    if (pointer.right) {
        if (const auto center = entity_center(world, entity_)) {
            light_.drag(
                world, undo, *center, pointer.motion, static_cast<float>(pointer.window.y),
                view.world_from_camera);
        }
        return true;
    }
    if (target->view->mode != FurrowMode::Vectors) {
        return false;
    }
    const ViewedMesh viewed = viewed_by(view, *target, pointer.window);
    const auto vertex = selected_vertex(*target);
    if (pressed && vertex) {
        tip_ = pick_furrow_tip(
            viewed, target->mesh->positions[*vertex], target->skin->field[*vertex],
            furrow_vector_length(*target->view, *target->skin), pointer.at,
            std::max(kFurrowPickRadius, tip_radius(view, pointer.window)));
    }
    if (tip_ && pointer.left) {
        drag_tip(world, undo, view, pointer);
        return true;
    }
    if (pointer.clicked) {
        const auto found = pick_furrow_vertex(viewed, pointer.at);
        select(world, found ? static_cast<int>(*found) : -1);
        return true;
    }
    return false;
}

void FurrowPanel::draw(const HudStyle& style, World& world, UndoStack& undo) {
    if (!is_open()) {
        return;
    }
    const bool alive = world.alive(entity_) && world.has<Furrows>(entity_);
    bool open = alive && world.has<FurrowView>(entity_);
    if (open) {
        const float margin = 14.0f * style.scale;
        ImGui::SetNextWindowPos({margin, style.panel_top}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize({300.0f * style.scale, 0}, ImGuiCond_FirstUseEver);
        const float room = ImGui::GetIO().DisplaySize.y - style.panel_top - margin;
        ImGui::SetNextWindowSizeConstraints(
            {0, 0}, {std::numeric_limits<float>::max(), std::max(room, 100.0f)});
        constexpr ImGuiWindowFlags kFlags =
            ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize;
        if (ImGui::Begin("Furrows", &open, kFlags)) {
            ImGui::PushItemWidth(150.0f * style.scale);
            const auto* const skin = std::as_const(world).find<FurrowSkin>(entity_);
            if (skin != nullptr && !skin->fault.empty()) {
                ImGui::PushStyleColor(ImGuiCol_Text, kHudBad);
                ImGui::TextWrapped("%s", skin->fault.c_str());
                ImGui::PopStyleColor();
            }
            draw_display(world);
            draw_vectors(world, undo);
            draw_wrinkles(world, undo);
            draw_skin(world, undo);
            draw_files(world, undo);
            ImGui::PopItemWidth();
        }
        ImGui::End();
    }
    if (!open) {
        close(world);
    }
}

void FurrowPanel::draw_display(World& world) {
    constexpr std::pair<const char*, FurrowMode> kModes[] = {
        {"Overview", FurrowMode::Overview},
        {"Edit vectors", FurrowMode::Vectors},
        {"Height field", FurrowMode::Height},
        {"Wrinkles", FurrowMode::Wrinkles}};
    FurrowView view = *std::as_const(world).find<FurrowView>(entity_);
    draw_heading("Display");
    int column = 0;
    for (const auto& mode : kModes) {
        if (column++ % 2 == 1) {
            ImGui::SameLine(130.0f);
        }
        if (ImGui::RadioButton(mode.first, view.mode == mode.second)) {
            view.mode = mode.second;
        }
    }
    ImGui::Checkbox("Only edited", &view.only_edited);
    const auto* const skin = std::as_const(world).find<FurrowSkin>(entity_);
    float length = skin != nullptr ? furrow_vector_length(view, *skin) : view.length;
    const float spacing = skin != nullptr && skin->spacing > 0 ? skin->spacing : 1.0f;
    length /= spacing;
    if (slider("Length of vectors", length, 0.1f, 5)) {
        view.length = length * spacing;
    }
    if (ImGui::Button("Reset view and light")) {
        reset_view_ = true;
    }
    if (view != *std::as_const(world).find<FurrowView>(entity_)) {
        world.get<FurrowView>(entity_) = view;
    }
}

void FurrowPanel::draw_vectors(World& world, UndoStack& undo) {
    const Furrows before = *std::as_const(world).find<Furrows>(entity_);
    Furrows after = before;
    draw_heading("Direction vectors");
    bool live = !after.hold.waits;
    if (ImGui::Checkbox("Live", &live)) {
        let_furrows_wait(after, !live);
        set_furrows(world, undo, after, "hold");
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip(
            "Fields and furrows follow every edit; otherwise each button runs its step.");
    }
    ImGui::SameLine();
    ImGui::TextColored(kHudDim, "%zu edited", before.arrows.size());
    if (ImGui::Button("INITIALIZE")) {
        initialize_furrows(after);
        select(world, -1);
        set_furrows(world, undo, after, "initialize");
    }
    ImGui::SameLine();
    ImGui::BeginDisabled(live);
    if (ImGui::Button("INTERPOLATE")) {
        interpolate_furrows(after);
        set_furrows(world, undo, after, "interpolate");
    }
    ImGui::EndDisabled();

    const auto target = find_target(std::as_const(world), entity_);
    const auto vertex = target ? selected_vertex(*target) : std::nullopt;
    if (!vertex) {
        ImGui::TextColored(kHudDim, "Click a vertex to select it.");
        return;
    }
    const auto known = find_furrow_arrow(*target->skin, *target->mesh, *vertex);
    const bool is_edited = known && *known < before.arrows.size();
    const FurrowVectors& shown = target->skin->field[*vertex];
    ImGui::TextColored(
        kHudDim, "vertex %u: magnitudes %.2f, %.2f", *vertex, glm::length(shown[0]),
        glm::length(shown[1]));
    float weight = is_edited ? before.arrows[*known].weight : FurrowArrow{}.weight;
    if (slider("Weight", weight, 0, 10)) {
        edit_furrow_vertex(after, *target->skin, *target->mesh, *vertex).weight = weight;
        set_furrows(world, undo, after, "weight");
    }
    ImGui::BeginDisabled(!is_edited);
    if (ImGui::Button("Reset the vertex")) {
        after.arrows.erase(after.arrows.begin() + static_cast<std::ptrdiff_t>(*known));
        set_furrows(world, undo, after, "arrows");
    }
    ImGui::EndDisabled();
}

void FurrowPanel::draw_wrinkles(World& world, UndoStack& undo) {
    Furrows after = *std::as_const(world).find<Furrows>(entity_);
    const bool live = !after.hold.waits;
    draw_heading("Wrinkles");
    if (slider("Scale", after.style.scale, 0.5f, 2)) {
        set_furrows(world, undo, after, "scale");
    }
    ImGui::BeginDisabled(live);
    if (ImGui::Button("GENERATE")) {
        generate_furrows(after);
        set_furrows(world, undo, after, "generate");
    }
    ImGui::EndDisabled();
    if (slider("Noise", after.style.noise, 0, 1)) {
        set_furrows(world, undo, after, "noise");
    }
    if (slider("Bump", after.style.bump, 0, 1)) {
        set_furrows(world, undo, after, "bump");
    }
    ImGui::BeginDisabled(live);
    if (ImGui::Button("REMAKE")) {
        remake_furrows(after);
        set_furrows(world, undo, after, "remake");
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Another seed")) {
        after.style.seed = after.style.seed % 9999 + 1;
        set_furrows(world, undo, after, "seed");
    }
}

void FurrowPanel::draw_skin(World& world, UndoStack& undo) {
    const Material* const material = material_of(std::as_const(world), entity_);
    if (material == nullptr) {
        return;
    }
    constexpr std::pair<const char*, FurrowReflection> kReflections[] = {
        {"BRDF1", FurrowReflection::Brdf1},
        {"BRDF2", FurrowReflection::Brdf2},
        {"Own parameters", FurrowReflection::Own}};
    FurrowLook look = furrow_look_of(*material);
    const FurrowLook before = look;
    const FurrowMode mode = std::as_const(world).find<FurrowView>(entity_)->mode;
    draw_heading("Skin material");
    const auto choose = [&](const std::pair<const char*, FurrowReflection>& it) {
        if (ImGui::RadioButton(it.first, look.reflection == it.second)) {
            look.reflection = it.second;
        }
    };
    ImGui::BeginDisabled(mode != FurrowMode::Wrinkles);
    choose(kReflections[0]);
    ImGui::SameLine();
    choose(kReflections[1]);
    ImGui::EndDisabled();
    ImGui::SameLine();
    choose(kReflections[2]);
    ImGui::BeginDisabled(look.reflection != FurrowReflection::Own);
    slider("Melanin", look.melanin, 0, 1);
    slider("Blood", look.blood, 0, 1);
    slider("Specular", look.specular, 0, 1);
    slider("Shininess", look.shininess, 0, 128);
    ImGui::EndDisabled();
    if (look != before) {
        set_material(world, undo, look, "skin");
    }
    if (ImGui::BeginCombo("Figure", "settings of ...")) {
        for (const FurrowPreset& preset : furrow_presets()) {
            if (ImGui::Selectable(fmt::format("{}  {}", preset.figure, preset.name).c_str())) {
                Furrows after = *std::as_const(world).find<Furrows>(entity_);
                set_furrow_preset(after, look, preset);
                set_furrows(world, undo, after, preset.name);
                set_material(world, undo, look, preset.name);
            }
        }
        ImGui::EndCombo();
    }
}

void FurrowPanel::draw_files(World& world, UndoStack& undo) {
    draw_heading("File");
    ImGui::SetNextItemWidth(-1);
    ImGui::InputText("##path", &path_);
    const Material* const material = material_of(std::as_const(world), entity_);
    if (ImGui::Button("Save")) {
        const Furrows& furrows = *std::as_const(world).find<Furrows>(entity_);
        const Status saved = save_furrows(
            path_, {furrows, material != nullptr ? furrow_look_of(*material) : FurrowLook{}});
        message_ = saved ? fmt::format("saved {}", path_) : saved.error().message;
    }
    ImGui::SameLine();
    if (ImGui::Button("Load")) {
        const Result<FurrowFile> file = load_furrows(path_);
        if (!file) {
            message_ = file.error().message;
            return;
        }
        Furrows after = *std::as_const(world).find<Furrows>(entity_);
        after.arrows = file->furrows.arrows;
        after.style = file->furrows.style;
        after.tiles = file->furrows.tiles;
        let_furrows_wait(after, after.hold.waits);
        select(world, -1);
        set_furrows(world, undo, after, "load");
        set_material(world, undo, file->skin, "load");
        message_ = fmt::format("loaded {}", path_);
    }
}

}  // namespace limn
