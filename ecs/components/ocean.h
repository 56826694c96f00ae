#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Open water under wind: many waves at once, from a spectrum, on patches that repeat. What an
// artist sets, what the systems make of it each step, and the foam that stays behind.

/// How much energy waves of each length have.
enum class OceanSpectrum : std::uint8_t {
    WindSea,   ///< Pierson and Moskowitz 1964, peak 0.13 g / wind: a sea as high as it gets
    Phillips,  ///< Phillips 1957 as in Tessendorf 2001: waves against the wind, too
    Jonswap,   ///< Hasselmann et al. 1973: grows with the fetch, sharp peak
    Tma,       ///< Bouws et al. 1985: the same over a shallow floor
};

/// How the energy of each length is spread about the wind.
enum class OceanSpreading : std::uint8_t {
    WindSea,        ///< cos^2p(theta / 2), p after Hasselmann et al. 1980, frequency alone
    Hasselmann,     ///< the same with the wind's speed over the waves' (Horvath 2015)
    DonelanBanner,  ///< sech^2(beta theta) (Donelan et al. 1985, Banner 1990)
    CosineSquared,  ///< cos^2 theta, along and against the wind
};

/// A sea. Beside it the systems keep OceanState and OceanFoam.
struct Ocean {
    OceanSpectrum spectrum = OceanSpectrum::WindSea;
    OceanSpreading spreading = OceanSpreading::WindSea;
    float wind_speed = 9.0f;      ///< 10 m above the water [m/s]; 0 = flat
    float wind_direction = 0.0f;  ///< where to, from +x toward +z [rad]
    float fetch = 100e3f;         ///< how far the wind has blown over water [m]
    float depth = 500.0f;         ///< [m]; shallow water slows long waves down
    float gamma = 3.3f;           ///< how much the peak stands out; Jonswap and Tma
    float swell = 0.0f;           ///< 0 .. 1: long waves gather about the wind's direction
    float amplitude = 1.0f;       ///< scales all heights
    float choppiness = 1.0f;      ///< shift toward crests; 1 = as water does, 0 = none

    int cascades = 3;          ///< patches of different size; each takes a band of lengths
    float patch = 200.0f;      ///< side of the largest, after which it repeats [m]
    int resolution = 256;      ///< points along a side of each; a power of two
    float loop_period = 0.0f;  ///< all repeats after so long [s]; 0 = never
    std::uint32_t seed = 1;

    float foam_threshold = 0.75f;  ///< share of its area at rest below which water foams
    float foam_rate = 60.0f;       ///< of covering, times how far it is below [1/s]
    float foam_decay = 4.0f;       ///< time to an e-th [s]

    friend bool operator==(const Ocean&, const Ocean&) = default;
};

/// Each patch is so many times smaller than the one before: golden ratio cubed, so that their
/// repeats do not fall together.
inline constexpr double kOceanPatchRatio = 4.2360679774997896;

inline constexpr int kMaxOceanCascades = 4;

/// One patch. The water at rest at q = (x, z) is at (x, 0, z) + (shift_x, height, shift_z), summed
/// over the patches. Point (i, j) of a plane, at q = (i, j) * patch / size modulo the patch, is at
/// j * size + i; between points bilinear. All planes have size * size floats.
struct OceanCascade {
    int size = 0;
    float patch = 0;      ///< side [m]
    float band_low = 0;   ///< its waves have wave numbers from here ...
    float band_high = 0;  ///< ... up to here [rad/m]

    // The spectrum: wave (n, m), with the wave numbers axis[n] along x and axis[m] along z, is at
    // n * size + m. Its height is ahead e^(-i omega t) + behind e^(i omega t).
    std::vector<float> axis;       ///< wave numbers along x and along z [rad/m], `size` of them
    std::vector<float> frequency;  ///< omega [rad/s]
    std::vector<float> ahead_re;   ///< h0(k) [m]: runs along k
    std::vector<float> ahead_im;
    std::vector<float> behind_re;  ///< conj(h0(-k)): runs against it
    std::vector<float> behind_im;

    std::vector<float> height;   ///< [m]
    std::vector<float> shift_x;  ///< toward crests, choppiness included [m]
    std::vector<float> shift_z;
    std::vector<float> slope_x;  ///< d height / dx at rest
    std::vector<float> slope_z;
    std::vector<float> shift_xx;  ///< d shift_x / dx
    std::vector<float> shift_zz;
    std::vector<float> shift_xz;  ///< d shift_x / dz = d shift_z / dx

    std::vector<float> last_height;  ///< one step earlier
    std::vector<float> last_shift_x;
    std::vector<float> last_shift_z;
};

/// Where the water is now. A function of Ocean and time; update_oceans alone writes it.
struct OceanState {
    Ocean made_for;     ///< what the spectra are those of
    double time = 0.0;  ///< of the fields [s]
    float step = 0.0f;  ///< how much earlier the last ones are [s]
    std::vector<OceanCascade> cascades;
};

/// Where waves have broken. It stays with the water at rest, not where it is shifted to.
struct OceanFoam {
    std::vector<float> coverage;  ///< 0 .. 1; that of cascade c begins at c * size * size
};

template <>
struct ComponentTraits<OceanState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// A copy of a prefab has no past.
template <>
struct ComponentTraits<OceanFoam> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

template <typename Visitor>
void visit_fields(Ocean& ocean, Visitor&& visit) {
    visit(
        "spectrum", ocean.spectrum,
        {.doc = "how much energy waves of each length have",
         .values = "wind_sea phillips jonswap tma"});
    visit(
        "spreading", ocean.spreading,
        {.doc = "of that energy about the wind",
         .values = "wind_sea hasselmann donelan_banner cosine_squared"});
    visit(
        "wind_speed", ocean.wind_speed,
        {.doc = "10 m above the water; 0 = flat", .unit = "m/s", .min = 0, .max = 60});
    visit(
        "wind_direction", ocean.wind_direction,
        {.doc = "where to, from +x toward +z", .unit = "rad", .min = -7, .max = 7});
    visit(
        "fetch", ocean.fetch,
        {.doc = "how far the wind has blown over water", .unit = "m", .min = 100, .max = 1e7});
    visit(
        "depth", ocean.depth,
        {.doc = "shallow water slows long waves down", .unit = "m", .min = 0.05, .max = 12000});
    visit(
        "gamma", ocean.gamma,
        {.doc = "how much the peak stands out; jonswap and tma", .min = 1, .max = 20});
    visit(
        "swell", ocean.swell,
        {.doc = "long waves gather about the wind's direction", .min = 0, .max = 1});
    visit("amplitude", ocean.amplitude, {.doc = "scales all heights", .min = 0, .max = 10});
    visit("choppiness", ocean.choppiness, {.doc = "shift toward crests", .min = 0, .max = 4});
    visit(
        "cascades", ocean.cascades,
        {.doc = "patches of different size; each takes a band of lengths",
         .min = 1,
         .max = kMaxOceanCascades});
    visit(
        "patch", ocean.patch,
        {.doc = "side of the largest, after which it repeats", .unit = "m", .min = 1, .max = 1e4});
    visit(
        "resolution", ocean.resolution,
        {.doc = "points along a side of each; rounded down to a power of two",
         .min = 16,
         .max = 1024});
    visit(
        "loop_period", ocean.loop_period,
        {.doc = "all repeats after so long; 0 = never", .unit = "s", .min = 0, .max = 1e5});
    visit("seed", ocean.seed, {.doc = "of heights and phases"});
    visit(
        "foam_threshold", ocean.foam_threshold,
        {.doc = "share of its area at rest below which water foams", .min = -2, .max = 1});
    visit(
        "foam_rate", ocean.foam_rate,
        {.doc = "of covering, times how far below", .unit = "1/s", .min = 0, .max = 1000});
    visit(
        "foam_decay", ocean.foam_decay,
        {.doc = "time to an e-th", .unit = "s", .min = 0.01, .max = 1e4});
}

template <typename Visitor>
void visit_fields(OceanFoam& foam, Visitor&& visit) {
    visit("coverage", foam.coverage, {.doc = "of each point of each cascade"});
}

}  // namespace limn
