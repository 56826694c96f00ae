#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace limn {

// The named colors of CSS (W3C, CSS Color Module Level 4, section 6.1).

/// 0xrrggbb in sRGB of "orange"; nullopt for other words. Lower case.
[[nodiscard]] std::optional<std::uint32_t> find_color(std::string_view name);

/// All 148 names, sorted.
[[nodiscard]] std::vector<std::string_view> color_names();

}  // namespace limn
