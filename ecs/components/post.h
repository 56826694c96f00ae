#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// From scene radiance to the display (hdr.pipeline), in this order:
//
//     defog             c = max(c - defog * mean color, 0)
//     exposure          c = c * 2^ev, times key / log-average luminance unless metering is manual
//     tone curve        maps scene radiance to display radiance
//     encoding, dither  for 8 bits
//
// Statistics and adaptation stay on the GPU and cost nothing while unused.
// Techniques: hdr.pipeline

/// How the exposure is determined.
enum class Metering : std::uint8_t {
    Manual,  ///< `ev` only
    Key,     ///< maps the image's log-average luminance to `key`
    Auto,    ///< the same, with eye adaptation over `adaptation`
};

enum class ToneCurve : std::uint8_t {
    Neutral,   ///< Khronos PBR neutral: base colors survive
    Aces,      ///< ACES filmic fit (Hill 2017)
    Linear,    ///< clamped, for comparisons
    Reinhard,  ///< L / (1 + L), or with `white` (Reinhard 2002)
    Local,     ///< dodge and burn: L / (1 + mean of the largest uniform neighborhood)
    Knee,      ///< ln(1 + contrast c) / contrast and gamma, as in HDR image viewers
};

enum class DisplayEncoding : std::uint8_t {
    Srgb,   ///< IEC 61966-2-1
    Power,  ///< exponent 1 / gamma; Knee always uses it
};

/// Resource: exposure and tone mapping.
struct Exposure {
    float ev = 0.0f;
    ToneCurve curve = ToneCurve::Aces;
    Metering metering = Metering::Manual;
    float manual_ev = 0.0f;
    bool meter_surfaces = false;
    float key = 0.18f;
    float adaptation = 0.5f;
    float min_luminance = 1e-4f;
    float max_luminance = 65504.0f;
    float white = 4.0f;
    float contrast = 0.0f;
    float defog = 0.0f;
    DisplayEncoding encoding = DisplayEncoding::Srgb;
    float gamma = 2.2f;
    bool dither = true;  ///< before quantization to 8 bits, against banding in dark gradients

    bool operator==(const Exposure&) const = default;
};

LIMN_FIELDS(Exposure) {
    LIMN_FIELD(
        ev, "exposure, on top of the metered or manual one: radiance times 2^ev", "EV", -24, 24);
    LIMN_FIELD(curve, .doc = "tone curve", .values = "neutral aces linear reinhard local knee");
    LIMN_FIELD(metering, .doc = "how the exposure is determined", .values = "manual key auto");
    LIMN_FIELD(manual_ev, "exposure of manual metering, to which ev is added", "EV", -24, 24);
    LIMN_FIELD(meter_surfaces, "metering all but ignores pixels without a surface: sky, backdrop");
    LIMN_FIELD(key, "log-average luminance after metering", "", 1e-3, 10);
    LIMN_FIELD(adaptation, "time constant of eye adaptation with auto; 0 = immediate", "s", 0, 60);
    LIMN_FIELD(
        min_luminance,
        .doc = "smallest average luminance used by metering; the default keeps night dark, 1e-7 "
               "is below a full moon's light where the sun has 5 lx",
        .min = 1e-8, .max = 65504, .renamed = "darkest");
    LIMN_FIELD(
        max_luminance, .doc = "largest average luminance used by metering", .min = 1e-6,
        .max = 65504, .renamed = "brightest");
    LIMN_FIELD(white, "reinhard: luminance after exposure that maps to 1; 0 = none", "", 0, 65504);
    LIMN_FIELD(contrast, "contrast of knee; 0 = none", "", 0, 100);
    LIMN_FIELD(defog, "fraction of the mean color subtracted", "", 0, 1);
    LIMN_FIELD(encoding, .doc = "display encoding; knee always uses power", .values = "srgb power");
    LIMN_FIELD(gamma, "gamma of power and knee", "", 1, 4);
    LIMN_FIELD(dither, "dithering before quantization to 8 bits");
}

}  // namespace limn
