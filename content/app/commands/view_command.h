#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/post.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

// Shown by `limn view museum.exr`: hdr.viewer
// Shown by `limn view museum.exr -o museum.png`: hdr.dynamic-range

/// `limn view`: tone maps an HDR image, in a window with sliders or to a PNG.
struct ViewOptions {
    std::string file;          ///< any format that load_image reads
    std::string out;           ///< .png; not empty: no window
    IVec2 size = {1280, 720};  ///< of the window
    /// Fields of the Exposure and their values, on top of the one that exposure_of_file() finds.
    std::vector<std::pair<std::string, std::string>> settings;
};

/// That of the scene for an EXR of `limn render`; neutral for images of 8 bits; else knee.
[[nodiscard]] Exposure exposure_of_file(const std::string& path);

/// Sets one field of an Exposure as a level would; fails with what was found and expected.
[[nodiscard]] Status
set_exposure(Exposure& exposure, std::string_view field, std::string_view value);

[[nodiscard]] Status run_view(const ViewOptions& options);

}  // namespace limn
