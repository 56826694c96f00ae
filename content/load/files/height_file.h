#pragma once

#include "content/bake/height_map.h"
#include "content/load/files/image_load.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

// Height maps from images: the red channel of PNG files, with all of their 16 bits, and of the
// other formats that image_load.h reads; Y or the first channel shown of EXR files, unclamped.
// Codes are linear, white is 1. NaN and infinity become 0 with a warning.

/// Reads the file `path`. Fails with "path: found X, expected Y".
[[nodiscard]] Result<HeightMap>
load_heights(const std::string& path, const ImageLimits& limits = {});

/// Whether the name is that of an image, by its extension.
[[nodiscard]] bool is_image_name(const std::string& path);

}  // namespace limn
