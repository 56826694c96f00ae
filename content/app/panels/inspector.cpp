#include "content/app/panels/inspector.h"

#include "content/app/panels/edit_json.h"
#include "content/app/panels/emitter_controls.h"
#include "content/app/panels/field_widgets.h"
#include "content/app/panels/graph_controls.h"
#include "content/app/panels/hud_style.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/level_place.h"
#include "ecs/archetype.h"
#include "ecs/base/srgb.h"
#include "ecs/base/text.h"
#include "ecs/components/animation.h"
#include "ecs/components/furrows.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/name.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "render/material/shading_fields.h"
#include "render/material/shading_models.h"
#include "systems/particles/emitter_restart.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <tuple>
#include <utility>

namespace limn {
namespace {

constexpr double kRowsLifetime = 0.5;  // [s] after which the tree is rebuilt

constexpr ImGuiTreeNodeFlags kNoFields = ImGuiTreeNodeFlags_Leaf | ImGuiTreeNodeFlags_Bullet;

/// Whether `text` contains `part`, ignoring case.
bool contains(std::string_view text, std::string_view part) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a))
               == std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

/// Whether the component or one of its fields has `part` in its name.
bool matches(const ComponentInfo& info, std::string_view part) {
    return contains(info.name, part)
           || std::any_of(info.fields.begin(), info.fields.end(), [&](const FieldInfo& field) {
                  return contains(field.name, part);
              });
}

/// A search field as wide as the panel.
void draw_search(const char* hint, std::string& text) {
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", hint, &text);
}

/// A right click on the component's heading copies it.
void draw_copy_menu(const World& world, const ComponentInfo& info, const void* value) {
    if (value != nullptr && ImGui::BeginPopupContextItem("##copy")) {
        if (ImGui::Selectable("Copy as JSON")) {
            ImGui::SetClipboardText(component_as_json(world, info, value).c_str());
        }
        ImGui::EndPopup();
    }
}

/// Has fields, and a value that can be copied.
bool is_editable(const ComponentInfo& info) {
    return !info.fields.empty() && info.ops.construct_copy != nullptr;
}

}  // namespace

void Inspector::reset(const PlacedLevel& level) {
    level_ = level;
    placed_.clear();
    undo_.clear();
    note_saved();
    subtrees_.reset();
    selected_ = noted_ = {};
    rows_.clear();
    rows_built_at_ = -1.0;
    collapsed_.clear();
    dragging_.clear();
    material_ = 0;
    material_of_ = {};
    storage_.reset();
}

std::size_t Inspector::edit_count() const {
    if (saved_revision_ == undo_.revision()) {
        return 0;
    }
    return static_cast<std::size_t>(std::ranges::count(undo_.done(), false, &Edit::joined));
}

std::string Inspector::edits_as_json(World& world) const {
    return limn::edits_as_json(world, undo_.done());
}

std::string Inspector::run(World& world, TreeCommand command) {
    rows_built_at_ = -1.0;
    dragging_.clear();
    selected_ = exists(world, selected_) ? selected_ : Entity{};
    const auto edit = [&]() -> Result<std::string> {
        switch (command) {
        case TreeCommand::Cut:
            return subtrees_.cut(world, undo_, selected_);
        case TreeCommand::Copy:
            return subtrees_.copy(world, selected_);
        case TreeCommand::Paste:
            return subtrees_.paste(world, undo_, selected_, KeptPlace::World);
        case TreeCommand::PasteLocal:
            return subtrees_.paste(world, undo_, selected_, KeptPlace::Local);
        case TreeCommand::Duplicate:
            return subtrees_.duplicate(world, undo_, selected_);
        case TreeCommand::Delete:
            return subtrees_.remove(world, undo_, selected_);
        }
        return fail("no command");
    };
    const Result<std::string> done = edit();
    if (!done) {
        return done.error().message;
    }
    if (command == TreeCommand::Delete) {
        selected_ = {};
    } else if (command != TreeCommand::Cut && command != TreeCommand::Copy) {
        select(subtrees_.pasted());
    }
    return *done;
}

std::string Inspector::place(World& world, const std::string& prefab, const Vec3& position) {
    const Result<Prefab> instance = read_instance(world, level_, prefab, position);
    const Result<std::string> done =
        instance ? subtrees_.place(world, undo_, *instance) : Result<std::string>(instance.error());
    if (!done) {
        return done.error().message;
    }
    rows_built_at_ = -1.0;
    select(subtrees_.pasted());
    return *done;
}

void Inspector::draw(const HudStyle& style, World& world, const Schedule& schedule) {
    if (!ImGui::IsAnyItemActive()) {
        dragging_.clear();
    }
    if (!open) {
        return;
    }
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float margin = 14.0f * style.scale;
    ImGui::SetNextWindowPos({display.x - margin, margin}, ImGuiCond_FirstUseEver, {1, 0});
    ImGui::SetNextWindowSize(
        {std::min(390.0f * style.scale, 0.5f * display.x), display.y - 2 * margin},
        ImGuiCond_FirstUseEver);
    const bool is_drawn = ImGui::Begin("Inspector", &open, ImGuiWindowFlags_NoCollapse);
    if (is_drawn) {
        draw_edits(world);
    }
    if (is_drawn && ImGui::BeginTabBar("##tabs")) {
        if (ImGui::BeginTabItem("Entities")) {
            draw_entities(style, world);
            ImGui::EndTabItem();
        }
        if (ImGui::BeginTabItem("Resources")) {
            draw_resources(style, world);
            ImGui::EndTabItem();
        }
        if (ImGui::BeginTabItem("Materials")) {
            draw_materials(style, world);
            ImGui::EndTabItem();
        }
        if (ImGui::BeginTabItem("Storage")) {
            storage_.draw(style, world, schedule);
            ImGui::EndTabItem();
        }
        ImGui::EndTabBar();
    }
    ImGui::End();
}

void Inspector::draw_edits(World& world) {
    const std::size_t edits = undo_.undo_count();
    ImGui::BeginDisabled(edits == 0);
    save_ = ImGui::SmallButton("Save") || save_;
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("as a new level beside this one (Ctrl S)");
    }
    ImGui::SameLine();
    if (ImGui::SmallButton("Copy the edits as JSON")) {
        ImGui::SetClipboardText(edits_as_json(world).c_str());
        copied_edits_ = undo_.revision();
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    const bool is_saved = edit_count() == 0;
    const bool is_copied = copied_edits_ == undo_.revision();
    const auto joined =
        static_cast<std::size_t>(std::ranges::count(undo_.done(), true, &Edit::joined));
    ImGui::TextColored(
        kHudDim, edits > 0 ? "%zu, %s" : "none yet", edits - joined,
        is_saved    ? "saved"
        : is_copied ? "copied"
                    : "Ctrl Z undoes");
}

void Inspector::draw_entities(const HudStyle& style, World& world) {
    const bool was_empty = search_.empty();
    ImGui::SetNextItemWidth(-92 * style.scale);
    if (ImGui::InputTextWithHint("##search", "search by name, component or field", &search_)
        || was_empty != search_.empty()) {
        rows_built_at_ = -1.0;
    }
    ImGui::SameLine();
    draw_place_button();
    const bool has_selected = exists(world, selected_);
    const float room = ImGui::GetContentRegionAvail().y;
    ImGui::BeginChild("##tree", {0, has_selected ? 0.36f * room : 0.0f});
    draw_tree(style, world);
    ImGui::EndChild();
    if (has_selected) {
        ImGui::Separator();
        ImGui::BeginChild("##selected");
        draw_selected(style, world);
        ImGui::EndChild();
    }
}

void Inspector::add_rows(const Hierarchy& tree, Entity entity, int depth) {
    const std::span<const Entity> children = tree.children_of(entity);
    const bool collapsed = collapsed_.contains(entity);
    rows_.push_back({entity, depth, !children.empty(), collapsed});
    if (collapsed) {
        return;
    }
    for (const Entity child : children) {
        add_rows(tree, child, depth + 1);
    }
}

void Inspector::rebuild_rows(World& world) {
    rows_.clear();
    const Hierarchy& tree = hierarchy(world);
    std::vector<Entity> entities;
    world.each_entity([&](Entity entity) {
        if (exists(world, entity)) {
            entities.push_back(entity);
        }
    });
    // As in the level's file, which was spawned in order.
    std::sort(
        entities.begin(), entities.end(), [](Entity a, Entity b) { return a.index < b.index; });
    for (const Entity entity : entities) {
        if (search_.empty()) {
            if (parent_of(world, entity).is_null()) {
                add_rows(tree, entity, 0);
            }
            continue;
        }
        bool found = contains(entity_label(world, entity), search_);
        for (const ComponentId id : world.components_of(entity)) {
            found = found || matches(component_info(id), search_);
        }
        if (found) {
            rows_.push_back({.entity = entity});
        }
    }
}

void Inspector::draw_tree(const HudStyle& style, World& world) {
    const bool edited = std::exchange(rows_revision_, undo_.revision()) != undo_.revision();
    if (edited || rows_built_at_ < 0.0 || ImGui::GetTime() - rows_built_at_ > kRowsLifetime) {
        rebuild_rows(world);
        rows_built_at_ = ImGui::GetTime();
    }
    if (reveal_) {
        const auto row = std::find_if(
            rows_.begin(), rows_.end(), [this](const Row& r) { return r.entity == selected_; });
        const float line = ImGui::GetTextLineHeightWithSpacing();
        if (row != rows_.end()) {
            ImGui::SetScrollY(static_cast<float>(row - rows_.begin()) * line - 3 * line);
        }
        reveal_ = false;
    }
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(rows_.size()), ImGui::GetTextLineHeightWithSpacing());
    while (clipper.Step()) {
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const Row& row = rows_[static_cast<std::size_t>(i)];
            ImGui::PushID(i);
            const float indent = static_cast<float>(row.depth) * 14.0f * style.scale + 1.0f;
            ImGui::Indent(indent);
            const float arrow_width = 13.0f * style.scale;
            if (row.has_children) {
                const float x = ImGui::GetCursorPosX();
                ImGui::TextColored(kHudDim, row.collapsed ? "\u25b8" : "\u25be");
                if (ImGui::IsItemClicked()) {
                    if (!collapsed_.erase(row.entity)) {
                        collapsed_.insert(row.entity);
                    }
                    rows_built_at_ = -1.0;
                }
                ImGui::SameLine();
                ImGui::SetCursorPosX(x + arrow_width);
            } else {
                ImGui::SetCursorPosX(ImGui::GetCursorPosX() + arrow_width);
            }
            const bool alive = world.alive(row.entity);
            const std::string label = alive ? entity_label(world, row.entity) : "gone";
            if (ImGui::Selectable(label.c_str(), row.entity == selected_) && alive) {
                selected_ = row.entity;
            }
            if (alive && ImGui::BeginPopupContextItem("##row menu")) {
                selected_ = row.entity;
                draw_tree_menu(world);
                ImGui::EndPopup();
            }
            const Entity parent = alive ? parent_of(world, row.entity) : Entity{};
            if (!search_.empty() && !parent.is_null()) {
                ImGui::SameLine();
                ImGui::TextColored(kHudDim, "of %s", entity_label(world, parent).c_str());
            }
            ImGui::Unindent(indent);
            ImGui::PopID();
        }
    }
    if (rows_.empty()) {
        ImGui::TextDisabled("no match");
    }
}

void Inspector::draw_selected(const HudStyle& style, World& world) {
    ImGui::PushFont(style.title);
    ImGui::TextUnformatted(entity_label(world, selected_).c_str());
    ImGui::PopFont();
    if (std::exchange(noted_, selected_) != selected_) {
        note_ = edit_note(world, selected_);
    }
    if (!note_.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, kHudAccent);
        ImGui::TextWrapped("%s", note_.c_str());
        ImGui::PopStyleColor();
    }
    if (ImGui::Button("Focus (F)")) {
        focus_ = true;
    }
    ImGui::SameLine();
    if (ImGui::Button("Copy JSON")) {
        ImGui::SetClipboardText(entity_as_json(world, selected_).c_str());
        copied_ = selected_;
    }
    if (copied_ == selected_) {
        ImGui::SameLine();
        ImGui::TextColored(kHudDim, "copied");
    }
    ImGui::SameLine();
    if (ImGui::Button("Edit ...")) {
        ImGui::OpenPopup("##tree menu");
    }
    if (ImGui::BeginPopup("##tree menu")) {
        draw_tree_menu(world);
        ImGui::EndPopup();
    }
    if (!exists(world, selected_)) {
        return;
    }
    ImGui::SameLine(ImGui::GetContentRegionMax().x - 92 * style.scale);
    draw_add_button(world);
    std::vector<ComponentId> components = world.components_of(selected_);
    std::ranges::sort(components, {}, [](ComponentId id) {  // ids differ from build to build
        const ComponentInfo& info = component_info(id);
        return std::tuple(is_internal(info), info.name != "transform", std::string_view(info.name));
    });
    for (const ComponentId id : components) {
        if (!exists(world, selected_)) {
            return;
        }
        draw_component(style, world, component_info(id));
    }
}

void Inspector::draw_tree_menu(World& world) {
    struct Item {
        const char* label;
        const char* keys;
        TreeCommand command;
        const char* tip;
    };
    static constexpr Item kItems[] = {
        {"Cut", "Ctrl X", TreeCommand::Cut, "makes it a root, which the next paste moves"},
        {"Copy", "Ctrl C", TreeCommand::Copy, "with its children"},
        {"Paste", "Ctrl V", TreeCommand::Paste, "below it; what was cut stays where it is"},
        {"Paste, keep the transform", "Ctrl Shift V", TreeCommand::PasteLocal,
         "below it, at the same place relative to its parent"},
        {"Duplicate", "Ctrl D", TreeCommand::Duplicate, "a copy beside it"},
        {"Delete", "Ctrl Del", TreeCommand::Delete, "with its children"}};
    for (const Item& item : kItems) {
        if (ImGui::MenuItem(item.label, item.keys)) {
            message_ = run(world, item.command);
        }
        if (ImGui::IsItemHovered()) {
            ImGui::SetTooltip("%s", item.tip);
        }
    }
}

void Inspector::draw_add_button(World& world) {
    if (ImGui::Button("Add ...", {-1, 0})) {
        ImGui::OpenPopup("##add");
    }
    if (!ImGui::BeginPopup("##add")) {
        return;
    }
    for (const ComponentInfo* info : all_components()) {
        if (world.has(selected_, info->id) || info->ops.construct_default == nullptr
            || is_internal(*info)) {
            continue;
        }
        if (ImGui::Selectable(info->name.c_str())) {
            Edit edit;
            edit.entity = selected_;
            edit.after = AnyComponent(*info);
            edit.label = fmt::format("{}: add {}", entity_label(world, selected_), info->name);
            apply_edit_value(world, edit, edit.after);
            undo_.record(std::move(edit));
        }
    }
    ImGui::EndPopup();
}

void Inspector::draw_place_button() {
    ImGui::BeginDisabled(level_.path.empty());
    const bool opens = ImGui::Button("Place ...", {-1, 0});
    ImGui::EndDisabled();
    if (opens) {
        const Result<std::vector<std::string>> names = prefab_names(level_.path);
        prefabs_ = names ? *names : std::vector<std::string>();
        no_prefabs_ = names ? "this level has no prefabs" : names.error().message;
        ImGui::OpenPopup("##place");
    }
    if (!ImGui::BeginPopup("##place")) {
        return;
    }
    for (const std::string& name : prefabs_) {
        if (ImGui::Selectable(name.c_str())) {
            placed_ = name;
        }
    }
    if (prefabs_.empty()) {
        ImGui::TextDisabled("%s", no_prefabs_.c_str());
    }
    ImGui::EndPopup();
}

void Inspector::draw_component(const HudStyle& style, World& world, const ComponentInfo& info) {
    ImGui::PushID(static_cast<int>(info.id));
    bool keep = true;
    const bool editable = is_editable(info);
    bool* const removable = is_internal(info) ? nullptr : &keep;
    const ImGuiTreeNodeFlags flags = info.is_registered && editable && !is_internal(info)
                                         ? ImGuiTreeNodeFlags_DefaultOpen
                                         : ImGuiTreeNodeFlags_None;
    if (info.storage == Storage::Toggle) {
        bool enabled = world.is_enabled(selected_, info.id);
        if (ImGui::Checkbox("##enabled", &enabled)) {
            world.set_enabled(selected_, info.id, enabled);
        }
        ImGui::SameLine();
    }
    if (info.is_tag || !editable) {
        ImGui::CollapsingHeader(info.name.c_str(), removable, flags | kNoFields);
    } else if (ImGui::CollapsingHeader(info.name.c_str(), removable, flags)) {
        Edit edit;
        edit.entity = selected_;
        const AnyComponent value = AnyComponent::read(world, selected_, info);
        draw_copy_menu(world, info, value.data());
        if (info.id == component_id<ParticleEmitter>) {
            draw_emitter(world);
        }
        if (info.id == component_id<MotionGraph>) {
            draw_graph(world);
        }
        if (info.id == component_id<Furrows> && ImGui::SmallButton("Edit furrows")) {
            furrows_ = true;
        }
        if (info.id == component_id<Skeleton> && ImGui::SmallButton("Show skeleton (Shift F2)")) {
            skeleton_ = true;
        }
        const std::string label = fmt::format("{}: {}", entity_label(world, selected_), info.name);
        edit_copy(style, world, std::move(edit), info, value.data(), label);
    }
    if (!keep && info.ops.construct_copy != nullptr) {
        Edit edit;
        edit.entity = selected_;
        edit.before = AnyComponent::read(world, selected_, info);
        edit.label = fmt::format("{}: remove {}", entity_label(world, selected_), info.name);
        world.remove(selected_, info.id);
        undo_.record(std::move(edit));
    }
    ImGui::PopID();
}

void Inspector::draw_emitter(World& world) {
    if (ImGui::SmallButton("Restart")) {
        restart_emitter(world, selected_);
    }
    ImGui::SameLine();
    if (ImGui::SmallButton("Step")) {
        step_ = true;
    }
    ImGui::SameLine();
    if (ImGui::SmallButton("New seed")) {
        Edit edit;
        edit.entity = selected_;
        edit.before = AnyComponent::read(world, selected_, component_info<ParticleEmitter>());
        edit.after = edit.before;
        std::uint32_t& seed = edit.after.as<ParticleEmitter>().seed;
        seed = next_seed(seed);
        edit.label = fmt::format("{}: particle_emitter.seed", entity_label(world, selected_));
        apply_edit_value(world, edit, edit.after);  // restarts it (emitter_restart.h)
        undo_.record(std::move(edit));
    }
    const EmitterCounts counts = count_particles(world, selected_);
    ImGui::TextColored(
        kHudDim, "%s",
        fmt::format(
            "{}{} of {} alive, {} born, ", counts.on_gpu ? "up to " : "", counts.alive,
            counts.capacity, counts.born)
            .c_str());
    ImGui::SameLine(0, 0);
    ImGui::TextColored(
        counts.dropped > 0 ? kHudBad : kHudDim, "%s",
        fmt::format("{} dropped", counts.dropped).c_str());
}

void Inspector::draw_graph(World& world) {
    const GraphView view = view_graph(world, selected_);
    for (std::size_t i = 0; i < view.events.size(); ++i) {
        if (i > 0) {
            ImGui::SameLine();
        }
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::SmallButton(view.events[i].c_str())) {
            send_graph_event(world, selected_, view.events[i]);
        }
        ImGui::PopID();
    }
    std::string text = fmt::format("{}  phase {:.2f}", view.state, view.phase);
    if (view.duration > 0) {
        text += fmt::format("  {:.2f} of {:.2f} s", view.clock, view.duration);
    }
    ImGui::TextColored(kHudDim, "%s", text.c_str());
    for (const auto& list : {view.clips, view.layers}) {
        for (const auto& [name, weight] : list) {
            ImGui::ProgressBar(weight, {80, 0}, fmt::format("{:.0f} %", 100 * weight).c_str());
            ImGui::SameLine();
            ImGui::TextColored(kHudDim, "%s", name.c_str());
        }
    }
}

void Inspector::edit_copy(
    const HudStyle& style, World& world, Edit edit, const ComponentInfo& info, const void* value,
    const std::string& label, const FoldedFields& folded) {
    edit.before = AnyComponent(info, value);
    AnyComponent after = edit.before;
    const FieldChange change = edit_fields(style, world, info, after.data(), folded);
    if (!change.clicked.is_null()) {
        select(change.clicked);
    }
    if (!change.changed) {
        return;
    }
    apply_edit_value(world, edit, after);
    edit.label = fmt::format("{}.{}", label, change.field);
    edit.after = std::move(after);
    if (dragging_ == edit.label) {
        undo_.extend(std::move(edit));
        return;
    }
    dragging_ = ImGui::IsAnyItemActive() ? edit.label : "";
    undo_.record(std::move(edit));
}

void Inspector::draw_resources(const HudStyle& style, World& world) {
    draw_search("search by name or field", resource_search_);
    ImGui::BeginChild("##resources");
    for (const ComponentId id : world.resources()) {
        const ComponentInfo& info = component_info(id);
        if (!matches(info, resource_search_)) {
            continue;
        }
        ImGui::PushID(static_cast<int>(id));
        if (!is_editable(info)) {
            ImGui::CollapsingHeader(info.name.c_str(), kNoFields);
        } else if (ImGui::CollapsingHeader(info.name.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) {
            draw_copy_menu(world, info, std::as_const(world).find_resource(id));
            Edit edit;
            edit.part = LevelPart::Resource;
            edit_copy(
                style, world, std::move(edit), info, std::as_const(world).find_resource(id),
                info.name);
        }
        ImGui::PopID();
    }
    ImGui::EndChild();
}

void Inspector::draw_materials(const HudStyle& style, World& world) {
    const Assets* assets = std::as_const(world).find_resource<Assets>();
    if (assets == nullptr || assets->materials.empty()) {
        ImGui::TextDisabled("this level has no materials");
        return;
    }
    const std::uint32_t count = static_cast<std::uint32_t>(assets->materials.size());
    const auto* const instance =
        world.alive(selected_) ? std::as_const(world).find<MeshInstance>(selected_) : nullptr;
    if (std::exchange(material_of_, selected_) != selected_ && instance != nullptr
        && instance->material.index < count) {
        material_ = instance->material.index;
    }
    material_ = std::min(material_, count - 1);
    draw_search("search by name", material_search_);
    ImGui::BeginChild("##list", {0, 0.32f * ImGui::GetContentRegionAvail().y});
    for (std::uint32_t i = 0; i < count; ++i) {
        const Material& material = assets->materials[i];
        if (!contains(material.name, material_search_)) {
            continue;
        }
        ImGui::PushID(static_cast<int>(i));
        const ImVec4 swatch = {
            srgb_from_linear(material.base_color.x), srgb_from_linear(material.base_color.y),
            srgb_from_linear(material.base_color.z), 1.0f};
        const float side = ImGui::GetTextLineHeight();
        ImGui::ColorButton("##swatch", swatch, ImGuiColorEditFlags_NoTooltip, {side, side});
        ImGui::SameLine();
        const std::string label =
            material.name.empty() ? fmt::format("material {}", i) : material.name;
        if (ImGui::Selectable(label.c_str(), i == material_)) {
            material_ = i;
        }
        ImGui::PopID();
    }
    ImGui::EndChild();
    ImGui::Separator();
    ImGui::BeginChild("##material");
    Edit edit;
    edit.part = LevelPart::Material;
    edit.material = material_;
    const Material& material = assets->materials[material_];
    ImGui::PushID(static_cast<int>(material_));
    const ShadingModel model = material.shading;
    const FoldedFields unused = {
        .heading = fmt::format(
            "not used by {}##unused", kShadingModels[static_cast<std::size_t>(model)].name),
        .is_one = [model](std::string_view field) { return !reads_field(model, field); }};
    edit_copy(
        style, world, std::move(edit), component_info<Material>(), &material, material.name,
        unused);
    ImGui::PopID();
    ImGui::EndChild();
}

}  // namespace limn
