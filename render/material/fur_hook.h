#pragma once

#include "render/material/surface_hooks.h"

#include <cstdint>

namespace limn {

// What fur (render/geometry/fur_list.h) adds to the programs of surfaces: its shells lean, have
// holes between strands, and are shaded by the direction of these.

/// Bits of kFurHook.
enum FurFeature : std::uint16_t {
    kFurShell = 1u << 0,
    kFurFin = 1u << 1,  // with kFurShell: instead
};

extern const SurfaceHook kFurHook;

/// Whether these are the features of a shell or of fins.
[[nodiscard]] bool is_fur(const SurfaceFeatures& features);
[[nodiscard]] bool is_fin(const SurfaceFeatures& features);

}  // namespace limn
