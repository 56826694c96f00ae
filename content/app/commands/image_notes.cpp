#include "content/app/commands/image_notes.h"

#include "content/app/commands/stage.h"
#include "content/load/level/component_json.h"
#include "ecs/components/post.h"

#include <fmt/format.h>

namespace limn {

ImageAttributes image_notes(const Stage& stage, double time) {
    const auto* const found = stage.world.find_resource<Exposure>();
    const Exposure exposure = found != nullptr ? *found : Exposure{};
    return {
        {"limn.scene", stage.scene.name},
        {"limn.time", fmt::format("{}", time)},
        {kExposureNote, write_json(write_component(component_info<Exposure>(), &exposure, {}))}};
}

}  // namespace limn
