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

/// Resource: the image is split into columns of the same width between `left` and `right`, in each
/// of which wrinkles are drawn by another method; their names stand below. What lies beyond belongs
/// to the outer columns. Light, skin and what is
/// measured are the same in all. Holds for each WrinkleSurface on a mesh with tangents whose own
/// method could be one of them, whatever its distances `shade_from` and `none_from`, but for
/// wrinkles of two layers.
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
        .doc = "of the columns, at most 8; strain_view and model, which need another map, are left "
               "out",
        .values = kWrinkleMethodNames);
    LIMN_FIELD(
        left, "where the columns begin, between the left (0) and right (1) border of the image", "",
        0, 1);
    LIMN_FIELD(right, "where they end; right of `left`", "", 0, 1);
}

/// Whether methods like it can share an image: all are drawn from one map and one measure.
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

/// Where the columns begin and end, 0 .. 1 of the width; all of it where that is no width.
[[nodiscard]] inline Vec2 column_borders(const WrinkleComparison* comparison) {
    const bool has_width = comparison != nullptr && comparison->left >= 0
                           && comparison->right > comparison->left && comparison->right <= 1;
    return has_width ? Vec2(comparison->left, comparison->right) : Vec2(0, 1);
}

/// Whether columns show in place of a surface's own method.
[[nodiscard]] inline bool has_columns(const WrinkleSurface& surface) {
    return is_comparable(surface.method) && surface.method != WrinkleMethod::None
           && !has_layers(surface);
}

}  // namespace limn
