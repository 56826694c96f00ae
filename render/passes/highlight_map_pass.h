#pragma once

#include "render/buffer_texture.h"
#include "render/effect.h"
#include "render/gpu/texture.h"
#include "render/highlight_layers.h"
#include "render/shaders/light_gpu.h"

#include <array>
#include <vector>

namespace limn {

// Textures that take the place of a part of the lighting, for the rates that read them
// (ShadingRateRow::map): Blinn maps (fakephong.blinn-texture), the same for all lights and views,
// or a sphere map of all lights in the camera's axes (fakephong.envmap-bake), each with a layer per
// exponent of the materials.
//
// Reads    materials; of the sphere map: light records, the boxes of all objects
// Writes   HighlightMaps
// Order    after LightList, before surfaces are lit
// Shaders  highlight_maps.comp, highlight_environment.comp
//
// Baked again only when something has changed. A sphere map has one center for all objects, the
// middle of all of them: point lights near by shine from the wrong direction. It has no shadows.

inline constexpr int kHighlightMapSize = 256;  ///< [px]

/// Units 5 and 6: those of the G-buffer, which passes that draw surfaces do not read.
inline constexpr unsigned kHighlightMapsUnit = 5;
inline constexpr unsigned kHighlightLayersUnit = 6;

/// Published in the views of which a rate reads them.
struct HighlightMaps {
    std::array<TextureId, 3> layers;  ///< by HighlightMap; not valid() where no rate reads it
    const BufferTexture* layer_of_material = nullptr;  ///< by record
};

struct HighlightMapEffect {
    /// What a sphere map was made of.
    struct Environment {
        std::vector<layout::LightRecord> lights = {};
        int directional = 0;
        Vec3 center = {0, 0, 0};
        Affine camera = {};
        std::vector<float> exponents = {};
    };

    const gpu::Program* bake_blinn = nullptr;
    const gpu::Program* bake_environment = nullptr;
    gpu::Texture blinn = {};
    gpu::Texture environment = {};
    BufferTexture exponents = BufferTexture("highlight exponents", GL_R32F);
    BufferTexture lights = BufferTexture("highlight lights", GL_RGBA32F);
    BufferTexture layer_of_material = BufferTexture("highlight layers", GL_R32UI);
    HighlightLayers layers = {};
    std::vector<float> blinn_exponents = {};  ///< that `blinn` was made of
    Environment baked = {};

    static Result<HighlightMapEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);

    // Parts of draw(); return the layers.
    TextureId draw_blinn(FrameGraph& graph);
    TextureId draw_environment(FrameGraph& graph, const FrameData& frame, const ViewData& view);
};

}  // namespace limn
