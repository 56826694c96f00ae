#pragma once

#include "render/effect.h"
#include "render/environment/atmosphere.h"
#include "render/environment/environment_maps.h"

#include <array>
#include <optional>

namespace limn {

// The surroundings of the scene and the light that comes from them (environment_maps.h).
//
// Reads    Environment, Sunlight, LightList (the sun)
// Writes   sky cube, reflection maps, irradiance, when the environment has changed
// Order    before lighting
//
// Publishes SceneEnvironment.

struct EnvironmentEffect {
    PanoramaPass panorama;
    ReflectionPass reflection;
    gpu::Texture specular_albedo;  ///< make_specular_albedo()
    /// make_sheen_albedo(), once some material has sheen.
    std::optional<gpu::Texture> sheen_albedo = {};
    std::optional<AirTables> air = {};  ///< once some sky is an atmosphere
    SkyView sky_view = {};
    gpu::Texture sky_table = {};           ///< sky_view
    std::optional<Environment> current;    ///< that the maps show
    std::array<Vec3, 3> current_sun = {};  ///< sun_of_atmosphere
    layout::EnvironmentBlock block{};

    [[nodiscard]] static Result<EnvironmentEffect>
    create(gpu::Device& device, const RenderSettings& settings);
    void collect(FrameData& frame);
    void update_atmosphere(const Environment& environment, const std::array<Vec3, 3>& sun);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
