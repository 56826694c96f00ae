#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Wind-driven open water: spectral waves on periodic patches. The artist's settings, the fields
// that the systems compute from them each step, and the persistent foam.
// Techniques: water.ocean-spectrum

/// Energy spectrum over wavelength.
enum class OceanSpectrum : std::uint8_t {
    WindSea,   ///< Pierson and Moskowitz 1964, peak 0.13 g / wind: a fully developed sea
    Phillips,  ///< Phillips 1957 as in Tessendorf 2001: includes waves against the wind
    Jonswap,   ///< Hasselmann et al. 1973: fetch-limited, sharp peak
    Tma,       ///< Bouws et al. 1985: JONSWAP in shallow water
};

/// Directional spreading of the energy about the wind.
enum class OceanSpreading : std::uint8_t {
    WindSea,        ///< cos^2p(theta / 2), p after Hasselmann et al. 1980, from frequency only
    Hasselmann,     ///< the same, also from the ratio of wind to wave speed (Horvath 2015)
    DonelanBanner,  ///< sech^2(beta theta) (Donelan et al. 1985, Banner 1990)
    CosineSquared,  ///< cos^2 theta, along and against the wind
};

/// Size ratio of successive patches: the golden ratio cubed, so that their periods do not align.
inline constexpr double kOceanPatchRatio = 4.2360679774997896;

inline constexpr int kMaxOceanCascades = 4;

/// A sea. The systems add OceanState and OceanFoam to it.
struct Ocean {
    OceanSpectrum spectrum = OceanSpectrum::WindSea;
    OceanSpreading spreading = OceanSpreading::WindSea;
    float wind_speed = 9.0f;
    float wind_direction = 0.0f;
    float fetch = 100e3f;
    float depth = 500.0f;
    float gamma = 3.3f;
    float swell = 0.0f;
    float amplitude = 1.0f;
    float choppiness = 1.0f;

    int cascades = 3;
    float patch = 200.0f;
    int resolution = 256;
    float loop_period = 0.0f;
    std::uint32_t seed = 1;

    float foam_threshold = 0.75f;
    float foam_rate = 60.0f;
    float foam_decay = 4.0f;

    friend bool operator==(const Ocean&, const Ocean&) = default;
};

LIMN_FIELDS(Ocean) {
    LIMN_FIELD(
        spectrum, .doc = "energy spectrum over wavelength",
        .values = "wind_sea phillips jonswap tma");
    LIMN_FIELD(
        spreading, .doc = "directional spreading of the energy about the wind",
        .values = "wind_sea hasselmann donelan_banner cosine_squared");
    LIMN_FIELD(wind_speed, "wind speed 10 m above the water; 0 = flat water", "m/s", 0, 60);
    LIMN_FIELD(wind_direction, "direction the wind blows toward, from +x toward +z", "rad", -7, 7);
    LIMN_FIELD(fetch, "distance over which the wind has acted on the water", "m", 100, 1e7);
    LIMN_FIELD(depth, "water depth; shallow water slows long waves", "m", 0.05, 12000);
    LIMN_FIELD(gamma, "peak enhancement factor of jonswap and tma", "", 1, 20);
    LIMN_FIELD(swell, "aligns long waves with the wind", "", 0, 1);
    LIMN_FIELD(amplitude, "scales all heights", "", 0, 10);
    LIMN_FIELD(choppiness, "horizontal displacement toward crests; 1 = physical", "", 0, 4);
    LIMN_FIELD(
        cascades, "patches of different size; each covers a band of wavelengths", "", 1,
        kMaxOceanCascades);
    LIMN_FIELD(patch, "side length (period) of the largest patch", "m", 1, 1e4);
    LIMN_FIELD(
        resolution, "grid points per side of each patch; rounded down to a power of two", "", 16,
        1024);
    LIMN_FIELD(loop_period, "the animation repeats after this time; 0 = never", "s", 0, 1e5);
    LIMN_FIELD(seed, "random seed of heights and phases");
    LIMN_FIELD(foam_threshold, "Jacobian of the displacement below which foam forms", "", -2, 1);
    LIMN_FIELD(foam_rate, "growth of foam coverage per unit below the threshold", "1/s", 0, 1000);
    LIMN_FIELD(foam_decay, "time constant of the decay to 1/e", "s", 0.01, 1e4);
}

/// One patch. The rest point q = (x, z) is displaced to (x, 0, z) + (shift_x, height, shift_z),
/// summed over the patches. Grid point (i, j) of a plane, at q = (i, j) * patch / size modulo the
/// patch, has index j * size + i; bilinear in between. All planes have size * size floats.
struct OceanCascade {
    int size = 0;
    float patch = 0;      ///< side [m]
    float band_low = 0;   ///< smallest wave number [rad/m]
    float band_high = 0;  ///< largest wave number [rad/m]

    // The spectrum: wave (n, m), with the wave numbers axis[n] along x and axis[m] along z, has
    // index n * size + m. Its height is ahead e^(-i omega t) + behind e^(i omega t).
    std::vector<float> axis;       ///< wave numbers along x and along z [rad/m], `size` of them
    std::vector<float> frequency;  ///< omega [rad/s]
    std::vector<float> ahead_re;   ///< h0(k) [m]: travels along k
    std::vector<float> ahead_im;
    std::vector<float> behind_re;  ///< conj(h0(-k)): travels against k
    std::vector<float> behind_im;

    std::vector<float> height;  ///< [m]
    std::vector<float>
        shift_x;  ///< horizontal displacement toward crests, including choppiness [m]
    std::vector<float> shift_z;
    std::vector<float> slope_x;  ///< d height / dx at rest
    std::vector<float> slope_z;
    std::vector<float> shift_xx;  ///< d shift_x / dx
    std::vector<float> shift_zz;
    std::vector<float> shift_xz;  ///< d shift_x / dz = d shift_z / dx

    std::vector<float> previous_height;  ///< previous step
    std::vector<float> previous_shift_x;
    std::vector<float> previous_shift_z;
};

/// Current displacement of the water, a function of Ocean and time. Only update_oceans writes it.
struct OceanState {
    Ocean made_for;     ///< settings from which the spectra were generated
    double time = 0.0;  ///< of the fields [s]
    float step = 0.0f;  ///< time since the previous fields [s]
    std::vector<OceanCascade> cascades;
};

/// Foam of breaking waves, stored at rest positions rather than displaced ones. The sum of all
/// waves breaks, as it is in the copy of the largest patch about the origin; other copies repeat
/// it.
struct OceanFoam {
    std::vector<float> coverage;  ///< 0 .. 1, at the points of the first cascade
};

LIMN_FIELDS(OceanFoam) {
    LIMN_FIELD(coverage, "foam coverage of each grid point of the first cascade");
}

template <>
struct ComponentTraits<OceanState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// Instances of a prefab start without foam.
template <>
struct ComponentTraits<OceanFoam> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
