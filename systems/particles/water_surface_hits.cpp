#include "systems/particles/water_surface_hits.h"

#include <algorithm>
#include <cmath>

// Techniques: particle.collision-loop

namespace limn {
namespace {

constexpr float kContactTolerance = 5e-4f;  // of the height at which a search ends [m]
constexpr int kSearchSteps = 12;            // at most; three are enough in mild waves
constexpr float kDentSpeed = 10.0f;         // of a hit that leaves a dent of depth `ripple` [m/s]
constexpr float kMaxDent = 4.0f;            // in units of `ripple`

float largest(std::span<const float> heights) {
    const auto highest = std::max_element(heights.begin(), heights.end());
    return highest != heights.end() ? std::max(*highest, 0.0f) : 0.0f;
}

/// Height above the water, and the water there.
struct Above {
    float height = 0;
    WaterPoint water{};
};
Above look_down(const WaterSurface& surface, const Vec3& at) {
    Above above;
    above.water = sample_water(surface, {at.x, at.z});
    above.height = at.y - above.water.position.y;
    return above;
}

/// The contact where the height above the water is 0: regula falsi, every third step bisection.
std::optional<WaterContact>
enter_one(const WaterSurface& surface, const Vec3& from, const Vec3& to) {
    const Above end = look_down(surface, to);
    if (!end.water.is_water || !(end.height < 0)) {
        return std::nullopt;
    }
    const Above start = look_down(surface, from);
    if (!start.water.is_water || start.height < 0) {
        return std::nullopt;
    }
    float dry = 0;
    float wet = 1;
    float height_dry = start.height;
    float height_wet = end.height;
    WaterContact contact{.fraction = 1, .point = end.water.position, .normal = end.water.normal};
    for (int step = 0; step < kSearchSteps; ++step) {
        const float split = step % 3 == 2 ? 0.5f : height_dry / (height_dry - height_wet);
        contact.fraction = dry + (wet - dry) * split;
        const Vec3 at = from + contact.fraction * (to - from);
        const Above here = look_down(surface, at);
        if (!here.water.is_water) {
            return std::nullopt;
        }
        contact.point = {at.x, here.water.position.y, at.z};
        contact.normal = here.water.normal;
        if (std::abs(here.height) < kContactTolerance) {
            break;
        }
        (here.height < 0 ? wet : dry) = contact.fraction;
        (here.height < 0 ? height_wet : height_dry) = here.height;
    }
    return contact;
}

}  // namespace

float highest_wave(const WaterSurface& surface) {
    float highest = 0;
    if (surface.ocean != nullptr) {
        for (const OceanCascade& cascade : surface.ocean->cascades) {
            highest += largest(cascade.height);
        }
    }
    if (surface.waves != nullptr) {
        for (const WaveLine& wave : surface.waves->lines) {
            highest += std::abs(wave.amplitude);
        }
        for (const WaveRing& ring : surface.waves->rings) {
            highest += std::abs(ring.amplitude);
        }
    }
    if (surface.ripples != nullptr) {
        highest += largest(surface.ripples->height);
    }
    return highest;
}

std::optional<WaterContact>
enter_water(std::span<const ParticleWater> waters, const Vec3& from, const Vec3& to) {
    std::optional<WaterContact> first;
    for (std::size_t i = 0; i < waters.size(); ++i) {
        if (!(to.y < waters[i].highest)) {
            continue;
        }
        std::optional<WaterContact> contact = enter_one(waters[i].surface, from, to);
        if (contact && (!first || contact->fraction < first->fraction)) {
            first = contact;
            first->water = static_cast<std::uint32_t>(i);
        }
    }
    return first;
}

RippleImpulse
make_ripple_impulse(const ParticleWater& water, const Vec3& point, const Vec3& velocity) {
    const Vec3 local = water.surface.frame.local(point);
    const float speed = std::clamp(-velocity.y / kDentSpeed, 0.0f, kMaxDent);
    return {
        .center = {local.x, local.z},
        .radius = water.ripple_radius,
        .height = -water.ripple * speed};
}

}  // namespace limn
