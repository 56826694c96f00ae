#include "render/environment/fog_block.h"

#include "render/light/light_list.h"
#include "render/settings.h"

#include <algorithm>
#include <cmath>

// Techniques: light.height-fog

namespace limn {
namespace {

constexpr float kMaxExponent = 40;  // of the density at the camera: far below the base it is solid

}  // namespace

layout::FogBlock make_fog_block(const HeightFog& fog, const LightList& lights, float y) {
    const HeightFog settings = within_ranges(fog);
    const float above = (y - settings.base) / settings.scale_height;
    const float density = settings.density * std::exp(std::min(-above, kMaxExponent));
    return {
        .density = {density, 1 / settings.scale_height, settings.forward, 0},
        .ambient = Vec4(settings.ambient, 0),
        .sun = Vec4(settings.sun * lights.sun_color, 0),
        .to_sun = Vec4(lights.sun_direction, 0)};
}

}  // namespace limn
