#pragma once

#include "bench/quality/quality.h"

#include <string_view>

namespace limn {

// `limn quality characters` is a list of parts, one file each, which registers itself:
//
//     Status measure_walk(HeadlessRenderer& headless, QualityReport& report);
//     const RegisterCharacterPart kPart("walk", measure_walk);
//
// They run in the order of their names, and their rows begin with the name: "walk: ...".

struct RegisterCharacterPart {
    RegisterCharacterPart(std::string_view name, MeasureQuality measure);
};

}  // namespace limn
