#include "render/water/water_surfaces.h"

#include "render/gpu/device.h"

namespace limn {

namespace {

constexpr unsigned kWatersUnit = 1;
constexpr unsigned kWaveLinesUnit = 2;
constexpr unsigned kWaveRingsUnit = 3;
constexpr unsigned kRipplesUnit = 4;
constexpr unsigned kOceanShiftUnit = 6;
constexpr unsigned kOceanShiftBeforeUnit = 13;
constexpr unsigned kOceanSlopeUnit = 14;
constexpr unsigned kOceanFoamUnit = 17;

}  // namespace

void bind_water_surfaces(gpu::Device& device, const WaterSurfaces& waters) {
    waters.bodies.bind(device, kWatersUnit);
    waters.lines.bind(device, kWaveLinesUnit);
    waters.rings.bind(device, kWaveRingsUnit);
    device.bind_texture(kRipplesUnit, waters.ripples.texture());
    if (!waters.seas.empty()) {
        device.bind_texture(kOceanShiftUnit, waters.seas.shift());
        device.bind_texture(kOceanShiftBeforeUnit, waters.seas.shift_before());
        device.bind_texture(kOceanSlopeUnit, waters.seas.slope());
        device.bind_texture(kOceanFoamUnit, waters.seas.foam());
    }
}

}  // namespace limn
