#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/texture.h"
#include "render/shadow/shadow_list.h"
#include "render/shadow/shadow_volume_pass.h"
#include "render/shadow/volume_list.h"

#include <optional>

namespace limn {

// Draws the shadow maps that are due into the shared atlas; all others keep their depths.
//
// Reads    ShadowList
// Writes   shadow atlas: reversed depth of the caster nearest to the light, 0 where none
// Order    before lighting
// Shaders  mesh.vert, shadow_map.frag
//
// Casters are drawn double-sided: a wall casts a shadow whichever side faces the light. The maps
// have no bias; lighting applies it (lib/shadow.glsl).

/// Maps and volumes of a view's lights. Publishes ShadowList and VolumeList in prepare(),
/// ShadowMaps and ShadowMasks in draw(); sets the shadows of the view's LightList.
struct ShadowEffect {
    ProgramVariants casters;
    gpu::Texture atlas;   ///< 1x1 until there is a shadow
    ShadowKinds level{};  ///< of this frame: kinds that the lights of the level may need
    ShadowCollector maps{};
    VolumeCollector volumes{};
    std::optional<ShadowVolumePass> volume_pass{};  ///< created with the first volume

    [[nodiscard]] static Result<ShadowEffect> create(gpu::Device& device, const RenderSettings&);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);

    const ShadowVolumePass* create_volume_pass(const FrameData& frame);
};

}  // namespace limn
