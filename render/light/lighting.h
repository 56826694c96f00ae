#pragma once

#include "ecs/components/rendering.h"
#include "render/frame_data.h"
#include "render/light/light_list.h"

#include <initializer_list>
#include <optional>
#include <vector>

namespace limn {

// Shared by passes that light surfaces: the method, and the LightingInputs of a view.

/// How the surfaces of a view are lit; published in prepare() before everything that depends on it.
struct LightingMethod {
    LightMethod method = LightMethod::Clustered;
    ShadingRate shading = ShadingRate::Pixel;  ///< other rates only with LightMethod::ObjectMajor
    std::optional<ShadingRate> compared;  ///< lit a second time, ObjectMajor (ComparedRadiance)
    HighlightLayout highlights = HighlightLayout::Sphere;
    bool worst_blinn_axis = false;  ///< that of HighlightBlock::blinn_axis otherwise
    bool blinn_diffuse = false;
    bool screen_interpolation = false;  ///< of the varyings of forward shaders
    HardwareDefects hardware = {};
    bool infinite_viewer = false;  ///< specular light with the viewer at infinity

    /// Whether surfaces are lit while they are drawn.
    [[nodiscard]] bool is_forward() const {
        return method == LightMethod::ObjectMajor || method == LightMethod::LightMajor;
    }
};

/// Full-screen passes where there is a surface, and where there is none: the triangle of
/// fullscreen.vert lies at depth 0, less than that of any surface.
inline constexpr gpu::PipelineState kWhereSurfaces = {
    .depth = {.test = true, .write = false, .func = GL_LESS}, .cull = GL_NONE};
inline constexpr gpu::PipelineState kWhereBackground = {
    .depth = {.test = true, .write = false, .func = GL_EQUAL}, .cull = GL_NONE};

/// The lobe of each pixel of a view, as the depth that fullscreen.vert has with the definition
/// SHADING_LOBE: passes for one lobe alone test for it. Published in draw() where surfaces have
/// several lobes, or scatter light.
struct ShadingLobes {
    TextureId depth;
};
inline constexpr gpu::PipelineState kWhereLobe = kWhereBackground;

/// Binds the view's uniform block and its LightingInputs.
void bind_lighting(PassContext& context, const ViewData& view);

/// `reads` and those of the view's LightingInputs.
[[nodiscard]] std::vector<Use>
lighting_reads(const ViewData& view, std::initializer_list<Use> reads);

/// `depth`, the other targets of the G-buffer that lib/stored_surface.glsl reads, and those of the
/// view's LightingInputs.
[[nodiscard]] std::vector<Use> surface_reads(const ViewData& view, Use depth);

/// Opaque surfaces as lit by LightingMethod::shading and ::compared; alpha 0 where there is none.
/// Published in draw(), where two methods are compared.
struct ComparedRadiance {
    TextureId left;
    TextureId right;
};

/// The layers of shadow masks, as textures of this frame's graph: one per light with a shadow
/// volume (shadow_volume_pass.h). They are valid for opaque surfaces only.
struct ShadowMasks {
    TextureId layers;
};
void bind_shadow_masks(PassContext& context, const ViewData& view);

/// The radiance texture of a view, not yet written.
[[nodiscard]] TextureId
create_radiance(FrameGraph& graph, const ViewData& view, std::string_view name = "radiance");

}  // namespace limn
