#pragma once

#include "content/load/level/level_load.h"

#include <span>
#include <string>
#include <string_view>

namespace limn {

// What a level's text and its assets have in common: the images that a pattern becomes.

/// One image of a pattern.
struct PatternMap {
    const char* suffix;  ///< of its name
    ImageData PatternMaps::*image;
};

/// The images that a pattern of this kind becomes, in the order of their indices.
[[nodiscard]] std::span<const PatternMap> pattern_maps(const PatternKind& kind);

/// "file:line:column: path", the beginning of a message.
[[nodiscard]] std::string location_of(const Level& level, SourcePosition at, std::string_view path);

}  // namespace limn
