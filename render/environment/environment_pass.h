#pragma once

#include "render/effect.h"
#include "render/environment/environment_maps.h"

#include <optional>

namespace limn {

// The surroundings of the scene and the light that comes from them (environment_maps.h).
//
// Reads    Environment, LightList (the sun)
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
    std::optional<Environment> current;  ///< that the maps show
    layout::EnvironmentBlock block{};

    [[nodiscard]] static Result<EnvironmentEffect>
    create(gpu::Device& device, const RenderSettings& settings);
    void collect(FrameData& frame);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
