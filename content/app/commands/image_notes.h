#pragma once

#include "content/app/commands/image_file.h"

namespace limn {

struct Stage;

/// EXR attribute with the Exposure of the scene, as JSON; `limn view` applies it.
inline constexpr const char* kExposureNote = "limn.exposure";

/// Attributes of an EXR of a scene: its name, the simulation time [s], the exposure.
[[nodiscard]] ImageAttributes image_notes(const Stage& stage, double time);

}  // namespace limn
