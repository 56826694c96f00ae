#pragma once

#include "ecs/reflect.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>

namespace limn {

/// `settings` with each float clamped to the range that a file may give it (FieldMeta), as code may
/// have set anything; NaN counts as 0.
template <typename Settings>
[[nodiscard]] Settings within_ranges(Settings settings) {
    visit_fields(settings, [](std::string_view, auto& field, const FieldMeta& meta = {}) {
        if constexpr (std::is_same_v<decltype(field), float&>) {
            constexpr double kMax = 1e6;  // where there is no range
            const double number = std::isnan(field) ? 0.0 : static_cast<double>(field);
            field = static_cast<float>(
                std::clamp(number, std::max(meta.min, -kMax), std::min(meta.max, kMax)));
        }
    });
    return settings;
}

}  // namespace limn
