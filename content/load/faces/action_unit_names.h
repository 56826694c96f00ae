#pragma once

#include <string>
#include <string_view>

namespace limn {

/// The action unit of FACS, with "_L" or "_R" for a half, of a morph target with this name; empty
/// if unknown. Names of ARKit ("mouthSmileLeft", also after a prefix that ends in a dot), ICT
/// FaceKit
/// ("mouthSmile_L"), MakeHuman, or units themselves ("AU12_L", "au12left").
[[nodiscard]] std::string find_action_unit(std::string_view name);

}  // namespace limn
