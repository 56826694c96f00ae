#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"

#include <cstddef>
#include <vector>

namespace limn {

// Editing of curves and gradients with a pointer, apart from how they are drawn (key_widgets.h).
// Lists are kept in order of `at`.

inline constexpr std::size_t kMaxEditedKeys = 8;  ///< limit when adding: shaders read no more

/// Screen area of the keys: `at` 0 .. 1 from left to right, values 0 .. `top` upward. The keys
/// of a gradient have no height.
struct KeyPlot {
    Vec2 corner = {0, 0};   ///< top left [pixels]
    Vec2 size = {100, 50};  ///< > 0 [pixels]
    float top = 1;          ///< value at the upper edge, > 0
    float pick_radius = 8;  ///< within which the pointer selects a key [pixels]
};

/// User input of one frame.
struct KeyInput {
    Vec2 pointer = {0, 0};        ///< [pixels]
    bool pressed = false;         ///< left button down since this frame: selects a key
    bool held = false;            ///< left button down: the selected key follows
    bool double_clicked = false;  ///< adds a key, if there is none
    bool right_clicked = false;   ///< removes the key under the pointer
    bool removes = false;         ///< Delete: removes the selected key
};

/// The smallest power of two that is at least the largest value and at least 1.
[[nodiscard]] float plot_top(const std::vector<CurveKey>& keys);

[[nodiscard]] Vec2 key_position(const KeyPlot& plot, const CurveKey& key);
[[nodiscard]] Vec2 key_position(const KeyPlot& plot, const ColorKey& key);

/// Index of the key nearest to the pointer, within the pick radius; -1: none.
[[nodiscard]] int
hit_key(const KeyPlot& plot, const std::vector<CurveKey>& keys, const Vec2& pointer);
[[nodiscard]] int
hit_key(const KeyPlot& plot, const std::vector<ColorKey>& keys, const Vec2& pointer);

/// Stable sort of keys by `at`. Returns the new index of the key `followed`.
int sort_keys(std::vector<CurveKey>& keys, int followed = -1);
int sort_keys(std::vector<ColorKey>& keys, int followed = -1);

/// Applies the input to the keys; true if they have changed. `selected` is the index of a key, or
/// -1. A new key of a curve is at the pointer, one of a gradient has the color at that position.
bool edit_keys(
    const KeyPlot& plot, const KeyInput& input, std::vector<CurveKey>& keys, int& selected);
bool edit_keys(
    const KeyPlot& plot, const KeyInput& input, std::vector<ColorKey>& keys, int& selected);

}  // namespace limn
