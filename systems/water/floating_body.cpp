#include "systems/water/floating_body.h"

#include "ecs/base/rotation.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr auto kWeight = static_cast<float>(kGravity);  ///< [m/s^2]
constexpr float kCalm = 1.5f;        ///< depth at which wave motion has decayed to 1/e [m]; by eye
constexpr float kMaxSlope = 1.0f;    ///< limit of the water's slope that acts on a body
constexpr float kPhaseStep = 0.25f;  ///< largest phase of a bobbing oscillation per substep [rad]
constexpr int kMaxBodySubsteps = 8;
constexpr float kSpinDrag =
    0.375f;  ///< rotational drag of a cube, relative to its coefficient along an axis
constexpr float kFriction = 0.5f;  ///< coefficient on the bottom and along walls
constexpr float kRolling = 2.0f;   ///< decay rate of spin in contact [1/s]; by eye
constexpr int kContactPasses = 6;
constexpr float kTouching = 1e-3f;    ///< contact distance [m]
constexpr float kMaxSpeed = 200.0f;   ///< [m/s]
constexpr float kMaxSpin = 60.0f;     ///< [rad/s]
constexpr float kMinHeight = -1e4f;   ///< bodies below are no longer simulated [m]
constexpr float kSplashSpeed = 0.3f;  ///< smallest impact speed that splashes [m/s]

/// Dimensions and mass of a body, including its scale.
struct Hull {
    TouchShape shape = TouchShape::Ball;
    Vec3 half = {0, 0, 0};  ///< half extents; three times the radius of a ball [m]
    Vec3 center = {
        0, 0, 0};  ///< center of the shape relative to the center of mass, local axes [m]
    Vec3 origin = {0, 0, 0};   ///< the entity's origin, likewise
    Vec3 face = {0, 0, 0};     ///< cross section perpendicular to each axis [m^2]
    float volume = 0;          ///< [m^3]
    float mass = 0;            ///< [kg]
    Vec3 inertia = {0, 0, 0};  ///< about local axes [kg m^2]
    float radius = 0;          ///< of a ball of equal volume [m]
};

/// max(x, 0); 0 for NaN.
float positive(float x) {
    return x > 0 ? x : 0.0f;
}

Vec3 limit_length(const Vec3& v, float limit) {
    const float length = glm::length(v);
    return length > limit ? v * (limit / length) : v;
}

Hull make_hull(const WaterTouch& touch, const Floating& floating, const Vec3& scale) {
    Hull hull;
    hull.shape = touch.shape;
    hull.half = glm::abs(touch.half * scale);
    if (touch.shape == TouchShape::Ball) {
        // Same volume as the scaled ellipsoid.
        hull.half = Vec3(std::abs(touch.half.x) * std::cbrt(std::abs(scale.x * scale.y * scale.z)));
        hull.volume = 4.0f / 3.0f * kPi * hull.half.x * hull.half.x * hull.half.x;
        hull.face = Vec3(kPi * hull.half.x * hull.half.x);
    } else {
        hull.volume = 8 * hull.half.x * hull.half.y * hull.half.z;
        hull.face =
            4.0f
            * Vec3(hull.half.y * hull.half.z, hull.half.z * hull.half.x, hull.half.x * hull.half.y);
    }
    const Vec3 h2 = hull.half * hull.half;
    hull.mass = std::clamp(floating.density, 1.0f, 1e5f) * hull.volume;
    hull.inertia =
        hull.mass
        * (touch.shape == TouchShape::Ball ? 0.4f * h2
                                           : Vec3(h2.y + h2.z, h2.z + h2.x, h2.x + h2.y) / 3.0f);
    hull.center = -floating.center_of_mass * scale;
    hull.origin = hull.center - touch.offset * scale;
    hull.radius = std::cbrt(hull.volume * 0.75f / kPi);
    return hull;
}

/// Position and orientation of a hull.
struct BodyPose {
    Vec3 center = {0, 0, 0};  ///< center of mass [m]
    Quat rotation = {1, 0, 0, 0};

    [[nodiscard]] Vec3 world(const Vec3& own) const { return center + rotation * own; }
};

/// Plane approximation of the surface near a part of the hull.
struct LocalWater {
    bool is_water = false;
    Vec2 at = {0, 0};
    float height = 0;
    Vec2 slope = {0, 0};
    Vec3 velocity = {0, 0, 0};

    [[nodiscard]] float height_at(const Vec3& point) const {
        return height + slope.x * (point.x - at.x) + slope.y * (point.z - at.y);
    }
};

LocalWater make_local(const WaterPoint& point) {
    LocalWater local;
    local.is_water = point.is_water;
    local.at = {point.position.x, point.position.z};
    local.height = point.position.y;
    local.slope = point.slope();
    const float steepness = glm::length(local.slope);
    local.slope *= steepness > kMaxSlope ? kMaxSlope / steepness : 1.0f;
    local.velocity = point.velocity;
    return local;
}

constexpr std::size_t kSections = 4;  ///< largest number for a long hull
constexpr std::size_t kColumns = 9 * kSections;
constexpr std::array<float, 3> kGauss = {-0.7745966692f, 0, 0.7745966692f};
constexpr std::array<float, 3> kGaussShare = {5.0f / 18, 8.0f / 18, 5.0f / 18};

/// The hull cut into columns along its most upright axis; a ball is not cut.
struct BodyColumns {
    std::size_t count = 0;
    int axis = 1;
    std::array<Vec3, kColumns> center{};  ///< in local axes, relative to the center of mass [m]
    std::array<float, kColumns> area{};   ///< [m^2]
    std::array<LocalWater, kColumns> water{};
    float gap = 0;  ///< distance between columns [m]
};

BodyColumns cut_columns(const Hull& hull, const Quat& rotation) {
    BodyColumns columns;
    if (hull.shape == TouchShape::Ball) {
        columns.count = 1;
        columns.center[0] = hull.center;
        columns.gap = hull.half.x;
        return columns;
    }
    const Vec3 up = glm::abs(glm::conjugate(rotation) * Vec3(0, 1, 0));
    columns.axis = up.y >= up.x && up.y >= up.z ? 1 : up.x >= up.z ? 0 : 2;
    int along = (columns.axis + 1) % 3;
    int across = (columns.axis + 2) % 3;
    if (hull.half[along] < hull.half[across]) {
        std::swap(along, across);
    }
    const float slender = std::round(hull.half[along] / hull.half[across]);
    const float sections = std::clamp(slender, 1.0f, static_cast<float>(kSections));
    const float half_section = hull.half[along] / sections;  // half length of a section
    columns.count = 9 * static_cast<std::size_t>(sections);
    columns.gap = std::max(2 * half_section, 2 * hull.half[across]) / 3;
    for (std::size_t i = 0; i < columns.count; ++i) {
        Vec3 center = hull.center;
        const auto section = static_cast<float>(i / 9);
        center[along] += (2 * section + 1 - sections + kGauss[i % 3]) * half_section;
        center[across] += kGauss[i / 3 % 3] * hull.half[across];
        columns.center[i] = center;
        columns.area[i] =
            hull.face[columns.axis] / sections * kGaussShare[i % 3] * kGaussShare[i / 3 % 3];
    }
    return columns;
}

/// Plane fitted to four points around a ball, placed so that it has the mean height of a quadratic
/// surface.
LocalWater sample_about_ball(const WaterSurface& surface, const Vec3& center, float radius) {
    const float offset = radius * 0.70710678f;
    const Vec2 at = {center.x, center.z};
    const std::array<WaterPoint, 4> around = {
        sample_water(surface, at + Vec2(offset, 0)), sample_water(surface, at - Vec2(offset, 0)),
        sample_water(surface, at + Vec2(0, offset)), sample_water(surface, at - Vec2(0, offset))};
    WaterPoint mean = sample_water(surface, at);
    if (!std::all_of(
            around.begin(), around.end(), [](const WaterPoint& point) { return point.is_water; })) {
        return make_local(mean);
    }
    LocalWater local = make_local(mean);
    local.at = at;
    local.height = 0;
    local.velocity = {0, 0, 0};
    for (const WaterPoint& point : around) {
        local.height += 0.25f * point.position.y;
        local.velocity += 0.25f * point.velocity;
    }
    const Vec2 slope = Vec2(
                           around[0].position.y - around[1].position.y,
                           around[2].position.y - around[3].position.y)
                       / (2 * offset);
    const float steepness = glm::length(slope);
    local.slope = steepness > kMaxSlope ? slope * (kMaxSlope / steepness) : slope;
    return local;
}

void sample_columns(
    const Hull& hull, const BodyPose& pose, const WaterSurface& water, BodyColumns& columns) {
    WaterSurface surface = water;
    surface.min_wavelength = 2 * columns.gap;  // shorter waves average out
    for (std::size_t i = 0; i < columns.count; ++i) {
        const Vec3 at = pose.world(columns.center[i]);
        columns.water[i] = hull.shape == TouchShape::Ball
                               ? sample_about_ball(surface, at, hull.half.x)
                               : make_local(sample_water(surface, {at.x, at.z}));
    }
}

/// Buoyancy of a hull.
struct Lift {
    float volume = 0;                 ///< submerged [m^3]
    Vec3 moment = {0, 0, 0};          ///< of that volume, about the center of mass [m^4]
    Vec3 force = {0, 0, 0};           ///< [N]
    Vec3 torque = {0, 0, 0};          ///< about the center of mass [N m]
    Vec3 water_velocity = {0, 0, 0};  ///< mean velocity of the surrounding water [m/s]
};

/// Adds a submerged part with `volume`, centered at `arm` from the center of mass and `over` below
/// the surface.
void add_part(const LocalWater& water, float volume, const Vec3& arm, float over, Lift& lift) {
    const float calm = std::exp(-std::max(over, 0.0f) / kCalm);
    const Vec3 up = {-water.slope.x * calm, 1, -water.slope.y * calm};
    const Vec3 force = kWaterDensity * kWeight * volume * up;
    lift.volume += volume;
    lift.moment += volume * arm;
    lift.force += force;
    lift.torque += glm::cross(arm, force);
    lift.water_velocity += volume * calm * water.velocity;
}

void lift_ball(const Hull& hull, const BodyPose& pose, const LocalWater& water, Lift& lift) {
    const float r = hull.half.x;
    const Vec3 arm = pose.rotation * hull.center;
    const Vec3 center = pose.center + arm;
    const Vec3 normal = glm::normalize(Vec3(-water.slope.x, 1, -water.slope.y));
    const float depth = (water.height_at(center) - center.y) * normal.y;
    const float height = std::clamp(r + depth, 0.0f, 2 * r);  // of the submerged cap
    const float volume = kPi / 3 * height * height * (3 * r - height);
    const float below = 0.75f * square(2 * r - height) / (3 * r - height);
    if (volume > 0) {
        add_part(water, volume, arm - below * normal, depth - r, lift);
    }
}

Lift lift_hull(const Hull& hull, const BodyPose& pose, const BodyColumns& columns) {
    Lift lift;
    if (hull.shape == TouchShape::Ball) {
        if (columns.water[0].is_water) {
            lift_ball(hull, pose, columns.water[0], lift);
        }
    } else {
        Vec3 axis(0);
        axis[columns.axis] = 1;
        axis = pose.rotation * axis;
        axis = axis.y < 0 ? -axis : axis;
        const float half = hull.half[columns.axis];
        for (std::size_t i = 0; i < columns.count; ++i) {
            const LocalWater& water = columns.water[i];
            if (!water.is_water) {
                continue;
            }
            const Vec3 arm = pose.rotation * columns.center[i];
            const Vec3 center = pose.center + arm;
            // The point at s along the column is at depth - s * rise below the surface.
            const float depth = water.height_at(center) - center.y;
            const float rise =
                std::max(axis.y - water.slope.x * axis.x - water.slope.y * axis.z, 0.1f);
            const float top = std::clamp(depth / rise, -half, half);
            if (top > -half) {
                const float volume = (top + half) * columns.area[i];
                add_part(
                    water, volume, arm + 0.5f * (top - half) * axis, depth - half * rise, lift);
            }
        }
    }
    if (lift.volume > 0) {
        lift.water_velocity /= lift.volume;
    }
    return lift;
}

/// Velocities of a hull, with its inertia in this step.
struct Motion {
    Vec3 velocity = {0, 0, 0};
    Vec3 spin = {0, 0, 0};
    float mass = 0;
    Vec3 inertia = {0, 0, 0};

    /// Inverse inertia tensor times v, in world space.
    [[nodiscard]] Vec3 turned(const Quat& rotation, const Vec3& v) const {
        return rotation * ((glm::conjugate(rotation) * v) / inertia);
    }
    [[nodiscard]] Vec3 angular_momentum(const Quat& rotation) const {
        return rotation * ((glm::conjugate(rotation) * spin) * inertia);
    }
    void push(const Quat& rotation, const Vec3& arm, const Vec3& impulse) {
        velocity += impulse / mass;
        spin += turned(rotation, glm::cross(arm, impulse));
    }
    /// Change of speed along `direction` at the point `arm` per unit impulse along it.
    [[nodiscard]] float
    mobility(const Quat& rotation, const Vec3& arm, const Vec3& direction) const {
        const Vec3 spun = turned(rotation, glm::cross(arm, direction));
        return 1 / mass + glm::dot(direction, glm::cross(spun, arm));
    }
};

/// Adds `gained` to the velocity and applies linear and quadratic drag of the water along local
/// axes. Quadratic drag is linearized at the previous velocity, so that the terminal velocity is
/// exact.
void resist(
    const Hull& hull, const Floating& floating, const Quat& rotation, const Lift& lift,
    const Vec3& gained, float step, Motion& motion) {
    const float submerged = lift.volume / hull.volume;
    const float damping = positive(floating.damping) * kWaterDensity * lift.volume / hull.mass;
    const Vec3 drag = {
        positive(floating.drag.x), positive(floating.drag.y), positive(floating.drag.z)};
    const Quat to_own = glm::conjugate(rotation);
    const Vec3 before = to_own * (motion.velocity - lift.water_velocity);
    Vec3 against = before + to_own * gained;
    const float speed = glm::length(before);
    for (int i = 0; i < 3; ++i) {
        const float quadratic =
            0.5f * kWaterDensity * submerged * drag[i] * hull.face[i] * speed / motion.mass;
        against[i] /= 1 + step * (damping + quadratic);
    }
    motion.velocity = lift.water_velocity + rotation * against;
    const float mean_drag = (drag.x + drag.y + drag.z) / 3;
    const float quadratic =
        kSpinDrag * mean_drag * kWaterDensity * lift.volume / hull.mass * glm::length(motion.spin);
    motion.spin /= 1 + step * (2 * damping + quadratic);
}

/// A half space: points satisfy normal.p >= offset.
struct BodyWall {
    Vec3 normal = {0, 1, 0};
    float offset = 0;
};

/// The bottom and the edges that confine the hull.
struct Walls {
    std::size_t count = 0;
    std::array<BodyWall, 5> list{};
    void add(const Vec3& normal, const Vec3& point) {
        list[count++] = {normal, glm::dot(normal, point)};
    }
};

Walls walls_of(const WaterSurface& surface, bool stays) {
    Walls walls;
    if (surface.water.depth > 0) {
        walls.add({0, 1, 0}, {0, water_bottom(surface), 0});
    }
    const Vec2 half = 0.5f * surface.water.size;
    for (const float side : {-1.0f, 1.0f}) {
        if (stays && half.x > 0) {
            walls.add(
                surface.frame.direction_to_world({-side, 0, 0}),
                surface.frame.world({side * half.x, 0, 0}));
        }
        if (stays && half.y > 0) {
            walls.add(
                surface.frame.direction_to_world({0, 0, -side}),
                surface.frame.world({0, 0, side * half.y}));
        }
    }
    return walls;
}

/// The hull's corners, or the point of a ball nearest to the wall, relative to the center of mass
/// in world space.
std::size_t
corners_of(const Hull& hull, const Quat& rotation, const Vec3& normal, std::array<Vec3, 8>& arms) {
    if (hull.shape == TouchShape::Ball) {
        arms[0] = rotation * hull.center - hull.half.x * normal;
        return 1;
    }
    for (int i = 0; i < 8; ++i) {
        const Vec3 sign = {(i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1};
        arms[static_cast<std::size_t>(i)] = rotation * (hull.center + sign * hull.half);
    }
    return 8;
}

/// A corner in contact and its accumulated impulses.
struct Contact {
    Vec3 arm = {0, 0, 0};
    float stop = 0;             ///< impulse along the normal [N s]
    Vec3 friction = {0, 0, 0};  ///< along the wall [N s]
};

/// Resolves contacts with a wall, with friction, and removes penetration. Sequential impulses over
/// several passes; accumulated impulses are clamped, so that excess can be taken back.
void resolve_contacts(
    const Hull& hull, const BodyWall& wall, float step, BodyPose& pose, Motion& motion) {
    std::array<Vec3, 8> arms;
    const std::size_t corners = corners_of(hull, pose.rotation, wall.normal, arms);
    const float height = glm::dot(wall.normal, pose.center) - wall.offset;
    std::array<Contact, 8> contacts;
    std::size_t count = 0;
    float deepest = 0;
    for (std::size_t i = 0; i < corners; ++i) {
        const float inside = -height - glm::dot(wall.normal, arms[i]);
        deepest = std::max(deepest, inside);
        if (inside > -kTouching) {
            contacts[count++].arm = arms[i];
        }
    }
    if (count == 0) {
        return;
    }
    for (int pass = 0; pass < kContactPasses; ++pass) {
        for (std::size_t i = 0; i < count; ++i) {
            Contact& contact = contacts[i];
            Vec3 velocity = motion.velocity + glm::cross(motion.spin, contact.arm);
            const float wanted = -glm::dot(velocity, wall.normal)
                                 / motion.mobility(pose.rotation, contact.arm, wall.normal);
            const float stop = std::max(contact.stop + wanted, 0.0f);
            motion.push(pose.rotation, contact.arm, (stop - contact.stop) * wall.normal);
            contact.stop = stop;

            velocity = motion.velocity + glm::cross(motion.spin, contact.arm);
            const Vec3 along = velocity - glm::dot(velocity, wall.normal) * wall.normal;
            const Vec3 direction = normalize_or(along, wall.normal);
            const float hold =
                glm::length(along) / motion.mobility(pose.rotation, contact.arm, direction);
            const Vec3 friction =
                limit_length(contact.friction - hold * direction, kFriction * contact.stop);
            motion.push(pose.rotation, contact.arm, friction - contact.friction);
            contact.friction = friction;
        }
    }
    motion.spin /= 1 + step * kRolling;
    pose.center += std::max(deepest - 0.5f * kTouching, 0.0f) * wall.normal;
}

/// The body of water above or below the hull with the nearest surface.
struct Nearest {
    std::size_t index = 0;
    bool found = false;
    WaterPoint point{};
};

Nearest nearest_water(std::span<const WaterSurface> surfaces, const Vec3& center, float radius) {
    Nearest nearest;
    float distance = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (center.y + radius < water_bottom(surfaces[i])) {
            continue;
        }
        const WaterPoint point = sample_water(surfaces[i], {center.x, center.z});
        const float away = std::abs(point.position.y - center.y);
        if (point.is_water && (!nearest.found || away < distance)) {
            nearest = {i, true, point};
            distance = away;
        }
    }
    return nearest;
}

struct Substeps {
    int count = 1;
    float heavier = 1;  ///< factor on mass and inertia for stability
};

/// Enough substeps to resolve bobbing: omega^2 = rho g A / m.
Substeps substeps_of(const Hull& hull, float step) {
    const float face = std::max({hull.face.x, hull.face.y, hull.face.z});
    const float omega = std::sqrt(kWaterDensity * kWeight * face / hull.mass);
    const float wanted = std::ceil(omega * step / kPhaseStep);
    Substeps substeps;
    substeps.count =
        static_cast<int>(std::clamp(wanted, 1.0f, static_cast<float>(kMaxBodySubsteps)));
    const float phase = omega * step / static_cast<float>(substeps.count);
    substeps.heavier = std::max(1.0f, square(phase / (2 * kPhaseStep)));
    return substeps;
}

}  // namespace

Displaced
displaced_water(const WaterTouch& touch, const Transform& transform, const WaterSurface& surface) {
    const Hull hull = make_hull(touch, {}, transform.scale);
    const BodyPose pose = {
        transform.position - transform.rotation * hull.origin, transform.rotation};
    BodyColumns columns = cut_columns(hull, pose.rotation);
    sample_columns(hull, pose, surface, columns);
    const Lift lift = lift_hull(hull, pose, columns);
    return {
        lift.volume, lift.volume > 0 ? pose.center + lift.moment / lift.volume : pose.center,
        hull.volume};
}

BodyMass body_mass(const WaterTouch& touch, const Floating& floating, const Vec3& scale) {
    const Hull hull = make_hull(touch, floating, scale);
    return {hull.mass, hull.inertia, -hull.origin, hull.half};
}

RippleImpulse splash_of(float mass, float radius, float speed) {
    RippleImpulse impulse;
    impulse.radius = 1.5f * radius;
    const float area = kPi * square(impulse.radius);
    const float depth = mass * speed / (kWaterDensity * area * std::sqrt(kWeight * impulse.radius));
    impulse.height = -std::min(depth, 0.5f * impulse.radius);
    return impulse;
}

std::optional<Splash> step_floating_body(
    std::span<const WaterSurface> surfaces, const WaterTouch& touch, const Floating& floating,
    float step, FloatingState& state, Transform& transform) {
    const Hull hull = make_hull(touch, floating, transform.scale);
    const Quat rotation = normalize_or_identity(transform.rotation);
    BodyPose pose = {transform.position - rotation * hull.origin, rotation};
    if (!(hull.volume > 1e-12f && hull.volume < 1e12f) || !is_finite(pose.center) || !(step > 0)
        || !std::isfinite(hull.mass) || transform.position.y < kMinHeight) {
        return std::nullopt;
    }
    Motion motion;
    motion.velocity = is_finite(state.velocity) ? state.velocity : Vec3(0);
    motion.spin = is_finite(state.spin) ? state.spin : Vec3(0);

    const Vec3 center = pose.world(hull.center);
    const float radius = glm::length(hull.half);
    const Nearest nearest = nearest_water(surfaces, center, radius);
    BodyColumns columns = cut_columns(hull, pose.rotation);
    const float fall = step * glm::length(motion.velocity);
    if (nearest.found && center.y - nearest.point.position.y < 2 * radius + fall) {
        sample_columns(hull, pose, surfaces[nearest.index], columns);
    }
    const bool was_in = state.submerged > 0;
    const float closing = glm::dot(nearest.point.velocity - motion.velocity, nearest.point.normal);
    const Substeps substeps = substeps_of(hull, step);
    const float dt = step / static_cast<float>(substeps.count);
    motion.mass = hull.mass * substeps.heavier;
    motion.inertia = hull.inertia * substeps.heavier;
    bool dipped = false;
    for (int i = 0; i < substeps.count; ++i) {
        const Lift lift = lift_hull(hull, pose, columns);
        dipped = dipped || lift.volume > 0;
        state.submerged = std::min(lift.volume / hull.volume, 1.0f);
        const bool falls = state.submerged == 0;  // light bodies must not fall more slowly
        const float weight = hull.mass * kWeight * (falls ? substeps.heavier : 1.0f);
        const Vec3 gained = dt / motion.mass * (lift.force - Vec3(0, weight, 0));
        motion.spin =
            motion.turned(pose.rotation, motion.angular_momentum(pose.rotation) + dt * lift.torque);
        resist(hull, floating, pose.rotation, lift, gained, dt, motion);
        motion.velocity = limit_length(motion.velocity, kMaxSpeed);
        motion.spin = limit_length(motion.spin, kMaxSpin);

        pose.center += dt * motion.velocity;
        const Vec3 angular_momentum = motion.angular_momentum(pose.rotation);
        pose.rotation = glm::normalize(exp_rotation(0.5f * dt * motion.spin) * pose.rotation);
        motion.spin = motion.turned(pose.rotation, angular_momentum);
        if (state.submerged > 0) {
            const Walls walls = walls_of(surfaces[nearest.index], floating.confined);
            for (std::size_t wall = 0; wall < walls.count; ++wall) {
                resolve_contacts(hull, walls.list[wall], dt, pose, motion);
            }
        }
    }
    state.velocity = motion.velocity;
    state.spin = motion.spin;
    transform.rotation = pose.rotation;
    transform.position = pose.world(hull.origin);

    if (!dipped || was_in || closing < kSplashSpeed || !(floating.splash > 0)) {
        return std::nullopt;
    }
    Splash splash;
    splash.surface = nearest.index;
    splash.impulse = splash_of(hull.mass, hull.radius, closing);
    splash.impulse.center = nearest.point.rest;
    splash.impulse.height *= floating.splash;
    return splash;
}

}  // namespace limn
