#pragma once

#include "ecs/components/ocean.h"

#include <vector>

namespace limn {

// Energy of wind waves over frequency and direction, in double precision. A spectrum S is the
// density of the height variance over frequency or wave number: its integral is m0 [m^2], and the
// significant wave height is 4 sqrt(m0).
//
// Omnidirectional spectra:
// - Pierson and Moskowitz 1964, as in Mastin et al. 1987 (water.ocean-spectrum): alpha g^2 f^-5
//   (2 pi)^-4 e^(-5/4 (f_p / f)^4), f_p = 0.13 g / wind
// - Phillips 1957, as in Tessendorf 2001: alpha / 2 k^-3 e^(-1 / (k L)^2), L = wind^2 / g
// - JONSWAP (Hasselmann et al. 1973): Pierson and Moskowitz's shape with alpha and peak from the
//   fetch, times gamma^r about the peak
// - TMA (Bouws et al. 1985): JONSWAP times the exact depth factor of Kitaigorodskii et al. 1975
//
// Directional spreading, normalized to an integral of 1: cos^2p(theta / 2) after Hasselmann et al.
// 1980, sech^2(beta theta) after Donelan et al. 1985 and Banner 1990, cos^2; with the swell of
// Horvath 2015 ("Empirical Directional Wave Spectra for Computer Graphics"), an additional factor
// cos^2s(theta / 2) that is stronger for long waves.

inline constexpr double kPhillipsConstant = 0.0081;  ///< alpha of a fully developed sea

/// Pierson and Moskowitz's F1 at f [Hz] with the peak f_p [Hz], in [m^2/Hz]; 0 at f <= 0.
[[nodiscard]] double wind_sea_energy(double f, double f_p, double alpha = kPhillipsConstant);

/// The exponent p of cos^2p(theta / 2) at f_over_peak = f / f_p; 9.77 at the peak.
[[nodiscard]] double wind_sea_spread_power(double f_over_peak);
/// The same with the ratio of wind speed to phase speed at the peak, wind omega_p / g.
[[nodiscard]] double hasselmann_spread_power(double f_over_peak, double wind_over_waves);
/// beta of sech^2(beta theta).
[[nodiscard]] double donelan_banner_beta(double f_over_peak);
/// Increase of p by swell 0 .. 1.
[[nodiscard]] double swell_power(double f_over_peak, double swell);

/// N_p: integral of cos^2p(theta / 2) over the circle.
[[nodiscard]] double cosine_power_integral(double p);

/// JONSWAP at omega [rad/s] with the peak omega_p, in [m^2 s].
[[nodiscard]] double jonswap_energy(double omega, double omega_p, double alpha, double gamma);
/// Factor on it in water of this depth, 0 .. 1.
[[nodiscard]] double depth_factor(double omega, double depth);

/// Omnidirectional Phillips spectrum at wave number k, in [m^3]; 0 at k <= 0.
[[nodiscard]] double phillips_energy(double k, double wind);

/// Parameters of a sea, precomputed for the evaluation of many waves.
struct OceanEnergy {
    OceanSpectrum spectrum = OceanSpectrum::WindSea;
    OceanSpreading spreading = OceanSpreading::WindSea;
    double wind = 0;            ///< [m/s]; 0 = no energy
    double wind_direction = 0;  ///< [rad]
    double depth = 0;           ///< [m]
    double peak = 0;            ///< omega_p [rad/s]
    double alpha = kPhillipsConstant;
    double gamma = 1;
    double swell = 0;
    std::vector<double> spread_scale;  ///< 1 / integral over the circle, if there is no closed form
};

[[nodiscard]] OceanEnergy make_ocean_energy(const Ocean& ocean);

/// Omnidirectional energy density at omega [m^2 s].
[[nodiscard]] double frequency_energy(const OceanEnergy& sea, double omega);

/// Directional density at the angle theta from the wind [1/rad].
[[nodiscard]] double directional_density(const OceanEnergy& sea, double omega, double theta);

/// Energy density over wave vectors at k = (kx, kz) [m^4]: frequency_energy * directional_density *
/// (d omega / d k) / k; 0 at k = 0. Does not include Ocean::amplitude.
[[nodiscard]] double wave_energy(const OceanEnergy& sea, double kx, double kz);

}  // namespace limn
