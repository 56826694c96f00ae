#include "render/light/caustics_pass.h"

#include "ecs/components/water.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/lighting.h"
#include "render/shaders/caustics_gpu.h"
#include "render/shaders/shadow_gpu.h"
#include "render/shadow/shadow_list.h"
#include "render/view_block.h"

#include <algorithm>

// Techniques: caustic.projected-vertices

namespace limn {
namespace {

constexpr unsigned kCausticGroup = 64;  ///< texels per work group

gpu::Texture make_caustic_atlas(const IVec2& size) {
    return {"caustic maps", {.format = GL_R32F, .width = size.x, .height = size.y}};
}

void use_with_jobs(gpu::Device& device, const CausticList& list, const gpu::Program& program) {
    device.use(program);
    program.set("groups", list.groups);
    list.job_texture.bind(device, layout::kCausticRecordsUnit);
}

/// Sums into a transient buffer, then writes the maps.
void sum_on_gpu(
    FrameGraph& graph, const CausticsEffect& pass, const CausticList& list, BufferId rays,
    TextureId made) {
    const auto width = static_cast<unsigned>(list.atlas.x);
    const auto height = static_cast<unsigned>(list.atlas.y);
    const std::size_t bytes = std::size_t{width} * height * sizeof(std::uint32_t);
    const BufferId light = graph.create_buffer({"caustics.light", bytes});
    graph.add_pass("caustic splats", {rays}, {light}, [=, &pass, &list](PassContext& context) {
        gpu::Device& device = context.device();
        context.buffer(light).clear(0, bytes);
        use_with_jobs(device, list, *pass.splat);
        pass.splat->set("width", static_cast<int>(width));
        context.bind_storage(layout::kCausticRaysBinding, rays);
        context.bind_storage(layout::kCausticLightBinding, light);
        device.dispatch(static_cast<unsigned>(list.groups));
    });
    graph.add_pass("caustic maps", {light}, {image(made)}, [=, &pass](PassContext& context) {
        gpu::Device& device = context.device();
        device.use(*pass.map);
        context.bind_storage(layout::kCausticLightBinding, light);
        context.bind_image(layout::kCausticMapsImage, made, GL_WRITE_ONLY);
        device.dispatch((width + kCausticGroup - 1) / kCausticGroup, height);
    });
}

void sum_on_cpu(
    FrameGraph& graph, CausticsEffect& pass, const CausticList& list, BufferId rays,
    TextureId made) {
    graph.add_pass(
        "caustic splats", {rays}, {image(made)}, [=, &pass, &list](PassContext& context) {
            pass.rays_on_cpu.resize(list.rays);
            context.buffer(rays).read(0, std::as_writable_bytes(std::span(pass.rays_on_cpu)));
            pass.atlas_on_cpu.resize(
                static_cast<std::size_t>(list.atlas.x) * static_cast<std::size_t>(list.atlas.y));
            splat_caustics(
                list.maps, pass.rays_on_cpu, list.atlas.x, pass.sums_on_cpu, pass.atlas_on_cpu);
            pass.maps.upload<float>(pass.atlas_on_cpu, GL_RED, GL_FLOAT);
        });
}

/// The water surfaces and caustics that light surfaces in, above or below water.
struct WaterLights {
    const BufferTexture* records;
    const gpu::Texture* maps;
};

void bind_water_lights(PassContext& context, const WaterLights& lights) {
    lights.records->bind(context.device(), layout::kWaterLightsUnit);
    context.device().bind_texture(layout::kCausticMapsUnit, *lights.maps);
}

/// Whether some water of the level reflects sunlight upward, even if the sun is low in this frame.
bool may_mirror(const ViewData& view) {
    const std::vector<const Caustics*>& waters = view.data.get<WaterSurfaces>().list.caustics;
    return view.is(kMainViews) && view.data.get<LightList>().directional > 0
           && std::any_of(waters.begin(), waters.end(), [](const Caustics* caustics) {
                  return caustics != nullptr && caustics->mirror_reach > 0;
              });
}

}  // namespace

bool CausticsEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const Water>().empty();
}

Result<CausticsEffect> CausticsEffect::create(gpu::Device& device, const RenderSettings&) {
    CausticsEffect effect{
        .rays = ProgramVariants(device, {.compute = "caustics_rays.comp"}),
        .on_cpu = device.caps().profile == gpu::Profile::Software,
        .splat = LIMN_TRY(device.shaders().load({.compute = "caustics_splat.comp"})),
        .map = LIMN_TRY(device.shaders().load({.compute = "caustics_map.comp"}))};
    effect.maps = make_caustic_atlas({1, 1});
    return effect;
}

bool CausticsEffect::prepare(const FrameData& frame, ViewData& view) {
    if (view.data.find<WaterSurfaces>() == nullptr) {
        return false;
    }
    auto& list = view.data.publish<CausticList>();
    finish_caustics(view.data.get<LightList>(), view.data.get<ShadowList>(), list);
    list.record_texture.upload(*frame.ring, list.texels);
    view.lighting.variant.add("WATERS");
    view.lighting.variant.add_if(may_mirror(view), "MIRRORS");
    auto& lights = view.data.publish<WaterLights>();
    lights = {&list.record_texture, &maps};
    view.lighting.add_binding<bind_water_lights>(lights);
    if (!view.is(kMainViews) || list.maps.empty()) {
        return false;  // lit as by flat water
    }
    list.job_texture.upload(*frame.ring, list.jobs);
    if (maps.width() != list.atlas.x || maps.height() != list.atlas.y) {
        maps = make_caustic_atlas(list.atlas);
    }
    return true;
}

void CausticsEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const auto& list = view.data.get<CausticList>();
    const auto& waters = view.data.get<WaterSurfaces>();
    const BufferId ray_buffer = graph.create_buffer({"caustics.rays", list.rays * sizeof(Vec4)});
    const TextureId atlas = graph.import("caustics", maps);

    std::vector<Use> reads;
    if (const TextureId shadows = view.data.get<ShadowMaps>().atlas; shadows.valid()) {
        reads.emplace_back(shadows);
    }
    const Use writes[] = {ray_buffer};
    graph.add_pass(
        "caustic rays", std::span(reads), writes,
        [this, &list, &waters, &view, ray_buffer](PassContext& context) {
            gpu::Device& device = context.device();
            Variant variant = view.lighting.variant;
            variant.add_if(waters.any_seas(), "OCEAN");
            const gpu::Program* program = rays.get(variant);
            if (program == nullptr) {
                return;
            }
            use_with_jobs(device, list, *program);
            bind_view(context, view);
            if (const auto& shadows = view.data.get<ShadowMaps>(); shadows.atlas.valid()) {
                device.bind_texture(layout::kShadowAtlasUnit, context.texture(shadows.atlas));
                shadows.records->bind(device, layout::kShadowViewsUnit);
            }
            bind_water_surfaces(device, waters);
            context.bind_storage(layout::kCausticRaysBinding, ray_buffer);
            device.dispatch(static_cast<unsigned>(list.groups));
        });
    if (on_cpu) {
        sum_on_cpu(graph, *this, list, ray_buffer, atlas);
    } else {
        sum_on_gpu(graph, *this, list, ray_buffer, atlas);
    }
    view.data.publish<CausticMaps>().atlas = atlas;
    view.lighting.reads.emplace_back(atlas);
}

}  // namespace limn
