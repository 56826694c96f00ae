#include "render/environment/environment_pass.h"

#include "ecs/components/light.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/environment/sheen_albedo.h"
#include "render/gpu/device.h"
#include "render/light/light_list.h"
#include "render/light/lighting.h"
#include "render/material/material_pool.h"
#include "render/render_frame.h"
#include "render/shaders/environment_gpu.h"
#include "render/shaders/material_layers_gpu.h"

#include <glm/geometric.hpp>

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
           && a.rotation == b.rotation && a.half_angle == b.half_angle && a.haze == b.haze;
}

/// The sun of an atmosphere: direction, irradiance above the air and on the ground; black without
/// one.
std::array<Vec3, 3> sun_of_atmosphere(const World& world) {
    std::array<Vec3, 3> sun = {Vec3(0, 1, 0), Vec3(0), Vec3(0)};
    bool found = false;
    world.query<const Sunlight, const DirectionalLight, const WorldTransform>().each(
        [&](const Sunlight& above, const DirectionalLight& light, const WorldTransform& at) {
            const Vec3 toward = transform_vector(at.world, {0, 0, 1});
            if (!found && light.enabled && glm::length(toward) > 0) {
                sun = {
                    glm::normalize(toward), above.color * above.illuminance,
                    light.color * light.illuminance};
                found = true;
            }
        });
    return sun;
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
    const auto& lights = frame.data.get<LightList>();
    const SkyKind sky = published.settings.sky;
    const std::array<Vec3, 3> sun =
        sky == SkyKind::Atmosphere ? sun_of_atmosphere(*frame.world)
                                   : std::array{lights.sun_direction, Vec3(0), lights.sun_color};
    published.changed = !current || !same_light(*current, published.settings)
                        || (sky == SkyKind::Atmosphere && sun != current_sun);
    if (published.changed) {
        block = make_environment_block(published.settings, Vec3(0, 1, 0), Vec3(0));
        describe_reflection(reflection, block);
        if (sky == SkyKind::Atmosphere) {
            update_atmosphere(published.settings, sun);
        }
        current = published.settings;
        current_sun = sun;
    }
    block.sun_direction = Vec4(sun[0], 0);
    block.sun_color = Vec4(sun[2], 0);
    published.block = block;
    published.block_slice = frame.ring->push_value(block);
    if (sky == SkyKind::Panorama) {
        published.sky = &panorama.cube;
    } else if (sky == SkyKind::Atmosphere) {
        published.sky = &sky_table;
        published.sky_view = &sky_view;
    }
    published.reflection = &reflection;
}

void EnvironmentEffect::update_atmosphere(
    const Environment& environment, const std::array<Vec3, 3>& sun) {
    const AirSettings settings = {environment.haze, environment.ground};
    if (!air || !(air->settings == settings)) {
        air = make_air_tables(settings);
        sky_view.radiance.clear();
    }
    if (sky_view.radiance.empty() || sky_view.sun != sun[0]) {
        sky_view = make_sky_view(*air, sun[0]);
        if (!sky_table) {
            sky_table = gpu::Texture(
                "sky table",
                {.format = GL_RGBA16F, .width = SkyView::kWidth, .height = SkyView::kHeight});
            sky_table.set_filter(GL_LINEAR, GL_LINEAR);
        }
        sky_table.upload<Vec4>(sky_view.radiance, GL_RGBA, GL_FLOAT);
    }
    const Vec3 irradiance = environment.intensity * sun[1];
    block.zenith = Vec4(irradiance, block.zenith.w);
    block.ground = Vec4(irradiance * sky_view.ground, 0);
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
