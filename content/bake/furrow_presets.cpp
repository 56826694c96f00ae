#include "content/bake/furrow_presets.h"

// Techniques: wrinkle.furrow.presets

namespace limn {
namespace {

using enum FurrowLighting;

constexpr FurrowPreset kPresets[] = {
    // name, figure, noise, bump, lighting, melanin, blood, specular, shininess, scale
    {"hand", "6.1", 0, 0.5f, Blinn, 0.2f, 0.5f, 0.2f, 100, 1.1f},
    {"foot", "6.2", 0, 0.5f, Blinn, 0.2f, 0.5f, 0.2f, 100, 1.0f},
    {"arm", "6.3", 0, 0.5f, Blinn, 0.2f, 0.5f, 0.2f, 100, 0.8f},
    {"hand_close_up", "6.4", 0, 1, Blinn, 0.2f, 0.5f, 0.2f, 100, 1.1f},
    {"faint", "6.5a", 0, 0.3f, Blinn, 0.2f, 0.5f, 0.2f, 100, 1.1f},
    {"distinct", "6.5b", 0, 0.8f, Blinn, 0.2f, 0.5f, 0.2f, 100, 1.1f},
    {"smooth", "6.6a", 0, 0.3f, Blinn, 0.2f, 0.5f, 0.3f, 100, 1.0f},
    {"rough", "6.6b", 0.3f, 0.3f, Blinn, 0.2f, 0.5f, 0.3f, 100, 1.0f},
    {"brdf_1", "6.7a", 0, 0.5f, Brdf1, 0, 0, 0, 0, 0.8f},
    {"brdf_2", "6.7b", 0, 0.5f, Brdf2, 0, 0, 0, 0, 0.8f},
    {"light_skin", "6.7c", 0, 0.5f, Blinn, 0.05f, 0.2f, 0.1f, 120, 0.8f},
    {"dark_skin", "6.7d", 0, 0.5f, Blinn, 0.5f, 0.6f, 0.4f, 70, 0.8f},
};

bool equal(const FurrowFunctions& a, const FurrowFunctions& b) {
    return a.angle == b.angle && a.length == b.length && a.density == b.density
           && a.width == b.width && a.depth == b.depth && a.limit == b.limit;
}

}  // namespace

std::span<const FurrowPreset> furrow_presets() {
    return kPresets;
}

FurrowStyle with_preset(FurrowStyle style, const FurrowPreset& preset) {
    style.noise = preset.noise;
    style.bump = preset.bump;
    style.scale = preset.scale;
    return style;
}

bool needs_growth(const FurrowStyle& a, const FurrowStyle& b) {
    return !equal(a.functions, b.functions) || a.scale != b.scale || a.seed != b.seed
           || a.literal_turn != b.literal_turn;
}

}  // namespace limn
