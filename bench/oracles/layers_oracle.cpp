#include "bench/oracles/layers_oracle.h"

#include "ecs/base/math.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace limn::oracle {
namespace {

double fifth_power(double cosine) {
    return std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

double largest(const glm::dvec3& color) {
    return std::max({color.x, color.y, color.z});
}

/// Smith's Lambda of an ellipsoid with these half axes.
double smith_lambda(const glm::dvec3& v, const glm::dvec2& alphas) {
    const double slope2 = (square(alphas.x * v.x) + square(alphas.y * v.y)) / square(v.z);
    return 0.5 * (std::sqrt(1 + slope2) - 1);
}

/// Estevez and Kulla 2017, table 1, between their fits for alpha = 0 and 1.
double sheen_lambda(double cosine, double alpha) {
    constexpr std::array<double, 5> kSmooth = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    constexpr std::array<double, 5> kRough = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
    std::array<double, 5> p{};
    for (std::size_t i = 0; i < p.size(); ++i) {
        p[i] = kRough[i] + square(1 - alpha) * (kSmooth[i] - kRough[i]);
    }
    const auto fit = [&p](double x) {
        return p[0] / (1 + p[1] * std::pow(x, p[2])) + p[3] * x + p[4];
    };
    return std::exp(cosine < 0.5 ? fit(cosine) : 2 * fit(0.5) - fit(1 - cosine));
}

glm::dvec2 alphas_of(const LayeredMaterial& m) {
    const double alpha = square(std::max(m.roughness, 0.045));
    return {alpha + (1 - alpha) * square(m.anisotropy), alpha};
}

/// Reflectance at normal incidence at the boundary of two media.
double boundary(double a, double b) {
    return square((a - b) / (a + b));
}

/// How much of a modulation of the spectrum by cos(2 pi path / wavelength + shift) the eye sees, as
/// XYZ: the Fourier transform of four Gaussians that fit the color matching functions.
glm::dvec3 seen_modulation(double path, double shift) {
    struct Gaussian {
        int channel;
        double height, center, variance;
    };
    constexpr std::array<Gaussian, 4> kGaussians = {{
        {0, 5.4856e-13, 1.6810e6, 4.3278e9},
        {0, 9.7470e-14, 2.2399e6, 4.5282e9},
        {1, 4.4201e-13, 1.7953e6, 9.3046e9},
        {2, 5.2481e-13, 2.2084e6, 6.6121e9},
    }};
    const double phase = 2 * std::numbers::pi * path * 1e-9;
    glm::dvec3 xyz(0);
    for (const Gaussian& g : kGaussians) {
        xyz[g.channel] += g.height * std::sqrt(2 * std::numbers::pi * g.variance)
                          * std::cos(g.center * phase + shift)
                          * std::exp(-g.variance * square(phase));
    }
    return xyz / 1.0685e-7;
}

}  // namespace

double
stretched_lobe(const glm::dvec3& to_light, const glm::dvec3& to_camera, const glm::dvec2& alphas) {
    if (to_light.z <= 0) {
        return 0;
    }
    const glm::dvec3 h = glm::normalize(to_light + to_camera);
    const double ellipsoid = square(h.x / alphas.x) + square(h.y / alphas.y) + square(h.z);
    const double distribution = 1 / (std::numbers::pi * alphas.x * alphas.y * square(ellipsoid));
    const double masked =
        1 / (1 + smith_lambda(to_camera, alphas) + smith_lambda(to_light, alphas));
    return distribution * masked / (4 * to_camera.z);
}

double sheen_lobe(double n_l, double n_v, double n_h, double alpha) {
    if (n_l <= 0) {
        return 0;
    }
    const double sine = std::sqrt(std::max(1 - square(n_h), 1e-7));
    const double distribution =
        (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * std::numbers::pi);
    const double visibility =
        1
        / ((1 + sheen_lambda(n_v, alpha) + sheen_lambda(std::max(n_l, 1e-4), alpha)) * 4 * n_v
           * n_l);
    return n_l * distribution * std::min(visibility, 1.0);
}

double sheen_albedo(double n_v, double roughness, int steps) {
    const double alpha = square(std::max(roughness, 0.07));
    const double sine_v = std::sqrt(1 - n_v * n_v);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double theta = 0.5 * std::numbers::pi * (i + 0.5) / steps;
        const double n_l = std::cos(theta);
        for (int j = 0; j < steps; ++j) {
            const double phi = std::numbers::pi * (j + 0.5) / steps;
            const double l_v = n_l * n_v + std::sin(theta) * sine_v * std::cos(phi);
            const double n_h = (n_l + n_v) / std::sqrt(2 + 2 * l_v);
            sum += std::sin(theta) * sheen_lobe(n_l, n_v, std::min(n_h, 1.0), alpha);
        }
    }
    return sum * std::numbers::pi * std::numbers::pi / (double(steps) * steps);
}

glm::dvec3 thin_film(double cosine, double film_index, double thickness, const glm::dvec3& base) {
    const double t = std::clamp(thickness / 0.03, 0.0, 1.0);
    const double index = 1 + (film_index - 1) * t * t * (3 - 2 * t);
    const double sine_inside = std::sqrt(1 - square(cosine)) / index;
    const double inside = std::sqrt(1 - square(sine_inside));
    const double r12 = boundary(index, 1) + (1 - boundary(index, 1)) * fifth_power(cosine);
    const double path = 2 * index * thickness * inside;
    const glm::dmat3 to_rec709 = {
        {3.2404542, -0.9692660, 0.0556434},
        {-1.5371385, 1.8760108, -0.2040259},
        {-0.4985314, 0.0415560, 1.0572252}};
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) {
        const double root = std::sqrt(std::clamp(base[c], 0.0, 0.9999));
        const double base_index = (1 + root) / (1 - root);
        const double f0 = boundary(base_index, index);
        const double r23 = f0 + (1 - f0) * fifth_power(inside);
        // Half a wave is lost at each reflection by a denser medium: from inside the film at its
        // top always, seen from below, and at its bottom if the base is thinner.
        const double shift = std::numbers::pi + (base_index < index ? std::numbers::pi : 0.0);
        const double round_trip = std::clamp(r12 * r23, 1e-5, 0.9999);
        const double mean = square(1 - r12) * r23 / (1 - round_trip);
        color[c] = r12 + mean;
        double amplitude = mean - (1 - r12);
        for (int order = 1; order <= 2; ++order) {
            amplitude *= std::sqrt(round_trip);
            color[c] +=
                2 * amplitude * (to_rec709 * seen_modulation(order * path, order * shift))[c];
        }
    }
    return glm::clamp(color, 0.0, 1.0);
}

LayerAlbedos layer_albedos(const LayeredMaterial& m, double n_v, int samples) {
    const glm::dvec2 alphas = alphas_of(m);
    const double roughness = m.anisotropy > 0 ? std::pow(alphas.x * alphas.y, 0.25) : m.roughness;
    LayerAlbedos albedos;
    albedos.base = directional_albedo(n_v, roughness, samples);
    albedos.sheen = m.sheen == glm::dvec3(0) ? 0 : sheen_albedo(n_v, m.sheen_roughness, 128);
    return albedos;
}

glm::dvec3 reflect_layers(
    const LayeredMaterial& m, const LayerAlbedos& albedos, double sheen_light,
    const glm::dvec3& normal, const glm::dvec3& coat_normal, const glm::dvec3& to_camera,
    const glm::dvec3& to_light) {
    const glm::dvec3 h = glm::normalize(to_light + to_camera);
    const double n_l = std::max(glm::dot(normal, to_light), 0.0);
    const double n_v = std::max(glm::dot(normal, to_camera), 1e-3);
    const double p = fifth_power(glm::dot(to_camera, h));

    const glm::dvec3 across = glm::cross(normal, m.along);
    const auto local = [&](const glm::dvec3& v) {
        return glm::dvec3(glm::dot(v, m.along), glm::dot(v, across), glm::dot(v, normal));
    };
    const double lobe = stretched_lobe(local(to_light), local(to_camera), alphas_of(m));
    const double lost = 1 / (albedos.base.scale + albedos.base.bias) - 1;
    const auto compensated = [&](const glm::dvec3& f0, const glm::dvec3& value) {
        return (1.0 + f0 * lost) * value;
    };

    /// Light of a base with this Fresnel term, and its reflectance under uniform light.
    struct Part {
        glm::dvec3 light, albedo;
    };
    const auto schlick = [&](const glm::dvec3& f0, double f90) {
        return Part{
            compensated(f0, f0 * (1 - p) + f90 * p) * lobe,
            compensated(f0, f0 * albedos.base.scale + f90 * albedos.base.bias)};
    };
    const auto filmed = [&](const Part& plain, const glm::dvec3& f0) {
        if (m.iridescence <= 0 || m.film_thickness <= 0) {
            return plain;
        }
        const glm::dvec3 f = thin_film(n_v, m.film_index, m.film_thickness, f0);
        const glm::dvec3 all(albedos.base.scale + albedos.base.bias);
        return Part{
            glm::mix(plain.light, compensated(f, f) * lobe, m.iridescence),
            glm::mix(plain.albedo, compensated(f, f) * all, m.iridescence)};
    };
    const glm::dvec3 f0 = glm::min(boundary(m.index, 1) * m.specular_tint, glm::dvec3(1));
    const Part gloss = filmed(schlick(m.specular_weight * f0, m.specular_weight), f0);
    const Part metal = filmed(schlick(m.albedo, 1), m.albedo);
    const glm::dvec3 diffuse =
        m.albedo * (std::max(1 - largest(gloss.albedo), 0.0) * n_l / std::numbers::pi);
    glm::dvec3 color = glm::mix(gloss.light + diffuse, metal.light, m.metalness);

    // Smooth sheen would reflect more than all light at grazing angles.
    const double sheen_share = std::max(albedos.sheen, sheen_light);
    const double below = 1 - largest(m.sheen) * std::min(sheen_share, 1.0);
    const double sheen_alpha = square(std::max(m.sheen_roughness, 0.07));
    color = color * below
            + m.sheen * sheen_lobe(n_l, n_v, glm::dot(normal, h), sheen_alpha)
                  / std::max(sheen_share, 1.0);

    const double coat_n_v = std::max(glm::dot(coat_normal, to_camera), 1e-3);
    const double covered = m.coat * (0.04 + 0.96 * fifth_power(coat_n_v));
    const double coat_light = ggx_lobe(
        glm::dot(coat_normal, to_light), coat_n_v, glm::dot(coat_normal, h),
        square(std::max(m.coat_roughness, 0.045)));
    return glm::mix(color, glm::dvec3(coat_light), covered);
}

glm::dvec3 layers_furnace(const LayeredMaterial& material, double n_v, int steps) {
    const LayerAlbedos albedos = layer_albedos(material, n_v, 1 << 13);
    const glm::dvec3 normal(0, 0, 1);
    const glm::dvec3 to_camera(std::sqrt(1 - n_v * n_v), 0, n_v);
    glm::dvec3 sum(0);
    const double step = 0.5 * std::numbers::pi / steps;
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) * step;
        const double sheen_light =
            material.sheen == glm::dvec3(0)
                ? 0
                : sheen_albedo(std::cos(theta), material.sheen_roughness, 48);
        for (int j = 0; j < 2 * steps; ++j) {
            const double phi = (j + 0.5) * std::numbers::pi / steps;
            const glm::dvec3 to_light(
                std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            sum += std::sin(theta)
                   * reflect_layers(
                       material, albedos, sheen_light, normal, normal, to_camera, to_light);
        }
    }
    return sum * (step * std::numbers::pi / steps);
}

}  // namespace limn::oracle
