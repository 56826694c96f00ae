#include "systems/particles/birth_attributes.h"

#include "systems/particles/birth_constants.h"
#include "systems/particles/emitter_pose.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

// Techniques: engine.particle-params, particle.generation-shape

namespace limn {
namespace {

constexpr float kMinKept = 0.37f;  // fraction of the velocity, down to which drag is undone [1/e]

/// Unit, uniform by area.
Vec3 sample_direction(Random& random) {
    const float y = random.uniform(-1.0f, 1.0f);
    const TurnPoint at = turn_point(random.uniform());
    const float radius = std::sqrt(std::max(1.0f - y * y, 0.0f));
    return {radius * at.cosine, y, radius * at.sine};
}

/// In the unit disc, uniform by area.
Vec2 sample_disc(Random& random) {
    const float radius = std::sqrt(random.uniform());
    const TurnPoint at = turn_point(random.uniform());
    return {radius * at.cosine, radius * at.sine};
}

/// Each component between -1 and 1.
Vec3 random_vector(Random& random) {
    const float x = random.uniform(-1.0f, 1.0f);
    const float y = random.uniform(-1.0f, 1.0f);
    return {x, y, random.uniform(-1.0f, 1.0f)};
}

}  // namespace

TurnPoint turn_point(float fraction) {
    const float turned = 4.0f * fraction;
    const float quarters = std::floor(turned + 0.5f);
    const float x = (turned - quarters) * births::kQuarterTurn;
    const float x2 = x * x;
    const float* const s = births::kSine;
    const float* const c = births::kCosine;
    const float sine = x + x * x2 * (s[0] + x2 * (s[1] + x2 * s[2]));
    const float cosine = 1.0f - 0.5f * x2 + x2 * x2 * (c[0] + x2 * (c[1] + x2 * c[2]));
    switch (static_cast<int>(quarters) & 3) {
    case 0:
        return {cosine, sine};
    case 1:
        return {-sine, cosine};
    case 2:
        return {-cosine, -sine};
    default:
        return {sine, -cosine};
    }
}

float cube_root(float x) {
    const auto bits = static_cast<float>(std::bit_cast<std::int32_t>(x));
    float y = std::bit_cast<float>(
        static_cast<std::int32_t>(bits * births::kThird) + births::kCubeRootBits);
    for (int i = 0; i < 2; ++i) {
        const float y3 = y * y * y;
        y = y * ((y3 + (x + x)) / ((y3 + y3) + x));
    }
    return y;
}

float exp_of_fraction(float x) {
    const float r = 0.5f * x;
    float sum = births::kExp[0];
    for (int i = 1; i < births::kExpTerms; ++i) {
        sum = births::kExp[i] + r * sum;
    }
    const float root = 1.0f + r * (1.0f + r * sum);
    return root * root;
}

Vec3 sample_shape(EmitterShape shape, const Vec3& size, Random& random) {
    switch (shape) {
    case EmitterShape::Point:
        break;
    case EmitterShape::Ball: {
        const float radius = cube_root(random.uniform());
        return size * (sample_direction(random) * radius);
    }
    case EmitterShape::Sphere: {
        const Vec3 direction = sample_direction(random);
        if (size.x != 0 && size.y != 0 && size.z != 0) {
            return size * direction;
        }
        const Vec3 used = {
            size.x != 0 ? direction.x : 0, size.y != 0 ? direction.y : 0,
            size.z != 0 ? direction.z : 0};
        return size * normalize_or(used, Vec3(0));
    }
    case EmitterShape::Disc: {
        const Vec2 p = sample_disc(random);
        return size * Vec3(p.x, 0, p.y);
    }
    case EmitterShape::Circle: {
        const TurnPoint at = turn_point(random.uniform());
        return size * Vec3(at.cosine, 0, at.sine);
    }
    case EmitterShape::Box:
        return size * random_vector(random);
    case EmitterShape::Torus: {
        const Vec2 tube = size.y * sample_disc(random);
        const TurnPoint at = turn_point(random.uniform());
        return {(size.x + tube.x) * at.cosine, tube.y, (size.z + tube.x) * at.sine};
    }
    }
    return Vec3(0);
}

float lowest_of_cone(float cone) {
    return std::cos(std::clamp(finite_or(cone, 0), 0.0f, kPi));
}

float cone_of(const ParticleEmitter& emitter) {
    return emitter.direction == EmitterDirection::Radial ? kPi : emitter.cone;
}

Vec3 sample_cone(float cone, Random& random) {
    const float lowest = lowest_of_cone(cone);
    const float y = 1.0f - random.uniform() * (1.0f - lowest);
    const TurnPoint at = turn_point(random.uniform());
    const float radius = std::sqrt(std::max(1.0f - y * y, 0.0f));
    return {radius * at.cosine, y, radius * at.sine};
}

float spread(float mean, float width, Random& random) {
    return mean + width * random.uniform(-1.0f, 1.0f);
}

BirthAttributes
draw_attributes(const ParticleEmitter& emitter, const Affine& world, Random& random) {
    BirthAttributes born{};
    born.local = sample_shape(emitter.shape, emitter.size, random);
    const bool is_radial = emitter.direction == EmitterDirection::Radial && born.local != Vec3(0);
    const Vec3 direction =
        is_radial ? glm::normalize(born.local) : sample_cone(cone_of(emitter), random);
    const Vec3 aim = normalize_or(transform_vector(world, direction), Vec3(0, 1, 0));
    born.velocity = aim * spread(emitter.speed, emitter.speed_spread, random);
    born.life = spread(emitter.life, emitter.life_spread, random);
    born.look = random.word();
    // Drawn last, so that emitters without spreads get the same numbers as before there were any.
    if (emitter.size_spread != Vec3(0)) {
        born.local += emitter.size_spread * random_vector(random);
    }
    if (emitter.velocity_spread != Vec3(0)) {
        born.velocity += transform_vector(world, emitter.velocity_spread * random_vector(random));
    }
    return born;
}

Rewind::Rewind(const ParticleStep& its_step)
    : step(its_step), drag(-std::log(std::clamp(its_step.keep, kMinKept, 1.0f))) {}

void Rewind::apply(float at, Vec3& position, Vec3& velocity) const {
    const Vec3 now = velocity;
    const float time = at * step.dt;
    velocity = step.air + (now - step.air) * exp_of_fraction(at * drag) - step.gravity * time;
    position -= (velocity * step.old_weight + now * (1 - step.old_weight)) * time;
}

bool Newborn::is_finite() const {
    return std::isfinite(position.x + position.y + position.z + life);
}

Newborn draw_birth(const BirthDraw& draw, float at, std::uint64_t number) {
    Random random = attributes_random(draw.seed, draw.subject, number);
    const Affine world = draw.moves ? interpolate_pose(draw.pose, at) : draw.pose.now;
    const BirthAttributes attributes = draw_attributes(*draw.emitter, world, random);
    Newborn born = {
        transform_point(world, attributes.local), attributes.velocity + draw.added,
        -(at * draw.rewind.step.dt), attributes.life, attributes.look};
    draw.rewind.apply(at, born.position, born.velocity);
    return born;
}

}  // namespace limn
