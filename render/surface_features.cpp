#include "render/surface_features.h"

#include "render/variant.h"

namespace limn {
namespace {

struct FeatureName {
    SurfaceFeature bit;
    const char* definition;
};
constexpr FeatureName kNames[] = {
    {kBaseColorMap, "BASE_COLOR_MAP"},
    {kMetalRoughMap, "METAL_ROUGH_MAP"},
    {kNormalMap, "NORMAL_MAP"},
    {kOcclusionMap, "OCCLUSION_MAP"},
    {kEmissionMap, "EMISSION_MAP"},
    {kUvMap, "UV_MAP"},
    {kUvMaps, "UV_MAPS"},
    {kAlphaMask, "ALPHA_MASK"},
    {kDoubleSided, "DOUBLE_SIDED"},
    {kSrgbBaseColor, "SRGB_BASE_COLOR"},
    {kVertexColor, "VERTEX_COLOR"},
    {kVelocity, "VELOCITY"},
    {kOcclusionShared, "OCCLUSION_SHARED"},
    {kInflate, "INFLATE"},
    {kDeformed, "DEFORMED"},
};

}  // namespace

void add_features(Variant& variant, std::uint32_t features) {
    for (const FeatureName& feature : kNames) {
        if ((features & feature.bit) != 0) {
            variant.add(feature.definition);
        }
    }
}

}  // namespace limn
