#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/forward_pass.h"
#include "render/light/light_each_pass.h"
#include "render/light/light_objects.h"
#include "render/light/projector_list.h"

#include <optional>

namespace limn {

// Lights all opaque surfaces, by the method that the level chose (LightMethod).
//
// Reads    G-buffer or depth, light records and clusters, LightingInputs
// Writes   radiance: linear; alpha 1 where there is a surface, black elsewhere; where the view
//          has subsurface scattering (subsurface_pass.h), that light to a separate target
// Order    after the G-buffer, shadows and caustics
// Shaders  shading_lobes.frag, light_pass.frag, lib/lighting.glsl
//
// Clustered: one pass for any number of lights, a pixel sums the lights of its cluster
// (deferred.light-pass); the depth test restricts it to surfaces, or to those of one lobe after the
// other where the level has several. The older methods, kept for comparison, are light_each_pass.h
// (one light at a time over the G-buffer) and forward_pass.h (surfaces lit while they are drawn).

struct LightEffect {
    ProgramVariants clustered;
    ProgramVariants lobes;                 ///< for several lobes, or subsurface scattering
    std::optional<LightEachPass> each{};   ///< created when a level first asks for it
    std::optional<ForwardPass> forward{};  ///< the same
    ProjectorPool projectors{};

    [[nodiscard]] static Result<LightEffect> create(gpu::Device& device, const RenderSettings&);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);
};

}  // namespace limn
