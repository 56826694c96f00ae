#include "render/environment/atmosphere.h"

#include "ecs/base/air.h"
#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

using glm::dvec3;

constexpr double kThickness = kAirRadius - kGroundRadius;
constexpr double kViewer = kGroundRadius + 0.002;
constexpr double kPiD = 3.14159265358979323846;
constexpr double kMieAsymmetry = 0.8;
constexpr float kHorizonBlend = 60;  // distant ground takes the color of the sky above it
const double kHorizonDistance =
    std::sqrt(kAirRadius * kAirRadius - kGroundRadius * kGroundRadius);  // to the end of the air

double rayleigh_phase(double cosine) {
    return 3 / (16 * kPiD) * (1 + cosine * cosine);
}

/// Cornette and Shanks 1992.
double mie_phase(double cosine) {
    constexpr double g = kMieAsymmetry;
    return 3 / (8 * kPiD) * (1 - g * g) * (1 + cosine * cosine)
           / ((2 + g * g) * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// Bilinear, of `width` columns; x and y in 0 .. 1 from the first to the last value.
template <typename T>
T lookup(const std::vector<T>& table, int width, int height, double x, double y) {
    const double column = std::clamp(x, 0.0, 1.0) * (width - 1);
    const double row = std::clamp(y, 0.0, 1.0) * (height - 1);
    const int i = std::min(static_cast<int>(column), width - 2);
    const int j = std::min(static_cast<int>(row), height - 2);
    const T* const at = &table[static_cast<std::size_t>(j) * width + i];
    using Weight = typename T::value_type;
    const auto u = static_cast<Weight>(column - i);
    const auto v = static_cast<Weight>(row - j);
    return glm::mix(glm::mix(at[0], at[1], u), glm::mix(at[width], at[width + 1], u), v);
}

/// Bruneton 2017: by the distance to the end of the air, which resolves the horizon.
dvec3 transmittance(const AirTables& air, double radius, double sine) {
    const double root = std::sqrt(std::max(radius * radius - kGroundRadius * kGroundRadius, 0.0));
    if (sine < -root / radius) {
        return dvec3(0);  // the Earth is in the way
    }
    const double nearest = kAirRadius - radius;
    const double distance = distance_to_shell(radius, sine, kAirRadius);
    return lookup(
        air.transmittance, AirTables::kSines, AirTables::kHeights,
        (distance - nearest) / (root + kHorizonDistance - nearest), root / kHorizonDistance);
}

void fill_transmittance(AirTables& air) {
    air.transmittance.resize(static_cast<std::size_t>(AirTables::kHeights) * AirTables::kSines);
    parallel_for(AirTables::kHeights, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            const double root =
                kHorizonDistance * static_cast<double>(j) / (AirTables::kHeights - 1);
            const double radius = std::sqrt(root * root + kGroundRadius * kGroundRadius);
            const double nearest = kAirRadius - radius;
            for (int i = 0; i < AirTables::kSines; ++i) {
                const double d =
                    nearest + (root + kHorizonDistance - nearest) * i / (AirTables::kSines - 1);
                const double sine =
                    d > 0 ? (kHorizonDistance * kHorizonDistance - root * root - d * d)
                                / (2 * radius * d)
                          : 1;
                air.transmittance[j * AirTables::kSines + i] = air_transmittance(
                    radius, std::clamp(sine, -root / radius, 1.0), air.settings.haze);
            }
        }
    });
}

/// What a march along a ray gathers.
struct Gathered {
    dvec3 radiance = dvec3(0);
    dvec3 fraction = dvec3(0);  ///< of even light that the ray's air scatters once more
    dvec3 through = dvec3(1);   ///< transmittance
};

/// Marches from `radius` along `direction` to the end of the air or the ground. `source`(sample,
/// distance from the center, sine of the sun's elevation) = light scattered toward the ray per km.
template <typename Source>
Gathered march(
    double haze, double radius, const dvec3& direction, const dvec3& sun, int steps,
    const Source& source) {
    const double sine = direction.y;
    const double ground =
        sine < 0 && radius * std::sqrt(1 - sine * sine) < kGroundRadius
            ? -radius * sine
                  - std::sqrt(square(radius * sine) - square(radius) + square(kGroundRadius))
            : -1;
    const double length = ground >= 0 ? ground : distance_to_shell(radius, sine, kAirRadius);
    Gathered sum;
    double begin = 0;
    for (int i = 1; i <= steps; ++i) {  // steps grow with the distance
        const double end = length * square(static_cast<double>(i) / steps);
        const dvec3 at = dvec3(0, radius, 0) + 0.5 * (begin + end) * direction;
        const double center = glm::length(at);
        const AirSample sample = sample_air(center - kGroundRadius, haze);
        const dvec3 passes = glm::exp(-sample.extinction * (end - begin));
        const dvec3 weight = sum.through * (1.0 - passes) / sample.extinction;  // its integral
        sum.radiance += weight * source(sample, center, glm::dot(at, sun) / center);
        sum.fraction += weight * (sample.rayleigh + sample.mie);
        sum.through *= passes;
        begin = end;
    }
    return sum;
}

void fill_scattered(AirTables& air) {
    constexpr int kSize = AirTables::kScattered;
    constexpr int kDirections = 64;
    constexpr int kSteps = 24;
    const dvec3 albedo = air.settings.ground;
    air.scattered.resize(static_cast<std::size_t>(kSize) * kSize);
    parallel_for(kSize, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            const double radius =
                kGroundRadius + 0.002
                + (kThickness - 0.01) * square(static_cast<double>(j) / (kSize - 1));
            for (int i = 0; i < kSize; ++i) {
                const double sun_sine = 2.0 * i / (kSize - 1) - 1;
                const dvec3 sun = {std::sqrt(1 - sun_sine * sun_sine), sun_sine, 0};
                dvec3 second(0);
                dvec3 fraction(0);
                for (int k = 0; k < kDirections; ++k) {  // a spiral of equal areas
                    const double y = 1 - (2.0 * k + 1) / kDirections;
                    const double phi = 2.399963229728653 * k;
                    const double across = std::sqrt(1 - y * y);
                    const dvec3 direction = {across * std::cos(phi), y, across * std::sin(phi)};
                    const Gathered along = march(
                        air.settings.haze, radius, direction, sun, kSteps,
                        [&](const AirSample& sample, double center, double sine) {
                            return (sample.rayleigh + sample.mie) / (4 * kPiD)
                                   * transmittance(air, center, sine);
                        });
                    second += along.radiance;
                    fraction += along.fraction;
                    if (y < 0 && radius * across < kGroundRadius) {
                        // The ground's normal is nearly the vertical here.
                        second += along.through * albedo / kPiD * std::max(sun_sine, 0.0)
                                  * transmittance(air, kGroundRadius, sun_sine);
                    }
                }
                second /= static_cast<double>(kDirections);
                fraction /= static_cast<double>(kDirections);
                air.scattered[j * kSize + i] = second / (1.0 - fraction);
            }
        }
    });
}

dvec3 scattered(const AirTables& air, double radius, double sun_sine) {
    const double height = std::clamp((radius - kGroundRadius) / kThickness, 0.0, 1.0);
    return lookup(
        air.scattered, AirTables::kScattered, AirTables::kScattered, 0.5 * sun_sine + 0.5,
        std::sqrt(height));
}

}  // namespace

AirTables make_air_tables(const AirSettings& settings) {
    AirTables air;
    air.settings = settings;
    fill_transmittance(air);
    fill_scattered(air);
    return air;
}

SkyView make_sky_view(const AirTables& air, const Vec3& sun) {
    constexpr int kSteps = 48;
    SkyView view;
    view.sun = sun;
    view.radiance.resize(static_cast<std::size_t>(SkyView::kWidth) * SkyView::kHeight);
    const dvec3 toward_sun = {std::sqrt(std::max(1.0 - square(double(sun.y)), 0.0)), sun.y, 0};
    parallel_for(SkyView::kHeight, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            const double sine = square(static_cast<double>(j) / (SkyView::kHeight - 1));
            const double across = std::sqrt(1 - sine * sine);
            for (int i = 0; i < SkyView::kWidth; ++i) {
                const double half_sine = static_cast<double>(i) / (SkyView::kWidth - 1);
                const double cosine = 1 - 2 * half_sine * half_sine;
                const dvec3 direction = {
                    across * cosine, sine, across * std::sqrt(std::max(1 - cosine * cosine, 0.0))};
                const double to_sun = glm::dot(direction, toward_sun);
                const double rayleigh = rayleigh_phase(to_sun);
                const double mie = mie_phase(to_sun);
                const dvec3 radiance =
                    march(
                        air.settings.haze, kViewer, direction, toward_sun, kSteps,
                        [&](const AirSample& sample, double center, double sun_sine) {
                            return (sample.rayleigh * rayleigh + sample.mie * mie)
                                       * transmittance(air, center, sun_sine)
                                   + (sample.rayleigh + sample.mie)
                                         * scattered(air, center, sun_sine);
                        })
                        .radiance;
                view.radiance[j * SkyView::kWidth + i] = Vec4(Vec3(radiance), 0);
            }
        }
    });
    // The ground reflects what the sky and the sun send, summed over equal steps of sin^2.
    constexpr int kRings = 32;
    constexpr int kSectors = 64;
    dvec3 sum(0);
    for (int j = 0; j < kRings; ++j) {
        const double y = std::sqrt(1 - (j + 0.5) / kRings);
        for (int i = 0; i < kSectors; ++i) {
            const double half_sine = std::sin(kPiD * (i + 0.5) / kSectors / 2);
            sum += dvec3(Vec3(
                lookup(view.radiance, SkyView::kWidth, SkyView::kHeight, half_sine, std::sqrt(y))));
        }
    }
    const dvec3 sky = sum * (kPiD / (kRings * kSectors));
    const dvec3 direct =
        std::max(double(sun.y), 0.0)
        * air_transmittance(kGroundRadius, std::max(double(sun.y), 0.0), air.settings.haze);
    view.ground = Vec3(dvec3(air.settings.ground) * (sky + direct) / kPiD);
    return view;
}

Vec3 sky_radiance(const SkyView& view, const Vec3& direction) {
    const Vec2 to_sun = {view.sun.x, view.sun.z};
    const Vec2 across = {direction.x, direction.z};
    const float cosine =
        glm::dot(to_sun, across)
        / std::sqrt(std::max(glm::dot(to_sun, to_sun) * glm::dot(across, across), 1e-12f));
    const Vec3 above = Vec3(lookup(
        view.radiance, SkyView::kWidth, SkyView::kHeight,
        std::sqrt(std::max(0.5f - 0.5f * cosine, 0.0f)), std::sqrt(std::max(direction.y, 0.0f))));
    return glm::mix(view.ground, above, std::exp2(kHorizonBlend * std::min(direction.y, 0.0f)));
}

}  // namespace limn
