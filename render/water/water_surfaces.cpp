#include "render/water/water_surfaces.h"

#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/light/light_list.h"
#include "render/shaders/water_gpu.h"
#include "render/water/caustic_list.h"

namespace limn {

namespace {}  // namespace

void bind_water_surfaces(gpu::Device& device, const WaterSurfaces& waters) {
    waters.bodies.bind(device, layout::kWatersUnit);
    waters.lines.bind(device, layout::kWaveLinesUnit);
    waters.rings.bind(device, layout::kWaveRingsUnit);
    device.bind_texture(layout::kRippleAtlasUnit, waters.textures->ripples.texture());
    if (waters.any_seas()) {
        device.bind_texture(layout::kOceanShiftUnit, waters.textures->seas.shift());
        device.bind_texture(
            layout::kPreviousOceanShiftUnit, waters.textures->seas.previous_shift());
        device.bind_texture(layout::kOceanSlopeUnit, waters.textures->seas.slope());
        device.bind_texture(layout::kOceanFoamUnit, waters.textures->seas.foam());
    }
}

bool WaterBodiesEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const Water>().empty();
}

Result<WaterBodiesEffect> WaterBodiesEffect::create(gpu::Device&, const RenderSettings&) {
    return WaterBodiesEffect{};
}

void WaterBodiesEffect::collect(FrameData& frame) {
    auto& textures = frame.data.publish<WaterTextures>();
    read_water_sources(*frame.world, frame.camera, textures.sources);
}

/// After every collect(): whether the frame needs velocity is known then.
void WaterBodiesEffect::request_views(FrameData& frame) {
    auto& textures = frame.data.publish<WaterTextures>();
    if (!textures.sources.bodies.empty()) {
        textures.ripples.update(textures.sources.ripples, frame.device->caps().max_texture_size);
        textures.seas.update(textures.sources.seas, frame.velocity);
    }
}

bool WaterBodiesEffect::prepare(const FrameData& frame, ViewData& view) {
    const auto& textures = frame.data.get<WaterTextures>();
    if (textures.sources.bodies.empty()) {
        return false;
    }
    auto& waters = view.data.publish<WaterSurfaces>();
    const auto* planar = frame.data.find<PlanarReflection>();
    waters.textures = &textures;
    build_water_list(
        textures.sources, view.camera,
        planar != nullptr && view.is(kMainViews) ? planar->water : Entity{}, textures.ripples,
        textures.seas, waters.list);
    if (view.is(kMirrorView)) {  // the mirrored scene has no water
        waters.list.patches.clear();
        waters.list.around.reset();
    }
    const WaterList& list = waters.list;
    waters.bodies.upload(*frame.ring, list.bodies);
    waters.lines.upload(*frame.ring, list.lines);
    waters.rings.upload(*frame.ring, list.rings);
    waters.patches.upload(*frame.ring, list.patches);
    if (list.details.needed) {
        waters.details.upload(*frame.ring, list.details.records);
        waters.texture_waves.upload(*frame.ring, list.details.waves);
    }
    collect_caustics(
        list, view.data.get<LightList>(), view.camera, view.is(kMainViews),
        view.data.publish<CausticList>(), view.data.publish<WaterShadows>().requests);
    return true;
}

}  // namespace limn
