#include "content/app/panels/marker_panel.h"

#include "content/app/panels/furrow_panel.h"
#include "content/app/panels/hud_style.h"
#include "content/app/player/label_layout.h"
#include "content/app/player/pick.h"
#include "content/app/player/posed_mesh.h"
#include "content/app/player/world_lines.h"
#include "content/load/faces/marker_file.h"
#include "content/load/faces/marker_import.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/text.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/render_view.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>

// Techniques: face.retarget-fit

namespace limn {
namespace {

constexpr Vec3 kMappedColor = {1.0f, 0.72f, 0.25f};
constexpr Vec3 kNamedColor = {0.45f, 0.75f, 1.0f};
constexpr Vec3 kSelectedMarkerColor = {1.0f, 1.0f, 1.0f};
constexpr ImU32 kUnplacedDot = IM_COL32(150, 155, 165, 255);
constexpr float kVisibleMotion = 0.2f;  // of a shape's largest motion: what belongs to the face
constexpr float kCloudSize = 210.0f;    // of the front view, in units of the layout
constexpr float kDotReach = 9.0f;       // of a click on it, in units of the layout

ImU32 to_imgui_color(const Vec3& color) {
    return ImGui::GetColorU32({color.x, color.y, color.z, 1.0f});
}

Result<std::string> read_map(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// Positions of the vertices as the skin is drawn.
std::vector<Vec3> drawn_positions(const World& world, Entity skin, const MeshData& mesh) {
    std::vector<Vec3> positions = posed_positions(world, skin);
    return positions.empty() ? mesh.positions : positions;
}

}  // namespace

Status MarkerPanel::load(const std::string& take, const std::string& map) {
    MarkerMotion motion = LIMN_TRY(load_trc(take));
    motion = LIMN_TRY(isolate_face(std::filesystem::path(take).stem().string(), std::move(motion)));
    const std::string file =
        map.empty() ? std::filesystem::path(take).replace_extension(".map").string() : map;
    std::vector<FaceMarkerPlace> places;
    if (std::filesystem::exists(file)) {
        const std::string text = LIMN_TRY(read_map(file));
        places = LIMN_TRY(parse_marker_map(text, file));
        LIMN_TRY(check_marker_map(motion.names, places, file));
    }
    for (const std::string& name : motion.names) {
        if (name.find_first_of("#=") != std::string::npos) {
            return fail(
                "{}: marker \"{}\": found # or =, expected a name that a map can hold", take, name);
        }
    }
    take_ = take;
    map_ = file;
    rest_.assign(
        motion.positions.begin(),
        motion.positions.begin() + static_cast<std::ptrdiff_t>(motion.markers()));
    names_ = std::move(motion.names);
    points_.assign(names_.size(), std::nullopt);
    places_ = std::move(places);
    return Done{};
}

const MeshData* MarkerPanel::skin_mesh(const World& world) const {
    const auto* const assets = world.find_resource<Assets>();
    const auto* const instance = world.alive(skin_) ? world.find<MeshInstance>(skin_) : nullptr;
    return assets != nullptr && instance != nullptr && instance->mesh.index < assets->meshes.size()
               ? &assets->meshes[instance->mesh.index]
               : nullptr;
}

Status MarkerPanel::open(const World& world, Entity entity) {
    if (names_.empty()) {
        return fail("found no recording, expected limn play --markers TAKE.trc");
    }
    const auto* const assets = world.find_resource<Assets>();
    Entity found;
    std::size_t most = 0;
    world.query<const MeshInstance, const WorldTransform>().each(
        [&](Entity each, const MeshInstance& instance, const WorldTransform&) {
            if (assets == nullptr || instance.mesh.index >= assets->meshes.size()) {
                return;
            }
            const std::size_t moved = count_moved(assets->meshes[instance.mesh.index]);
            const bool is_chosen = moved > 0 && each == entity;
            if (is_chosen || moved > most) {
                most = is_chosen ? std::numeric_limits<std::size_t>::max() : moved;
                found = each;
            }
        });
    if (found.is_null()) {
        return fail("found no mesh with shapes, expected a face to place the markers on");
    }
    skin_ = found;
    update_points(world);
    return Done{};
}

std::optional<FacePlace> MarkerPanel::find_face(const World& world) const {
    const MeshData* const mesh = skin_mesh(world);
    const auto* const transform = mesh != nullptr ? world.find<WorldTransform>(skin_) : nullptr;
    if (transform == nullptr) {
        return std::nullopt;
    }
    Bounds box;
    for (const MorphTarget& morph : mesh->morphs) {
        float largest = 0.0f;
        for (const Vec3& offset : morph.positions) {
            largest = std::max(largest, glm::length(offset));
        }
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            if (glm::length(morph.positions[i]) > kVisibleMotion * largest) {
                grow(box, transform_point(transform->world, mesh->positions[morph.vertices[i]]));
            }
        }
    }
    return FacePlace{
        center(box), normalize_or(transform_vector(transform->world, {0, 0, 1}), {0, 0, 1}),
        glm::length(half_extent(box))};
}

bool MarkerPanel::is_mapped(std::size_t marker) const {
    return std::ranges::find(places_, names_[marker], &FaceMarkerPlace::marker) != places_.end();
}

void MarkerPanel::update_points(const World& world) {
    const MeshData* const mesh = skin_mesh(world);
    for (std::size_t m = 0; m < names_.size() && mesh != nullptr; ++m) {
        const auto line = std::ranges::find(places_, names_[m], &FaceMarkerPlace::marker);
        std::optional<Vec3> at;
        if (line != places_.end() && line->place.empty()) {
            at = line->point;
        } else {
            at = find_named_place(*mesh, line != places_.end() ? line->place : names_[m]);
        }
        points_[m] = at ? std::optional(nearest_on_mesh(*mesh, *at)) : std::nullopt;
    }
}

void MarkerPanel::change(const World& world, std::vector<FaceMarkerPlace> places) {
    past_.push_back(std::exchange(places_, std::move(places)));
    unsaved_ = true;
    update_points(world);
}

bool MarkerPanel::place(const World& world, const Ray& ray) {
    const MeshData* const mesh = skin_mesh(world);
    const auto* const transform = mesh != nullptr ? world.find<WorldTransform>(skin_) : nullptr;
    if (transform == nullptr || glm::determinant(Mat3(to_mat4(transform->world))) == 0.0f) {
        return false;
    }
    const Affine mesh_from_world = to_affine(glm::inverse(to_mat4(transform->world)));
    const auto hit = hit_mesh_at(
        *mesh, drawn_positions(world, skin_, *mesh), transform_point(mesh_from_world, ray.origin),
        transform_vector(mesh_from_world, ray.direction));
    if (!hit) {
        return false;
    }
    std::vector<FaceMarkerPlace> places = places_;
    std::erase_if(
        places, [&](const FaceMarkerPlace& place) { return place.marker == names_[selected_]; });
    FaceMarkerPlace& added = places.emplace_back();
    added.marker = names_[selected_];
    added.point = position_on(*hit, mesh->positions);
    change(world, std::move(places));
    for (std::size_t i = 1; i < names_.size(); ++i) {
        const std::size_t next = (selected_ + i) % names_.size();
        if (!points_[next]) {
            selected_ = next;
            return true;
        }
    }
    message_ = "every marker has a place";
    return true;
}

void MarkerPanel::remove_place(const World& world) {
    if (!is_mapped(selected_)) {
        return;
    }
    std::vector<FaceMarkerPlace> places = places_;
    std::erase_if(
        places, [&](const FaceMarkerPlace& place) { return place.marker == names_[selected_]; });
    change(world, std::move(places));
}

bool MarkerPanel::undo(const World& world) {
    if (past_.empty()) {
        return false;
    }
    places_ = std::move(past_.back());
    past_.pop_back();
    unsaved_ = true;
    update_points(world);
    return true;
}

void MarkerPanel::save() {
    std::string text = "# Places of the markers of " + take_ + " on a face [m]\n";
    if (std::filesystem::exists(map_)) {
        const Result<std::string> before = read_map(map_);
        text = before ? *before : text;
    }
    const Status saved = write_file(map_, write_marker_map(text, places_));
    unsaved_ = unsaved_ && !saved;
    message_ = saved ? fmt::format("{}: {} places, for --map of limn import", map_, places_.size())
                     : saved.error().message;
}

bool MarkerPanel::take_pointer(
    const World& world, const RenderView& view, const PanelPointer& pointer) {
    if (!is_open() || pointer.blocked || !pointer.clicked) {
        return false;
    }
    return place(world, ray_through(view, pointer.at / Vec2(glm::max(pointer.window, IVec2(1)))));
}

void MarkerPanel::draw_overlay(const RenderView& view, const World& world) const {
    const MeshData* const mesh = skin_mesh(world);
    const auto* const transform = mesh != nullptr ? world.find<WorldTransform>(skin_) : nullptr;
    if (transform == nullptr) {
        return;
    }
    const std::vector<Vec3> positions = drawn_positions(world, skin_, *mesh);
    const Vec3 eye = transform_point(view.world_from_camera, Vec3(0));
    LabelLayout layout;
    const auto draw_marker = [&](std::size_t m) {
        if (!points_[m]) {
            return;
        }
        const Vec3 at = transform_point(transform->world, position_on(*points_[m], positions));
        const Vec3 outward = transform_vector(
            transform->world, position_on(*points_[m], std::span<const Vec3>(mesh->normals)));
        const bool faces = glm::dot(outward, eye - at) > 0.0f;
        const bool is_selected = m == selected_;
        const Vec3& color = is_selected    ? kSelectedMarkerColor
                            : is_mapped(m) ? kMappedColor
                                           : kNamedColor;
        WorldLines lines(view, color, faces || is_selected ? 0.95f : 0.2f);
        lines.draw_point(at, is_selected ? 5.0f : 3.5f);
        if (faces || is_selected) {
            lines.draw_label(at, names_[m], layout);
        }
    };
    draw_marker(selected_);
    for (std::size_t m = 0; m < names_.size(); ++m) {
        if (m != selected_) {
            draw_marker(m);
        }
    }
}

/// The recording's first frame from the front; a click selects.
void MarkerPanel::draw_cloud(const HudStyle& style) {
    const float size = kCloudSize * style.scale;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::InvisibleButton("##cloud", {width, size});
    ImDrawList* const list = ImGui::GetWindowDrawList();
    list->AddRectFilled(
        corner, {corner.x + width, corner.y + size}, ImGui::GetColorU32(ImGuiCol_FrameBg),
        ImGui::GetStyle().FrameRounding);
    Bounds box;
    for (const Vec3& p : rest_) {
        grow(box, p);
    }
    const Vec3 half = glm::max(half_extent(box), Vec3(1e-6f));
    const float scale = 0.42f * std::min(width / half.x, size / half.y);
    std::optional<std::size_t> nearest;
    float reach = kDotReach * style.scale;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::vector<ImVec2> dots;
    for (std::size_t m = 0; m < rest_.size(); ++m) {
        const Vec3 from_center = scale * (rest_[m] - center(box));
        dots.push_back(
            {corner.x + 0.5f * width + from_center.x, corner.y + 0.5f * size - from_center.y});
        const float away = glm::distance(Vec2(dots[m].x, dots[m].y), Vec2(mouse.x, mouse.y));
        if (ImGui::IsItemHovered() && away < reach) {
            reach = away;
            nearest = m;
        }
    }
    for (std::size_t m = 0; m < dots.size(); ++m) {
        const ImU32 color = is_mapped(m) ? to_imgui_color(kMappedColor)
                            : points_[m] ? to_imgui_color(kNamedColor)
                                         : kUnplacedDot;
        const float radius = (m == nearest ? 4.5f : 3.0f) * style.scale;
        list->AddCircleFilled(dots[m], radius, color);
        if (m == selected_) {
            list->AddCircle(
                dots[m], 6.0f * style.scale, to_imgui_color(kSelectedMarkerColor), 0, 1.5f);
        }
    }
    if (nearest) {
        ImGui::SetTooltip("%s", names_[*nearest].c_str());
        selected_ = ImGui::IsItemClicked() ? *nearest : selected_;
    }
}

void MarkerPanel::draw_list(const HudStyle& style) {
    ImGui::BeginChild("##markers", {0, 170.0f * style.scale}, true);
    for (std::size_t m = 0; m < names_.size(); ++m) {
        const auto line = std::ranges::find(places_, names_[m], &FaceMarkerPlace::marker);
        const std::string place = line == places_.end() ? (points_[m] ? "by its name" : "no place")
                                  : line->place.empty() ? "placed"
                                                        : line->place;
        ImGui::PushID(static_cast<int>(m));
        if (ImGui::Selectable(names_[m].c_str(), m == selected_)) {
            selected_ = m;
        }
        ImGui::SameLine(150.0f * style.scale);
        ImGui::TextColored(points_[m] ? kHudDim : kHudAccent, "%s", place.c_str());
        ImGui::PopID();
    }
    ImGui::EndChild();
}

void MarkerPanel::draw(const HudStyle& style, const World& world) {
    if (!is_open()) {
        return;
    }
    const float margin = 14.0f * style.scale;
    const float width = 290.0f * style.scale;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(
        {display.x - margin, margin}, ImGuiCond_FirstUseEver, ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, display.y - 2 * margin});
    bool stays_open = true;
    if (ImGui::Begin(
            "Markers", &stays_open,
            ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize)) {
        const auto placed =
            std::ranges::count_if(points_, [](const auto& p) { return p.has_value(); });
        ImGui::Text(
            "%d of %d have a place", static_cast<int>(placed), static_cast<int>(names_.size()));
        draw_cloud(style);
        draw_list(style);
        ImGui::TextWrapped("Click on the face where %s is.", names_[selected_].c_str());
        if (ImGui::Button("Undo")) {
            (void)undo(world);
        }
        ImGui::SameLine();
        if (ImGui::Button("Remove")) {
            remove_place(world);
        }
        ImGui::SameLine();
        if (ImGui::Button(unsaved_ ? "Save *" : "Save")) {
            save();
        }
        ImGui::TextColored(kHudDim, "%s", map_.c_str());
    }
    ImGui::End();
    if (!stays_open) {
        close();
    }
}

}  // namespace limn
