#include "render/material/surface_features.h"

#include "render/variant.h"

// Techniques: wrinkle.compression.integration

namespace limn {
namespace {

struct FeatureName {
    std::uint32_t bit;
    const char* definition;
};
constexpr FeatureName kNames[] = {
    {kUvMap, "UV_MAP"},
    {kUvMaps, "UV_MAPS"},
    {kAlphaMask, "ALPHA_MASK"},
    {kDoubleSided, "DOUBLE_SIDED"},
    {kSrgbBaseColor, "SRGB_BASE_COLOR"},
    {kOcclusionShared, "OCCLUSION_SHARED"},
    {kVertexColor, "VERTEX_COLOR"},
    {kInflate, "INFLATE"},
    {kDeformed, "DEFORMED"},
    {kVelocity, "VELOCITY"},
    {kTransmission, "TRANSMISSION"},
    {kRefraction, "REFRACTION"},
    {kStrands, "STRANDS"},
    {kLayered, "LAYERED_SURFACE"},
    {kAnisotropic, "ANISOTROPIC"},
    {kDispersion, "DISPERSION"},
    {kLeanNormals, "LEAN_NORMALS"},
    {kBumpGate, "BUMP_GATE"},
    {kBumpSmooth, "BUMP_SMOOTH"},
    {kBumpRamp, "BUMP_RAMP"},
    {kClassicBumps, "CLASSIC_BUMPS"},
    {kDressed, "DRESSED"},
};

constexpr bool has_bits_of_their_own() {
    std::uint32_t taken = 0;
    for (const FeatureName& feature : kNames) {
        if ((taken & feature.bit) != 0) {
            return false;
        }
        taken |= feature.bit;
    }
    return true;
}
static_assert(has_bits_of_their_own());

}  // namespace

void add_features(Variant& variant, const SurfaceFeatures& features) {
    for (const FeatureName& feature : kNames) {
        if ((features.bits & feature.bit) != 0) {
            variant.add(feature.definition);
        }
    }
    add_hook_definitions(variant, features.hooks);
    for (const MapSlot& slot : map_slots()) {
        if (features.maps.has(slot.number)) {
            variant.add(slot.definition, static_cast<int>(features.maps.unit(slot.number)));
        }
    }
}

}  // namespace limn
