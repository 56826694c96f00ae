#include "render/fog_block.h"

#include "render/light_list.h"
#include "render/settings.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kMaxExponent = 40;  // of the density at the camera: far below the base it is solid

}  // namespace

void describe_fog(const HeightFog* fog, const LightList& lights, layout::ViewBlock& block) {
    if (fog == nullptr) {
        return;
    }
    const HeightFog settings = within_ranges(*fog);
    const float begin = block.fog.w;
    const float height = block.camera_ws.y + begin * block.ray_forward.y;
    const float above = (height - settings.base) / settings.scale_height;
    const float density = settings.density * std::exp(std::min(-above, kMaxExponent));
    block.fog = {density, 1 / settings.scale_height, settings.forward, begin};
    block.fog_ambient = Vec4(settings.ambient, 0);
    block.fog_sun = Vec4(settings.sun * lights.sun_color, 0);
    block.fog_to_sun = Vec4(lights.sun_direction, 0);
}

}  // namespace limn
