#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"

#include <cstddef>
#include <vector>

namespace limn {

// Editing of curves and gradients with a pointer, apart from how they are drawn (key_widgets.h).
// Lists are kept in order of `at`.

inline constexpr std::size_t kMaxEditedKeys = 8;  ///< none is added beyond: shaders read no more

/// Where keys are on the screen: `at` 0 .. 1 from left to right, values 0 .. `top` upward. The keys
/// of a gradient have no height.
struct KeyPlot {
    Vec2 corner = {0, 0};   ///< top left [pixels]
    Vec2 size = {100, 50};  ///< > 0 [pixels]
    float top = 1;          ///< value at the upper edge, > 0
    float reach = 8;        ///< how near the pointer must be to a key [pixels]
};

/// What a user does in one frame.
struct KeyInput {
    Vec2 pointer = {0, 0};        ///< [pixels]
    bool pressed = false;         ///< left button down since this frame: selects a key
    bool held = false;            ///< left button down: the selected key follows
    bool double_clicked = false;  ///< adds a key, if there is none
    bool right_clicked = false;   ///< removes the key under the pointer
    bool removes = false;         ///< Delete: removes the selected key
};

/// Power of two that is no less than the largest value, at least 1.
[[nodiscard]] float plot_top(const std::vector<CurveKey>& keys);

[[nodiscard]] Vec2 key_place(const KeyPlot& plot, const CurveKey& key);
[[nodiscard]] Vec2 key_place(const KeyPlot& plot, const ColorKey& key);

/// Index of the key nearest to the pointer, within reach; -1: none.
[[nodiscard]] int
hit_key(const KeyPlot& plot, const std::vector<CurveKey>& keys, const Vec2& pointer);
[[nodiscard]] int
hit_key(const KeyPlot& plot, const std::vector<ColorKey>& keys, const Vec2& pointer);

/// Puts keys in order of `at`; those with equal ones keep theirs. Returns the new index of the key
/// `followed`.
int sort_keys(std::vector<CurveKey>& keys, int followed = -1);
int sort_keys(std::vector<ColorKey>& keys, int followed = -1);

/// Applies the input to the keys; true if they have changed. `selected` is the index of a key, or
/// -1. A new key of a curve is where the pointer is, one of a gradient has the color of the place.
bool edit_keys(
    const KeyPlot& plot, const KeyInput& input, std::vector<CurveKey>& keys, int& selected);
bool edit_keys(
    const KeyPlot& plot, const KeyInput& input, std::vector<ColorKey>& keys, int& selected);

}  // namespace limn
