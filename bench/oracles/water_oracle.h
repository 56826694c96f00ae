#pragma once

#include "ecs/components/ocean.h"

#include <cmath>
#include <complex>
#include <span>
#include <vector>

namespace limn::oracle {

// Open water in double precision by explicit Fourier sums. Header-only, so that tests of systems
// can use it without the renderer.

using Complex = std::complex<double>;

inline constexpr double kFullTurn = 6.283185307179586;

/// to[x] = sum over n of from[n] e^(2 pi i n x / size), term by term.
[[nodiscard]] inline std::vector<Complex> inverse_dft(std::span<const Complex> from) {
    const std::size_t size = from.size();
    std::vector<Complex> to(size);
    for (std::size_t x = 0; x < size; ++x) {
        for (std::size_t n = 0; n < size; ++n) {
            const double turns = static_cast<double>(n * x % size) / static_cast<double>(size);
            to[x] += from[n] * std::polar(1.0, kFullTurn * turns);
        }
    }
    return to;
}

/// Along both axes: spectrum(n, m) at n * size + m becomes field(x, z) at z * size + x.
[[nodiscard]] inline std::vector<Complex>
inverse_dft_2d(std::span<const Complex> spectrum, std::size_t size) {
    std::vector<Complex> half(size * size);  // (z, n) at z * size + n
    for (std::size_t n = 0; n < size; ++n) {
        const std::vector<Complex> line = inverse_dft(spectrum.subspan(n * size, size));
        for (std::size_t z = 0; z < size; ++z) {
            half[z * size + n] = line[z];
        }
    }
    std::vector<Complex> field;
    for (std::size_t z = 0; z < size; ++z) {
        const std::vector<Complex> line =
            inverse_dft(std::span<const Complex>(half).subspan(z * size, size));
        field.insert(field.end(), line.begin(), line.end());
    }
    return field;
}

/// The fields of OceanCascade at one point.
struct OceanPoint {
    double height = 0;
    double shift_x = 0;
    double shift_z = 0;
    double slope_x = 0;
    double slope_z = 0;
    double shift_xx = 0;
    double shift_zz = 0;
    double shift_xz = 0;
};

/// The sum of a cascade's waves 2 |h0| cos(k.q - omega t + arg h0), each of which runs along its k
/// and displaces the water toward its crests. Waves in the opposite direction are ignored.
[[nodiscard]] inline OceanPoint
ocean_at(const OceanCascade& cascade, double choppiness, double x, double z, double time) {
    OceanPoint sum;
    const int size = cascade.size;
    for (int n = 0; n < size; ++n) {
        for (int m = 0; m < size; ++m) {
            const int at = n * size + m;
            const Complex h0(cascade.ahead_re[at], cascade.ahead_im[at]);
            if (h0 == 0.0) {
                continue;
            }
            const double step = kFullTurn / static_cast<double>(cascade.patch);
            const double kx = step * (n < size / 2 ? n : n - size);
            const double kz = step * (m < size / 2 ? m : m - size);
            const double k = std::hypot(kx, kz);
            const double omega = cascade.frequency[at];
            const double phase = kx * x + kz * z - omega * time + std::arg(h0);
            const double up = 2.0 * std::abs(h0) * std::cos(phase);
            const double ahead = -2.0 * std::abs(h0) * std::sin(phase);
            sum.height += up;
            sum.slope_x += kx * ahead;
            sum.slope_z += kz * ahead;
            sum.shift_x += choppiness * kx / k * ahead;
            sum.shift_z += choppiness * kz / k * ahead;
            sum.shift_xx -= choppiness * kx * kx / k * up;
            sum.shift_zz -= choppiness * kz * kz / k * up;
            sum.shift_xz -= choppiness * kx * kz / k * up;
        }
    }
    return sum;
}

/// The fields of OceanPoint on the cascade's grid, each a plane in OceanCascade's layout: separate
/// Fourier sums of only the forward waves.
struct OceanPlanes {
    std::vector<double> height;
    std::vector<double> shift_x;
    std::vector<double> shift_z;
    std::vector<double> slope_x;
    std::vector<double> slope_z;
    std::vector<double> shift_xx;
    std::vector<double> shift_zz;
    std::vector<double> shift_xz;
};

[[nodiscard]] inline OceanPlanes
ocean_planes(const OceanCascade& cascade, double choppiness, double time) {
    const int size = cascade.size;
    const double step = kFullTurn / static_cast<double>(cascade.patch);
    std::vector<Complex> h(cascade.ahead_re.size());
    for (int n = 0; n < size; ++n) {
        for (int m = 0; m < size; ++m) {
            const int at = n * size + m;
            const int mirrored = (size - n) % size * size + (size - m) % size;
            const double turn = -static_cast<double>(cascade.frequency[at]) * time;
            const Complex wave =
                Complex(cascade.ahead_re[at], cascade.ahead_im[at]) * std::polar(1.0, turn);
            h[at] += wave;
            h[mirrored] += std::conj(wave);
        }
    }
    const auto plane = [&](auto&& factor) {
        std::vector<Complex> spectrum(h.size());
        for (int at = 0; at < size * size; ++at) {
            const int n = at / size;
            const int m = at % size;
            const double kx = step * (n < size / 2 ? n : n - size);
            const double kz = step * (m < size / 2 ? m : m - size);
            const double k = std::hypot(kx, kz);
            spectrum[at] = k > 0 ? h[at] * factor(kx, kz, k) : Complex(0);
        }
        std::vector<double> field;
        for (const Complex& value : inverse_dft_2d(spectrum, static_cast<std::size_t>(size))) {
            field.push_back(value.real());
        }
        return field;
    };
    const Complex i(0, 1);
    const double c = choppiness;
    return {
        plane([](double, double, double) { return Complex(1); }),
        plane([=](double kx, double, double k) { return i * c * kx / k; }),
        plane([=](double, double kz, double k) { return i * c * kz / k; }),
        plane([=](double kx, double, double) { return i * kx; }),
        plane([=](double, double kz, double) { return i * kz; }),
        plane([=](double kx, double, double k) { return Complex(-c * kx * kx / k); }),
        plane([=](double, double kz, double k) { return Complex(-c * kz * kz / k); }),
        plane([=](double kx, double kz, double k) { return Complex(-c * kx * kz / k); })};
}

}  // namespace limn::oracle
