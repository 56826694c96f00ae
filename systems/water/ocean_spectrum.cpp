#include "systems/water/ocean_spectrum.h"

#include "systems/water/water_dispersion.h"

#include <algorithm>
#include <cmath>

// Techniques: water.ocean-spectrum

namespace limn {

namespace {

/// ln |gamma(x)|. std::lgamma keeps the sign in a global variable, which threads would share.
double log_gamma(double x) {
    int sign = 0;
    return ::lgamma_r(x, &sign);
}

constexpr double kTurn = 6.283185307179586;  ///< 2 pi

// Scales of spreadings without closed form are sampled over the logarithm of omega / omega_p,
// over which they vary smoothly, except at the kinks of beta.
constexpr double kMinLog = -3.0;
constexpr double kMaxLog = 5.0;
constexpr int kSpectrumSamples = 512;

double sech(double x) {
    return 1.0 / std::cosh(x);
}

/// sech^2 or cos^2, times the swell factor; 1 at theta = 0.
double unnormalized_shape(const OceanEnergy& sea, double f_over_peak, double theta) {
    const double swell = swell_power(f_over_peak, sea.swell);
    const double elongation = std::pow(std::abs(std::cos(0.5 * theta)), 2.0 * swell);
    if (sea.spreading == OceanSpreading::DonelanBanner) {
        return elongation * square(sech(donelan_banner_beta(f_over_peak) * theta));
    }
    return elongation * square(std::cos(theta));
}

/// Twice Simpson's rule over half the circle.
double integrate_shape(const OceanEnergy& sea, double f_over_peak) {
    constexpr int kSteps = 400;
    const double step = 0.5 * kTurn / kSteps;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        sum += weight * unnormalized_shape(sea, f_over_peak, step * i);
    }
    return 2.0 * sum * step / 3.0;
}

double log_of_sample(int i) {
    return kMinLog + (kMaxLog - kMinLog) * i / (kSpectrumSamples - 1);
}

bool has_closed_form(OceanSpreading spreading) {
    return spreading == OceanSpreading::WindSea || spreading == OceanSpreading::Hasselmann;
}

double spread_scale(const OceanEnergy& sea, double f_over_peak) {
    const double at = (std::log(f_over_peak) - kMinLog) / (kMaxLog - kMinLog);
    const double x = std::clamp(at, 0.0, 1.0) * (kSpectrumSamples - 1);
    const int i = std::min(static_cast<int>(x), kSpectrumSamples - 2);
    return sea.spread_scale[i] + (x - i) * (sea.spread_scale[i + 1] - sea.spread_scale[i]);
}

}  // namespace

double wind_sea_energy(double f, double f_p, double alpha) {
    if (!(f > 0)) {
        return 0.0;
    }
    const double ratio = f_p / f;
    return alpha * square(kGravity) / (square(square(kTurn)) * square(square(f)) * f)
           * std::exp(-1.25 * square(square(ratio)));
}

double wind_sea_spread_power(double f_over_peak) {
    return 9.77 * std::pow(f_over_peak, f_over_peak < 1 ? 4.06 : -2.34);
}

double hasselmann_spread_power(double f_over_peak, double wind_over_waves) {
    if (f_over_peak <= 1) {
        return 6.97 * std::pow(f_over_peak, 4.06);
    }
    return 9.77 * std::pow(f_over_peak, -2.33 - 1.45 * (wind_over_waves - 1.17));
}

double donelan_banner_beta(double f_over_peak) {
    const double x = std::max(f_over_peak, 0.56);  // no measurements below
    if (x < 0.95) {
        return 2.61 * std::pow(x, 1.3);
    }
    if (x < 1.6) {
        return 2.28 * std::pow(x, -1.3);
    }
    return std::pow(10.0, -0.4 + 0.8393 * std::exp(-0.567 * std::log(square(x))));
}

double swell_power(double f_over_peak, double swell) {
    return 16.0 * std::tanh(1.0 / f_over_peak) * square(swell);
}

double cosine_power_integral(double p) {
    // With logarithms, since the gamma functions overflow for p >= 85.
    return 0.5 * kTurn
           * std::exp(
               (1.0 - 2.0 * p) * std::log(2.0) + log_gamma(2.0 * p + 1.0)
               - 2.0 * log_gamma(p + 1.0));
}

double jonswap_energy(double omega, double omega_p, double alpha, double gamma) {
    const double shape = wind_sea_energy(omega / kTurn, omega_p / kTurn, alpha) / kTurn;
    const double width = omega <= omega_p ? 0.07 : 0.09;
    const double from_peak = (omega - omega_p) / (width * omega_p);
    return shape * std::pow(gamma, std::exp(-0.5 * square(from_peak)));
}

double depth_factor(double omega, double depth) {
    // k^-3 dk / d omega relative to deep water.
    const double k = wave_number(omega, depth);
    if (!(k > 0)) {
        return 0.0;
    }
    const double deep = square(omega) / kGravity;
    return std::min(deep * deep * omega / (2.0 * k * k * k * group_speed(k, depth)), 1.0);
}

double phillips_energy(double k, double wind) {
    if (!(k > 0)) {
        return 0.0;
    }
    const double length = square(wind) / kGravity;
    return 0.5 * kPhillipsConstant / (k * k * k) * std::exp(-1.0 / square(k * length));
}

OceanEnergy make_ocean_energy(const Ocean& ocean) {
    OceanEnergy sea;
    sea.spectrum = ocean.spectrum;
    sea.spreading = ocean.spreading;
    sea.wind = ocean.wind_speed;
    sea.wind_direction = ocean.wind_direction;
    sea.depth = ocean.depth;
    sea.gamma = ocean.gamma;
    sea.swell = ocean.swell;
    if (!(sea.wind > 0)) {
        return sea;
    }
    switch (sea.spectrum) {
    case OceanSpectrum::WindSea:
        sea.peak = kTurn * 0.13 * kGravity / sea.wind;
        break;
    case OceanSpectrum::Phillips: {
        const double k_p = std::sqrt(2.0 / 3.0) * kGravity / square(sea.wind);
        sea.peak = wave_frequency(k_p, sea.depth);
        break;
    }
    case OceanSpectrum::Jonswap:
    case OceanSpectrum::Tma: {
        const double fetch = ocean.fetch;
        sea.peak = 22.0 * std::cbrt(square(kGravity) / (sea.wind * fetch));
        sea.alpha = 0.076 * std::pow(square(sea.wind) / (fetch * kGravity), 0.22);
        break;
    }
    }
    if (!has_closed_form(sea.spreading)) {
        sea.spread_scale.resize(kSpectrumSamples);
        for (int i = 0; i < kSpectrumSamples; ++i) {
            sea.spread_scale[i] = 1.0 / integrate_shape(sea, std::exp(log_of_sample(i)));
        }
    }
    return sea;
}

double frequency_energy(const OceanEnergy& sea, double omega) {
    if (!(sea.wind > 0) || !(omega > 0)) {
        return 0.0;
    }
    switch (sea.spectrum) {
    case OceanSpectrum::WindSea:
        return wind_sea_energy(omega / kTurn, sea.peak / kTurn) / kTurn;
    case OceanSpectrum::Phillips: {
        const double k = wave_number(omega, sea.depth);
        return phillips_energy(k, sea.wind) / group_speed(k, sea.depth);
    }
    case OceanSpectrum::Jonswap:
        return jonswap_energy(omega, sea.peak, sea.alpha, sea.gamma);
    case OceanSpectrum::Tma:
        break;
    }
    return jonswap_energy(omega, sea.peak, sea.alpha, sea.gamma) * depth_factor(omega, sea.depth);
}

double directional_density(const OceanEnergy& sea, double omega, double theta) {
    theta = std::remainder(theta, kTurn);
    const double x = omega / sea.peak;
    if (!has_closed_form(sea.spreading)) {
        return spread_scale(sea, x) * unnormalized_shape(sea, x, theta);
    }
    const double own = sea.spreading == OceanSpreading::WindSea
                           ? wind_sea_spread_power(x)
                           : hasselmann_spread_power(x, sea.wind * sea.peak / kGravity);
    const double p = own + swell_power(x, sea.swell);
    return std::pow(std::abs(std::cos(0.5 * theta)), 2.0 * p) / cosine_power_integral(p);
}

double wave_energy(const OceanEnergy& sea, double kx, double kz) {
    const double k = std::hypot(kx, kz);
    const double omega = wave_frequency(k, sea.depth);
    const double over_all = frequency_energy(sea, omega);
    if (!(over_all > 0)) {
        return 0.0;
    }
    const double theta = std::atan2(kz, kx) - sea.wind_direction;
    return over_all * directional_density(sea, omega, theta) * group_speed(k, sea.depth) / k;
}

}  // namespace limn
