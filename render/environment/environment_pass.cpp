#include "render/environment/environment_pass.h"

#include "ecs/world.h"
#include "render/environment/sheen_albedo.h"
#include "render/gpu/device.h"
#include "render/light/light_list.h"
#include "render/light/lighting.h"
#include "render/material/material_pool.h"
#include "render/render_frame.h"
#include "render/shaders/environment_gpu.h"
#include "render/shaders/material_layers_gpu.h"

namespace limn {
namespace {

constexpr int kSpecularAlbedoSize = 64;
constexpr int kSheenAlbedoSize = 64;

/// Without the resource nothing surrounds the scene; a missing panorama is magenta, as on surfaces.
Environment displayed_environment(const FrameData& frame) {
    const auto* found = frame.world->find_resource<Environment>();
    Environment environment =
        found != nullptr
            ? *found
            : Environment{.sky = SkyKind::Uniform, .zenith = Vec3(0), .visible = false};
    if (environment.sky == SkyKind::Panorama
        && frame.materials->images().find_texture(environment.panorama) == nullptr) {
        environment.sky = SkyKind::Uniform;
        environment.zenith = {1, 0, 1};
    }
    return environment;
}

bool same_light(const Environment& a, const Environment& b) {
    return a.sky == b.sky && a.zenith == b.zenith && a.horizon == b.horizon && a.ground == b.ground
           && a.intensity == b.intensity && a.panorama == b.panorama && a.mapping == b.mapping
           && a.rotation == b.rotation && a.half_angle == b.half_angle;
}

void bind_environment(PassContext& context, const SceneEnvironment& environment) {
    const gpu::RingSlice& block = environment.block_slice;
    context.device().bind_uniforms(
        layout::kEnvironmentBinding, block.buffer, block.offset, block.size);
    context.device().bind_texture(layout::kReflectionMapsUnit, environment.reflection->maps);
    context.device().bind_uniforms(
        layout::kSurroundingsBinding, environment.reflection->irradiance);
}

}  // namespace

Result<EnvironmentEffect>
EnvironmentEffect::create(gpu::Device& device, const RenderSettings& settings) {
    EnvironmentEffect effect{
        .panorama = LIMN_TRY(create_panorama_pass(device)),
        .reflection = LIMN_TRY(create_reflection_pass(device, settings.environment_size)),
        .specular_albedo = gpu::Texture(
            "specular albedo",
            {.format = GL_RG32F, .width = kSpecularAlbedoSize, .height = kSpecularAlbedoSize}),
        .current = std::nullopt};
    const std::vector<Vec2> table = make_specular_albedo(kSpecularAlbedoSize);
    effect.specular_albedo.upload<Vec2>(table, GL_RG, GL_FLOAT);
    return effect;
}

void EnvironmentEffect::collect(FrameData& frame) {
    if ((frame.materials->layers() & kSheenLayer) != 0 && !sheen_albedo) {
        sheen_albedo.emplace(
            "sheen albedo",
            gpu::TextureDesc{
                .format = GL_R32F, .width = kSheenAlbedoSize, .height = kSheenAlbedoSize});
        const std::vector<float> table = make_sheen_albedo(kSheenAlbedoSize);
        sheen_albedo->upload<float>(table, GL_RED, GL_FLOAT);
    }
    auto& published = frame.data.publish<SceneEnvironment>();
    published.settings = displayed_environment(frame);
    if (frame.assets_replaced) {
        current.reset();  // the panorama may be another image
    }
    published.changed = !current || !same_light(*current, published.settings);
    if (published.changed) {
        block = make_environment_block(published.settings, Vec3(0, 1, 0), Vec3(0));
        describe_reflection(reflection, block);
        current = published.settings;
    }
    const auto& lights = frame.data.get<LightList>();
    block.sun_direction = Vec4(lights.sun_direction, 0);
    block.sun_color = Vec4(lights.sun_color, 0);
    published.block = block;
    published.block_slice = frame.ring->push_value(block);
    published.cube = &panorama.cube;
    published.reflection = &reflection;
}

void EnvironmentEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    const auto& environment = frame.data.get<SceneEnvironment>();
    if (!environment.changed) {
        return;
    }
    if (environment.settings.sky == SkyKind::Panorama) {
        draw_panorama(
            graph, panorama, *frame.materials->images().find_texture(environment.settings.panorama),
            environment.settings);
    }
    draw_sky_reflection(graph, reflection, environment);
}

bool EnvironmentEffect::prepare(const FrameData& frame, ViewData& view) {
    view.lighting.add_binding<bind_environment>(frame.data.get<SceneEnvironment>());
    view.lighting.add_binding<[](PassContext& context, const gpu::Texture& table) {
        context.device().bind_texture(layout::kSpecularAlbedoUnit, table);
    }>(specular_albedo);
    if ((frame.materials->layers() & kSheenLayer) != 0) {
        view.lighting.add_binding<[](PassContext& context, const gpu::Texture& table) {
            context.device().bind_texture(layout::kSheenAlbedoUnit, table);
        }>(*sheen_albedo);
    }
    return true;
}

void EnvironmentEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    view.lighting.reads.emplace_back(graph.import("reflection map", reflection.maps));
    view.lighting.reads.emplace_back(graph.import("irradiance", reflection.irradiance));
}

}  // namespace limn
