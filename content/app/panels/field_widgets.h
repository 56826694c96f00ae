#pragma once

#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <functional>
#include <string>
#include <string_view>

namespace limn {

class World;
struct HudStyle;

// ImGui widgets for the fields of any component, from its reflection: sliders where a range is
// known, drags where it is not, degrees for radians, linear colors with a swatch in sRGB, combos
// for enums and assets, yaw-pitch-roll for quaternions, plots for curves and gradients
// (key_widgets.h). Values stay within their range.

/// What the user did to the fields drawn.
struct FieldChange {
    bool changed = false;    ///< a value was edited in this frame
    const char* field = "";  ///< name of the last field that changed; lives as long as the program
    Entity clicked;          ///< the entity whose link was clicked, or null
};

/// Fields that are drawn last, under an initially collapsed heading.
struct FoldedFields {
    std::string heading;                                ///< empty: no such fields
    std::function<bool(std::string_view name)> is_one;  ///< for outermost fields
};

/// Draws the fields of `object` as rows of name and widget, and edits it in place. `world` gives
/// names to entities and assets.
FieldChange edit_fields(
    const HudStyle& style, const World& world, const ComponentInfo& info, void* object,
    const FoldedFields& folded = {});

/// Its name, or its mesh or kind with its index: "teapot 12", "point light 3", "entity 7".
[[nodiscard]] std::string entity_label(const World& world, Entity entity);

}  // namespace limn
