#pragma once

#include "ecs/components/rendering.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/texture.h"
#include "render/light/highlight_layers.h"
#include "render/shaders/light_gpu.h"
#include "render/variant.h"

#include <vector>

namespace limn {

// Textures that replace a part of the lighting, for the rates that read them (ShadingRateRow::map):
// Blinn maps (fakephong.blinn-texture), a layer per exponent for all lights and views; or sphere
// maps of all lights in the camera's axes (fakephong.envmap-bake), a layer per material.
//
// Reads    materials; of sphere maps: light records, the boxes of all objects
// Writes   HighlightMaps, the view's HighlightBlock
// Order    after LightList, before surfaces are lit
// Shaders  highlight_maps.comp, highlight_environment.comp
//
// Baked again only when something has changed. In an environment map (HighlightLayout) each light
// has one direction, as seen from the center of all objects of the material: a lamp among them
// lights them from the wrong side. Environment maps have no shadows.

inline constexpr int kHighlightMapSize = 256;  ///< [px]

struct HighlightMapEffect {
    /// What a texture was baked from.
    struct Source {
        std::vector<Vec4> layers = {};  ///< center of the objects [m]; w: exponent of Blinn's lobe
        std::vector<layout::LightRecord> lights = {};
        int directional = 0;
        HighlightLayout layout = HighlightLayout::Sphere;
        Affine camera = {};
    };
    struct Maps {
        gpu::Texture texture = {};
        Source source = {};
        HighlightLayers layers = {};
        BufferTexture layer_records = BufferTexture("highlight layer records", GL_RGBA32F);
        BufferTexture layer_of_material = BufferTexture("highlight layers", GL_R32UI);
    };

    const gpu::Program* bake_blinn = nullptr;
    ProgramVariants bake_environment;
    Maps blinn = {};
    Maps environment = {};
    BufferTexture lights = BufferTexture("highlight lights", GL_RGBA32F);

    static Result<HighlightMapEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);

    /// The part of draw() for one map: bakes it if something has changed.
    HighlightMaps::Map
    draw_map(FrameGraph& graph, const FrameData& frame, const ViewData& view, bool by_view);
};

}  // namespace limn
