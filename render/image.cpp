#include "render/image.h"

#include "render/environment/airlight_pass.h"
#include "render/environment/environment_pass.h"
#include "render/environment/fog_pass.h"
#include "render/environment/panorama_layer_pass.h"
#include "render/environment/probe_pass.h"
#include "render/environment/sky_pass.h"
#include "render/geometry/aov_pass.h"
#include "render/geometry/blend_pass.h"
#include "render/geometry/curvature_view_pass.h"
#include "render/geometry/gbuffer_pass.h"
#include "render/geometry/tangent_frames_pass.h"
#include "render/lens/dazzle_pass.h"
#include "render/lens/depth_of_field_pass.h"
#include "render/lens/glare_pass.h"
#include "render/lens/glow_pass.h"
#include "render/lens/lens_flare_pass.h"
#include "render/lens/motion_blur_pass.h"
#include "render/lens/speed_line_pass.h"
#include "render/lens/temporal_pass.h"
#include "render/lens/tone_mapper.h"
#include "render/lens/vignette_pass.h"
#include "render/light/caustics_pass.h"
#include "render/light/cluster_pass.h"
#include "render/light/hatching_pass.h"
#include "render/light/highlight_map_pass.h"
#include "render/light/ink_lines_pass.h"
#include "render/light/light_pass.h"
#include "render/light/lobe_tables.h"
#include "render/light/mirror_caustic_pass.h"
#include "render/light/normalization_cube.h"
#include "render/light/shading_comparison_pass.h"
#include "render/light/shading_marks_pass.h"
#include "render/light/subsurface_pass.h"
#include "render/material/furrow_pass.h"
#include "render/material/texture_combine_pass.h"
#include "render/material/texture_feedback_pass.h"
#include "render/material/texture_layers_pass.h"
#include "render/material/texture_shade_pass.h"
#include "render/material/wrinkle_maps_pass.h"
#include "render/material/wrinkle_pass.h"
#include "render/particles/particle_pass.h"
#include "render/particles/particle_shadow_pass.h"
#include "render/shadow/shadow_pass.h"
#include "render/skinning/deform_pass.h"
#include "render/water/ripple_pass.h"
#include "render/water/water_pass.h"
#include "render/water/water_surfaces.h"
#include "render/water/water_veil_pass.h"

// Techniques: engine.draw-frame, post.effect-pipeline

namespace limn {
namespace {

constexpr EffectEntry kImage[] = {
    // What is in the world, and what is visible in each view.
    effect<TextureCombineEffect>(0), effect<TextureFeedbackEffect>(0),
    effect<TextureLayersEffect>(0),
    effect<WrinkleMapsEffect>(0),          // normals, with which textures are shaded
    effect<TextureShadeEffect>(0),         // after textures are combined
    effect<DeformEffect>(kSceneViews),     // before all that draws meshes
    effect<WrinkleEffect>(kSceneViews),    // where deformed skin is compressed
    effect<LightListEffect>(kSceneViews),  // records and clusters
    effect<EnvironmentEffect>(kSceneViews), effect<GbufferEffect>(kSceneViews),
    effect<HighlightMapEffect>(kMainViews),    // precomputed highlights
    effect<LobeTableEffect>(kSceneViews),      // precomputed lobes
    effect<NormalizationEffect>(kSceneViews),  // precomputed unit vectors
    effect<WaterBodiesEffect>(kSceneViews),    // water surfaces, and what is in the water
    effect<ShadowEffect>(kSceneViews),         // maps and volumes; after water, which asks for maps
    effect<ParticleShadowEffect>(kSceneViews),  // maps of the light that particles transmit
    effect<CausticsEffect>(kSceneViews),        // after shadows, which occlude their light

    // Light.
    effect<LightEffect>(kSceneViews),
    effect<ShadingComparisonEffect>(kMainViews),         // two methods as one image
    effect<SubsurfaceEffect>(kMainViews | kMirrorView),  // subsurface scattering
    effect<SkyEffect>(kSceneViews),
    effect<PanoramaLayerEffect>(kSceneViews),  // over the sky
    effect<MirrorCausticEffect>(kSceneViews),
    effect<HatchingEffect>(kMainViews),  // of everything opaque; before what lies over it
    effect<InkLinesEffect>(kMainViews),  // over the strokes
    effect<ParticlesUnderWaterEffect>(kSceneViews),  // visible through the water
    effect<WaterEffect>(kSceneViews),                // over everything opaque
    effect<WaterVeilEffect>(kSceneViews),            // the water in front of an underwater camera
    effect<FogEffect>(kSceneViews),       // over all that has depth; later effects fog themselves
    effect<AirlightEffect>(kMainViews),   // halos and beams of lamps in the fog
    effect<ParticleEffect>(kSceneViews),  // those behind blended surfaces
    effect<BlendEffect>(kSceneViews),     // after sky and water, which are visible through it
    effect<ParticleFrontEffect>(kSceneViews),  // over all surfaces
    effect<SpeedLineEffect>(kMainViews), effect<CurvatureViewEffect>(kMainViews),
    effect<TangentFramesEffect>(kMainViews),

    // The end of views other than the camera's.
    effect<ProbeEffect>(kSceneViews),  // requests its faces as views; lights all others
    effect<WaterMirrorEffect>(kMirrorView), effect<AovEffect>(kMainViews),

    // The lens and the shutter.
    effect<TemporalEffect>(kMainViews), effect<RippleEffect>(kMainViews),
    effect<MotionBlurEffect>(kMainViews), effect<DepthOfFieldEffect>(kMainViews),
    effect<LensFlareEffect>(kMainViews), effect<DazzleEffect>(kMainViews),
    effect<GlareEffect>(kFilmViews), effect<GlowEffect>(kMainViews | kMeanView),
    effect<ShadingMarksEffect>(kMainViews),  // over the image: not blurred by the lens
    effect<VignetteEffect>(kFilmViews),

    // The film.
    effect<ToneMapEffect>(kFilmViews),
    effect<FurrowEffect>(kMainViews | kMeanView),  // over the displayed image: colors are exact
};

/// Of what is above, what a scene is recognized by. No probes: smooth surfaces reflect the sky.
constexpr EffectEntry kPlainImage[] = {
    effect<TextureCombineEffect>(0),
    effect<TextureFeedbackEffect>(0),
    effect<TextureLayersEffect>(0),
    effect<WrinkleMapsEffect>(0),
    effect<TextureShadeEffect>(0),
    effect<DeformEffect>(kSceneViews),
    effect<WrinkleEffect>(kSceneViews),
    effect<LightListEffect>(kSceneViews),
    effect<EnvironmentEffect>(kSceneViews),
    effect<GbufferEffect>(kSceneViews),
    effect<HighlightMapEffect>(kMainViews),
    effect<LobeTableEffect>(kSceneViews),
    effect<NormalizationEffect>(kSceneViews),
    effect<WaterBodiesEffect>(kSceneViews),
    effect<ShadowEffect>(kSceneViews),
    effect<LightEffect>(kSceneViews),
    effect<SubsurfaceEffect>(kMainViews | kMirrorView),
    effect<SkyEffect>(kSceneViews),
    effect<PanoramaLayerEffect>(kSceneViews),
    effect<ParticlesUnderWaterEffect>(kSceneViews),
    effect<WaterEffect>(kSceneViews),
    effect<WaterVeilEffect>(kSceneViews),
    effect<FogEffect>(kSceneViews),
    effect<ParticleEffect>(kSceneViews),
    effect<BlendEffect>(kSceneViews),
    effect<ParticleFrontEffect>(kSceneViews),
    effect<WaterMirrorEffect>(kMirrorView),
    effect<AovEffect>(kMainViews),
    effect<ToneMapEffect>(kFilmViews),
};

}  // namespace

std::span<const EffectEntry> standard_image() {
    return kImage;
}

std::span<const EffectEntry> plain_image() {
    return kPlainImage;
}

}  // namespace limn
