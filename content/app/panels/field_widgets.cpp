#include "content/app/panels/field_widgets.h"

#include "content/app/panels/hud_style.h"
#include "content/app/panels/key_widgets.h"
#include "content/load/asset_lists.h"
#include "content/load/level/component_json.h"
#include "ecs/base/srgb.h"
#include "ecs/components/camera.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstring>

namespace limn {
namespace {

constexpr double kSliderRange = 100.0;    // wider ranges are dragged: a slider would be too coarse
constexpr std::size_t kMaxElements = 64;  // of a list that are shown
constexpr float kDegrees = 57.29577951f;  // of a radian

/// Input of the widgets of one component, and what they report.
struct Context {
    const HudStyle& style;
    const World& world;
    FieldChange change;
};

bool is_angle(const FieldInfo& field) {
    return std::strcmp(field.meta.unit, "rad") == 0;
}
bool is_angular_speed(const FieldInfo& field) {
    return std::strcmp(field.meta.unit, "rad/s") == 0;
}

/// Finite limits in the widget's unit; `scale` converts from the field's unit.
struct WidgetRange {
    float min = -FLT_MAX;
    float max = FLT_MAX;
    bool slider = false;
    float speed = 0.01f;
};

WidgetRange widget_range(const FieldInfo& field, float scale, float value) {
    WidgetRange range;
    const bool has_min = std::isfinite(field.meta.min);
    const bool has_max = std::isfinite(field.meta.max);
    range.min = has_min ? static_cast<float>(field.meta.min) * scale : range.min;
    range.max = has_max ? static_cast<float>(field.meta.max) * scale : range.max;
    range.slider = has_min && has_max && field.meta.max - field.meta.min <= kSliderRange;
    range.speed = std::max(std::abs(value) * 0.005f, 0.002f) * std::max(scale * 0.1f, 1.0f);
    return range;
}

const char* number_format(float scale, float value) {
    if (scale > 1.0f) {
        return "%.1f°";
    }
    const float size = std::abs(value);
    return size >= 1000.0f ? "%.0f" : (size >= 10.0f ? "%.2f" : "%.4g");
}

/// `count` floats in one row.
bool edit_floats(const FieldInfo& field, float* values, int count) {
    const bool angle = is_angle(field) || is_angular_speed(field);
    const float scale = angle ? kDegrees : 1.0f;
    std::array<float, 4> shown = {};
    float largest = 0.0f;
    for (int i = 0; i < count; ++i) {
        shown[static_cast<std::size_t>(i)] = values[i] * scale;
        largest = std::max(largest, std::abs(values[i] * scale));
    }
    const WidgetRange range = widget_range(field, scale, largest);
    const char* format = number_format(scale, largest);
    const bool changed =
        range.slider && count == 1
            ? ImGui::SliderFloat(
                "##value", shown.data(), range.min, range.max, format, ImGuiSliderFlags_AlwaysClamp)
            : ImGui::DragScalarN(
                "##value", ImGuiDataType_Float, shown.data(), count, range.speed, &range.min,
                &range.max, format, ImGuiSliderFlags_AlwaysClamp);
    for (int i = 0; changed && i < count; ++i) {
        const float value = shown[static_cast<std::size_t>(i)] / scale;
        if (std::isfinite(value)) {
            // Rounding in the conversion to degrees must not exceed the field's own limits.
            values[i] = std::clamp(
                value, static_cast<float>(std::max(field.meta.min, -static_cast<double>(FLT_MAX))),
                static_cast<float>(std::min(field.meta.max, static_cast<double>(FLT_MAX))));
        }
    }
    return changed;
}

/// A linear color, and beside it a swatch in sRGB that opens a picker.
bool edit_color(const FieldInfo& field, float* values, int count) {
    std::array<float, 4> shown = {0, 0, 0, 1};
    for (int i = 0; i < count; ++i) {
        shown[static_cast<std::size_t>(i)] = i < 3 ? srgb_from_linear(values[i]) : values[i];
    }
    constexpr const char* kLabel = "sRGB";
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float side = ImGui::GetFrameHeight();
    ImGui::SetNextItemWidth(
        ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(kLabel).x - side - 2 * gap);
    const bool typed = edit_floats(field, values, count);
    ImGui::SameLine(0, gap);
    const ImGuiColorEditFlags flags = ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR
                                      | ImGuiColorEditFlags_AlphaPreviewHalf
                                      | ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel;
    const bool picked = count == 4 ? ImGui::ColorEdit4("##swatch", shown.data(), flags)
                                   : ImGui::ColorEdit3("##swatch", shown.data(), flags);
    ImGui::SameLine(0, gap);
    ImGui::TextColored(kHudDim, "%s", kLabel);
    for (int i = 0; picked && i < count; ++i) {
        const float value = shown[static_cast<std::size_t>(i)];
        const float linear = i < 3 ? linear_from_srgb(value) : value;
        if (std::isfinite(linear)) {
            values[i] = std::clamp(
                linear, static_cast<float>(std::max(field.meta.min, -static_cast<double>(FLT_MAX))),
                static_cast<float>(std::min(field.meta.max, static_cast<double>(FLT_MAX))));
        }
    }
    return typed || picked;
}

bool edit_quaternion(Quat& rotation) {
    Vec3 angles = degrees_from_rotation(rotation);
    const float limit = 360.0f;
    const float none = -limit;
    const bool changed = ImGui::DragScalarN(
        "##value", ImGuiDataType_Float, &angles.x, 3, 0.5f, &none, &limit, "%.1f°");
    if (changed && std::isfinite(angles.x + angles.y + angles.z)) {
        angles.y = std::clamp(angles.y, -89.9f, 89.9f);
        rotation = rotation_from_degrees(angles);
    }
    return changed;
}

/// Integers of any width.
bool edit_integer(const FieldInfo& field, void* element) {
    double value = get_number(field, element);
    const double before = value;
    const double lowest = field.type == FieldType::UInt ? 0.0 : -1e15;
    const double min = std::max(field.meta.min, lowest);
    const double max = std::min(field.meta.max, 1e15);
    const float speed = static_cast<float>(std::max(std::abs(value) * 0.005, 0.1));
    if (!ImGui::DragScalar(
            "##value", ImGuiDataType_Double, &value, speed, &min, &max, "%.0f",
            ImGuiSliderFlags_AlwaysClamp)) {
        return false;
    }
    value = std::round(value);
    return value != before && set_number(field, element, value).ok();
}

bool edit_integers(const FieldInfo& field, int* values, int count) {
    static_cast<void>(field);
    return ImGui::DragScalarN("##value", ImGuiDataType_S32, values, count, 0.1f);
}

bool edit_enum(const FieldInfo& field, void* element) {
    const std::string_view current = get_enum(field, element);
    bool changed = false;
    std::array<char, 64> label;
    *fmt::format_to_n(label.data(), label.size() - 1, "{}", current).out = '\0';
    if (!ImGui::BeginCombo("##value", label.data())) {
        return false;
    }
    for (const std::string_view name : field.values) {
        *fmt::format_to_n(label.data(), label.size() - 1, "{}", name).out = '\0';
        if (ImGui::Selectable(label.data(), name == current) && name != current) {
            changed = set_enum(field, element, name).ok();
        }
    }
    ImGui::EndCombo();
    return changed;
}

const std::string*
asset_name(const WorldAssetLists& assets, std::string_view kind, std::uint32_t index) {
    const std::string* name = nullptr;
    visit_asset_list(assets, kind, [&](const auto& list) {
        name = index < list.size() ? &list[index].name : nullptr;
    });
    return name;
}

std::size_t asset_count(const WorldAssetLists& assets, std::string_view kind) {
    std::size_t count = 0;
    visit_asset_list(assets, kind, [&](const auto& list) { count = list.size(); });
    return count;
}

void format_asset(
    std::array<char, 128>& label, const WorldAssetLists& assets, std::string_view kind,
    std::uint32_t index) {
    const std::string* name = asset_name(assets, kind, index);
    const auto result = name == nullptr ? fmt::format_to_n(label.data(), label.size() - 1, "none")
                        : name->empty()
                            ? fmt::format_to_n(label.data(), label.size() - 1, "{} {}", kind, index)
                            : fmt::format_to_n(label.data(), label.size() - 1, "{}", *name);
    *result.out = '\0';
}

bool edit_asset(const Context& context, const FieldInfo& field, void* element) {
    const WorldAssetLists assets = list_assets(context.world);
    std::uint32_t& index = *static_cast<std::uint32_t*>(element);
    std::array<char, 128> label;
    format_asset(label, assets, field.asset, index);
    bool changed = false;
    if (!ImGui::BeginCombo("##value", label.data())) {
        return false;
    }
    const int count = static_cast<int>(asset_count(assets, field.asset));
    ImGuiListClipper clipper;
    clipper.Begin(count);
    while (clipper.Step()) {
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            ImGui::PushID(i);
            format_asset(label, assets, field.asset, static_cast<std::uint32_t>(i));
            const bool selected = static_cast<std::uint32_t>(i) == index;
            if (ImGui::Selectable(label.data(), selected) && !selected) {
                index = static_cast<std::uint32_t>(i);
                changed = true;
            }
            ImGui::PopID();
        }
    }
    ImGui::EndCombo();
    return changed;
}

void show_entity(Context& context, const void* element) {
    const Entity entity = *static_cast<const Entity*>(element);
    if (entity.is_null()) {
        ImGui::TextDisabled("none");
    } else if (!context.world.alive(entity)) {
        ImGui::TextDisabled("gone");
    } else if (ImGui::SmallButton(entity_label(context.world, entity).c_str())) {
        context.change.clicked = entity;
    }
}

void show_matrix(const HudStyle& style, const FieldInfo& field, const void* element) {
    const bool rows = field.type == FieldType::Affine;
    const int height = field.type == FieldType::Mat4 ? 4 : 3;
    const int width = rows || field.type == FieldType::Mat4 ? 4 : 3;
    ImGui::PushFont(style.numbers);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double value = get_number(field, element, rows ? y * width + x : x * height + y);
            if (x > 0) {
                ImGui::SameLine();
            }
            ImGui::TextColored(kHudDim, "%7.2f", value);
        }
    }
    ImGui::PopFont();
}

/// The widget for one element; true if it changed.
bool edit_element(Context& context, const FieldInfo& field, void* element) {
    ImGui::SetNextItemWidth(-1);
    float* const floats = static_cast<float*>(element);
    switch (field.type) {
    case FieldType::Bool:
        return ImGui::Checkbox("##value", static_cast<bool*>(element));
    case FieldType::Float:
        return edit_floats(field, floats, 1);
    case FieldType::Vec2:
        return edit_floats(field, floats, 2);
    case FieldType::Vec3:
        return field.meta.color ? edit_color(field, floats, 3) : edit_floats(field, floats, 3);
    case FieldType::Vec4:
        return field.meta.color ? edit_color(field, floats, 4) : edit_floats(field, floats, 4);
    case FieldType::Quat:
        return edit_quaternion(*static_cast<Quat*>(element));
    case FieldType::Double:
        return ImGui::DragScalar("##value", ImGuiDataType_Double, element, 0.01f);
    case FieldType::Int:
    case FieldType::UInt:
        return edit_integer(field, element);
    case FieldType::IVec2:
        return edit_integers(field, static_cast<int*>(element), 2);
    case FieldType::IVec3:
        return edit_integers(field, static_cast<int*>(element), 3);
    case FieldType::String:
        return ImGui::InputText("##value", static_cast<std::string*>(element));
    case FieldType::Enum:
        return edit_enum(field, element);
    case FieldType::Asset:
        return edit_asset(context, field, element);
    case FieldType::Entity:
        show_entity(context, element);
        return false;
    case FieldType::Mat3:
    case FieldType::Mat4:
    case FieldType::Affine:
        show_matrix(context.style, field, element);
        return false;
    case FieldType::Struct:
        break;
    }
    return false;
}

/// Left column: the name, with documentation and range as its tooltip.
void draw_name(const FieldInfo& field, const char* name) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(kHudDim, "%s", name);
    if (!ImGui::IsItemHovered() || field.meta.doc[0] == '\0') {
        return;
    }
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(field.meta.doc);
    const std::string range = range_text(field.meta);
    if (!range.empty()) {
        ImGui::TextColored(kHudDim, "%s", range.c_str());
    }
    ImGui::EndTooltip();
}

/// A table of names and widgets, open only across consecutive fields that are not structs or lists.
class FieldTable {
  public:
    FieldTable() = default;
    FieldTable(const FieldTable&) = delete;
    FieldTable& operator=(const FieldTable&) = delete;
    ~FieldTable() { close(); }

    [[nodiscard]] bool row() {
        if (!open_) {
            open_ = ImGui::BeginTable("##fields", 2, ImGuiTableFlags_SizingStretchProp);
            if (open_) {
                ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 0.36f);
                ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.64f);
            }
        }
        return open_;
    }
    void close() {
        if (open_) {
            ImGui::EndTable();
        }
        open_ = false;
    }

  private:
    bool open_ = false;
};

void edit_field_rows(Context& context, const std::vector<FieldInfo>& fields, void* around);

void edit_one(
    Context& context, FieldTable& table, const FieldInfo& field, const char* name, void* element) {
    if (field.type == FieldType::Struct) {
        table.close();
        if (ImGui::TreeNodeEx(name, ImGuiTreeNodeFlags_SpanFullWidth)) {
            edit_field_rows(context, field.fields, element);
            ImGui::TreePop();
        }
        return;
    }
    if (!table.row()) {
        return;
    }
    draw_name(field, name);
    ImGui::TableNextColumn();
    ImGui::PushID(name);
    if (edit_element(context, field, element)) {
        context.change.changed = true;
        context.change.field = field.name;
    }
    ImGui::PopID();
}

void edit_elements(Context& context, FieldTable& table, const FieldInfo& field, void* data) {
    const std::size_t count = element_count(field, data);
    std::array<char, 96> name;
    *fmt::format_to_n(name.data(), name.size() - 1, "{} ({})###{}", field.name, count, field.name)
         .out = '\0';
    table.close();
    const bool has_plot = is_key_list(field);
    if (!ImGui::TreeNodeEx(
            name.data(), ImGuiTreeNodeFlags_SpanFullWidth
                             | (has_plot && count > 0 ? ImGuiTreeNodeFlags_DefaultOpen : 0))) {
        return;
    }
    if (has_plot) {
        if (edit_key_list(context.style, field, data)) {
            context.change.changed = true;
            context.change.field = field.name;
        }
        ImGui::TreePop();
        return;
    }
    FieldTable elements;
    for (std::size_t i = 0; i < std::min(count, kMaxElements); ++i) {
        *fmt::format_to_n(name.data(), name.size() - 1, "{}", i).out = '\0';
        edit_one(context, elements, field, name.data(), element_ptr(field, data, i));
    }
    elements.close();
    ImGui::TreePop();
}

void edit_field_row(Context& context, FieldTable& table, const FieldInfo& field, void* around) {
    void* const data = field_ptr(around, field);
    if (field.shape == FieldShape::One) {
        edit_one(context, table, field, field.name, data);
    } else {
        edit_elements(context, table, field, data);
    }
}

void edit_field_rows(Context& context, const std::vector<FieldInfo>& fields, void* around) {
    FieldTable table;
    for (const FieldInfo& field : fields) {
        edit_field_row(context, table, field, around);
    }
}

}  // namespace

FieldChange edit_fields(
    const HudStyle& style, const World& world, const ComponentInfo& info, void* object,
    const FoldedFields& folded) {
    Context context{.style = style, .world = world, .change = {}};
    if (folded.heading.empty()) {
        edit_field_rows(context, info.fields, object);
        return context.change;
    }
    const auto edit_some = [&](bool are_folded) {
        FieldTable table;
        for (const FieldInfo& field : info.fields) {
            if (folded.is_one(field.name) == are_folded) {
                edit_field_row(context, table, field, object);
            }
        }
    };
    edit_some(false);
    if (ImGui::TreeNodeEx(folded.heading.c_str(), ImGuiTreeNodeFlags_SpanFullWidth)) {
        edit_some(true);
        ImGui::TreePop();
    }
    return context.change;
}

std::string entity_label(const World& world, Entity entity) {
    const Name* name = world.find<Name>(entity);
    if (name != nullptr && !name->text.empty()) {
        return name->text;
    }
    // Unnamed: by its mesh or kind.
    const char* kind = world.has<PointLight>(entity)         ? "point light"
                       : world.has<SpotLight>(entity)        ? "spot light"
                       : world.has<DirectionalLight>(entity) ? "sun"
                       : world.has<Camera>(entity)           ? "camera"
                                                             : "entity";
    const MeshInstance* instance = world.find<MeshInstance>(entity);
    const std::string* mesh = instance != nullptr
                                  ? asset_name(list_assets(world), "mesh", instance->mesh.index)
                                  : nullptr;
    return fmt::format(
        "{} {}", mesh != nullptr && !mesh->empty() ? mesh->c_str() : kind, entity.index);
}

}  // namespace limn
