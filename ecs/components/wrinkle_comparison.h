#pragma once

#include "ecs/base/math.h"
#include "ecs/components/wrinkle.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <vector>

namespace limn {

// Techniques: wrinkle.comparison
// Source of wrinkle.comparison: a split screen, as of renderers that are compared

inline constexpr std::size_t kMaxWrinkleColumns = 8;

/// Resource: the image is split into columns of equal width between `left` and `right`, each with
/// another method of drawing wrinkles, whose name is shown below. What lies beyond belongs to the
/// outer columns. Light, skin and measured compression are the same in all. Applies to each
/// WrinkleSurface on a mesh with tangents whose own method could be one of them, regardless of
/// `shade_from` and `none_from`, except wrinkles of two layers.
struct WrinkleComparison {
    bool shown = true;
    std::vector<WrinkleMethod> methods = {
        WrinkleMethod::Alpha, WrinkleMethod::Bump, WrinkleMethod::Sphere, WrinkleMethod::Isometric};
    float left = 0;
    float right = 1;
};

LIMN_FIELDS(WrinkleComparison) {
    LIMN_FIELD(shown, "the columns; otherwise every surface is drawn by its own method");
    LIMN_FIELD(
        methods,
        .doc = "methods of the columns, at most 8; strain_view and model, which need another map, "
               "are skipped",
        .values = kWrinkleMethodNames);
    LIMN_FIELD(
        left, "left border of the columns, from the left (0) to the right (1) edge of the image",
        "", 0, 1);
    LIMN_FIELD(right, "right border of the columns, greater than `left`", "", 0, 1);
}

/// Whether the method can be compared in one image: all such use the same map and measurement.
[[nodiscard]] inline bool is_comparable(WrinkleMethod method) {
    return method != WrinkleMethod::StrainView && method != WrinkleMethod::Model;
}

/// The methods of the columns, at most kMaxWrinkleColumns; none where none are shown.
[[nodiscard]] inline std::vector<WrinkleMethod>
wrinkle_columns(const WrinkleComparison* comparison) {
    std::vector<WrinkleMethod> columns;
    if (comparison != nullptr && comparison->shown) {
        for (const WrinkleMethod method : comparison->methods) {
            if (is_comparable(method) && columns.size() < kMaxWrinkleColumns) {
                columns.push_back(method);
            }
        }
    }
    return columns;
}

/// Left and right border of the columns, 0 .. 1 of the width; (0, 1) if they are invalid.
[[nodiscard]] inline Vec2 column_borders(const WrinkleComparison* comparison) {
    const bool has_width = comparison != nullptr && comparison->left >= 0
                           && comparison->right > comparison->left && comparison->right <= 1;
    return has_width ? Vec2(comparison->left, comparison->right) : Vec2(0, 1);
}

/// Whether columns replace a surface's own method.
[[nodiscard]] inline bool has_columns(const WrinkleSurface& surface) {
    return is_comparable(surface.method) && surface.method != WrinkleMethod::None
           && !has_layers(surface);
}

}  // namespace limn
