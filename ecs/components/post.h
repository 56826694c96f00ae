#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// From scene radiance to the display (hdr.pipeline), in this order:
//
//     haze off          c = max(c - defog * mean color, 0)
//     exposure          c = c * 2^ev, times key / log-average luminance unless it is manual
//     tone curve        the radiances there are to those that a display has
//     encoding, dither  for 8 bits
//
// Statistics and adaptation stay on the GPU; none of it costs anything while nothing asks for it.

/// Who decides how much light is right.
enum class Metering : std::uint8_t {
    Manual,  ///< `ev` alone
    Key,     ///< the picture: its log-average luminance becomes `key`
    Auto,    ///< the same, and the eye takes `adaptation` to follow
};

enum class ToneCurve : std::uint8_t {
    Neutral,   ///< Khronos PBR neutral: base colors survive
    Aces,      ///< ACES filmic fit (Hill 2017)
    Linear,    ///< clamp: for comparisons
    Reinhard,  ///< L / (1 + L), or with `white` (Reinhard 2002)
    Local,     ///< dodge and burn: L / (1 + the mean of a region as large as it is even)
    Knee,      ///< ln(1 + contrast c) / contrast and gamma: the mapper of HDR image viewers
};

enum class DisplayEncoding : std::uint8_t {
    Srgb,   ///< IEC 61966-2-1
    Power,  ///< 1 / gamma; Knee has it always
};

/// Resource: how radiance is shown.
struct Exposure {
    float ev = 0.0f;  ///< radiance is multiplied by 2^ev before the curve, -24 .. 24
    ToneCurve curve = ToneCurve::Aces;
    Metering metering = Metering::Manual;
    float key = 0.18f;           ///< log-average luminance after metering; 0.045 .. 0.72
    float adaptation = 0.5f;     ///< time constant of Auto [s], 0 = at once
    float darkest = 1e-4f;       ///< luminance below which metering lifts no further, > 0
    float brightest = 65504.0f;  ///< luminance above which it dims no further
    float white = 4.0f;          ///< of Reinhard: luminance after exposure shown as 1; 0 = none
    float contrast = 0.0f;       ///< of Knee: 0 is none, 1 much
    float defog = 0.0f;          ///< share of the mean color taken off, 0 .. 0.01 as a rule
    DisplayEncoding encoding = DisplayEncoding::Srgb;
    float gamma = 2.2f;  ///< of Power and Knee, 1 .. 4
    bool dither = true;  ///< before 8 bits; without it, dark ramps show bands

    bool operator==(const Exposure&) const = default;
};

template <typename Visitor>
void visit_fields(Exposure& exposure, Visitor&& visit) {
    visit(
        "ev", exposure.ev,
        {.doc = "radiance times 2^ev before the curve", .unit = "EV", .min = -24, .max = 24});
    visit(
        "curve", exposure.curve,
        {.doc = "tone curve", .values = "neutral aces linear reinhard local knee"});
    visit(
        "metering", exposure.metering,
        {.doc = "who decides how much light is right", .values = "manual key auto"});
    visit(
        "key", exposure.key,
        {.doc = "log-average luminance after metering", .min = 1e-3, .max = 10});
    visit(
        "adaptation", exposure.adaptation,
        {.doc = "time constant of auto", .unit = "s", .min = 0, .max = 60});
    visit(
        "darkest", exposure.darkest,
        {.doc = "luminance below which metering lifts no further", .min = 1e-6, .max = 65504});
    visit(
        "brightest", exposure.brightest,
        {.doc = "luminance above which metering dims no further", .min = 1e-6, .max = 65504});
    visit(
        "white", exposure.white,
        {.doc = "of reinhard: luminance after exposure shown as 1; 0 = none",
         .min = 0,
         .max = 65504});
    visit("contrast", exposure.contrast, {.doc = "of knee: 0 = none", .min = 0, .max = 100});
    visit(
        "defog", exposure.defog, {.doc = "share of the mean color taken off", .min = 0, .max = 1});
    visit(
        "encoding", exposure.encoding,
        {.doc = "of display codes; knee has power always", .values = "srgb power"});
    visit("gamma", exposure.gamma, {.doc = "of power and knee", .min = 1, .max = 4});
    visit("dither", exposure.dither, {.doc = "before 8 bits"});
}

}  // namespace limn
