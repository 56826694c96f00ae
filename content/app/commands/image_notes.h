#pragma once

#include "content/app/commands/image_file.h"

namespace limn {

struct Stage;

/// Attribute of an EXR: the Exposure of its scene, as JSON, with which `limn view` shows it.
inline constexpr const char* kExposureNote = "limn.exposure";

/// What is noted in an EXR of a scene: its name, the simulation time [s], the exposure.
[[nodiscard]] ImageAttributes image_notes(const Stage& stage, double time);

}  // namespace limn
