#pragma once

#include "ecs/reflect.h"

namespace limn {

struct HudStyle;

// ImGui widgets for lists of keys: a plot of a curve, and a gradient with its stops below it. A
// drag moves a key, a double click adds one, a right click or Delete removes one. The numbers of
// the selected key are below.

/// Whether the field is a list of CurveKey or ColorKey.
[[nodiscard]] bool is_key_list(const FieldInfo& field);

/// Draws the list `data` of such a field and edits it in place; true if it has changed.
bool edit_key_list(const HudStyle& style, const FieldInfo& field, void* data);

}  // namespace limn
