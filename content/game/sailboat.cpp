#include "content/game/sailboat.h"

#include "ecs/base/rotation.h"
#include "systems/water/floating_body.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kAirDensity = 1.2f;  // [kg/m^3]
constexpr float kLiftSlope = 3.6f;   // factor on sin a cos a: a wing of aspect ratio 3
constexpr float kAspect = 3.0f;      // aspect ratio for induced drag
constexpr float kSkinDrag = 0.02f;   // drag coefficient of a foil along the flow
constexpr float kPlateDrag = 1.2f;   // of one perpendicular to the flow
constexpr float kPlateLift = 1.0f;   // lift coefficient at 45 degrees
constexpr float kStallBegins = radians(17.0f);
constexpr float kStallEnds = radians(30.0f);
constexpr float kMaxRudder = radians(35.0f);
constexpr float kBoomRate = 2.5f;           // largest angular speed of a boom [rad/s]; by eye
constexpr float kBest = radians(17.0f);     // angle of attack to which sails are trimmed
constexpr float kSailSheetRate = 0.5f;      // of automatic trimming [1/s]
constexpr float kFoilSpan = 0.4f;           // depth at which a foil is fully submerged [m]; by eye
constexpr float kNoGo = radians(48.0f);     // half angle of the no-go zone to windward
constexpr float kLayLine = radians(30.0f);  // angle beyond which the boat tacks
constexpr float kSteer = 2.2f;              // rudder per course error [1/rad]
constexpr float kSteady = 1.6f;             // rudder per turn rate [s/rad]
constexpr float kSailLookAhead = 3.0f;      // [boat lengths]
constexpr float kCourseStep = 0.5f;         // [m]
constexpr int kMaxCourseSteps = 64;

float positive(float x) {
    return x > 0 ? x : 0.0f;
}

float wrap(float angle) {
    return std::remainder(angle, 2 * kPi);
}

/// A rigid body that accumulates impulses.
struct Rigid {
    Vec3 velocity{};
    Vec3 spin{};
    Quat rotation{1, 0, 0, 0};
    BodyMass mass{};

    [[nodiscard]] Vec3 turned(const Vec3& v) const {
        return rotation * ((glm::conjugate(rotation) * v) / mass.inertia);
    }
    [[nodiscard]] Vec3 velocity_at(const Vec3& arm) const {
        return velocity + glm::cross(spin, arm);
    }
    void push(const Vec3& arm, const Vec3& impulse) {
        velocity += impulse / mass.mass;
        spin += turned(glm::cross(arm, impulse));
    }
    /// Change of speed along `direction` at the point `arm` per unit impulse along `direction`.
    [[nodiscard]] float mobility(const Vec3& arm, const Vec3& direction) const {
        return 1 / mass.mass
               + glm::dot(direction, glm::cross(turned(glm::cross(arm, direction)), arm));
    }
};

/// A plate that rotates about the boat's upright axis: its trailing edge points astern at `angle`
/// 0, to port if positive.
struct Foil {
    Vec3 arm{};  ///< from the center of mass, world space [m]
    float area = 0;
    float angle = 0;
    float density = 0;  ///< of the fluid [kg/m^3]
};

void push_foil(const Foil& foil, const Vec3& flow, float step, Rigid& body) {
    const Vec3 past = glm::conjugate(body.rotation) * (flow - body.velocity_at(foil.arm));
    const Vec2 across = {past.x, past.z};
    const float speed = glm::length(across);
    if (!(speed > 1e-4f) || !(foil.area > 0)) {
        return;
    }
    const Vec2 d = across / speed;
    const Vec2 chord = {std::sin(foil.angle), -std::cos(foil.angle)};  // toward the trailing edge
    const Vec2 normal = {std::cos(foil.angle), std::sin(foil.angle)};
    const float attack = std::atan2(glm::dot(d, normal), glm::dot(d, chord));
    const FoilForce force = foil_force(attack);
    const Vec2 l = std::cos(attack) * normal - std::sin(attack) * chord;
    const Vec2 total = force.lift * l + force.drag * d;
    const float size = glm::length(total);
    if (!(size > 1e-6f)) {
        return;
    }
    float impulse = 0.5f * foil.density * speed * speed * foil.area * size * step;
    for (const Vec2& axis : {normal, chord}) {
        const float fraction = std::abs(glm::dot(total, axis)) / size;
        const float flows = std::abs(glm::dot(across, axis));
        const float gives = body.mobility(foil.arm, body.rotation * Vec3(axis.x, 0, axis.y));
        impulse = fraction > 1e-3f ? std::min(impulse, flows / (fraction * gives)) : impulse;
    }
    body.push(foil.arm, body.rotation * (impulse / size * Vec3(total.x, 0, total.y)));
}

/// Submerged fraction of a foil at a position, 0 .. 1, and the water velocity there.
struct Wet {
    float fraction = 0;
    Vec3 flow{};
};

Wet wet_at(std::span<const WaterSurface> surfaces, const Vec3& position) {
    const auto around = find_water(surfaces, position);
    if (!around) {
        return {};
    }
    return {std::min(around->depth / kFoilSpan, 1.0f), around->surface.velocity};
}

/// Wave-making resistance, along the keel.
void resist_waves(float hull_speed, float submerged, float step, const Vec3& flow, Rigid& body) {
    const Vec3 ahead = body.rotation * Vec3(0, 0, 1);
    const float speed = glm::dot(body.velocity - flow, ahead);
    const float pace = std::abs(speed);
    if (!(pace > 1e-4f) || !(hull_speed > 0)) {
        return;
    }
    const float froude2 = std::min(square(pace / hull_speed), 1e6f);
    const float loss = step * submerged * static_cast<float>(kGravity) * square(froude2) / pace;
    body.velocity -= ahead * (speed * loss / (1 + loss));
}

}  // namespace

FoilForce foil_force(float angle) {
    const float s = std::sin(angle);
    const float c = std::cos(angle);
    const float wing_lift = kLiftSlope * s * c;
    const float wing_drag = kSkinDrag + wing_lift * wing_lift / (kPi * kAspect);
    const float plate_lift = 2 * kPlateLift * s * c;
    const float plate_drag = kSkinDrag + kPlateDrag * s * s;
    // Flow from behind always stalls: a sharp trailing edge is a poor leading edge.
    const float off = std::abs(c > 0 ? std::asin(std::clamp(s, -1.0f, 1.0f)) : 0.5f * kPi);
    const float t = std::clamp((off - kStallBegins) / (kStallEnds - kStallBegins), 0.0f, 1.0f);
    const float stalled = t * t * (3 - 2 * t);
    return {glm::mix(wing_lift, plate_lift, stalled), glm::mix(wing_drag, plate_drag, stalled)};
}

float heading_of(const Quat& rotation) {
    const Vec3 ahead = rotation * Vec3(0, 0, 1);
    return std::atan2(ahead.z, ahead.x);
}

float apparent_wind_angle(
    const Sailboat& boat, const Floating& floating, const FloatingState& motion,
    const Quat& rotation, const Vec3& scale, const Vec3& wind) {
    const Vec3 arm = rotation * ((boat.sail_center - floating.center_of_mass) * scale);
    const Vec3 past =
        glm::conjugate(rotation) * (wind - motion.velocity - glm::cross(motion.spin, arm));
    return past.x == 0 && past.z == 0 ? 0.0f : std::atan2(past.x, -past.z);
}

void step_sailboat(
    std::span<const WaterSurface> surfaces, const Vec3& wind, const WaterTouch& touch,
    const Floating& floating, const Transform& transform, const Sailboat& boat, float step,
    SailboatState& state, FloatingState& motion) {
    Rigid body;
    body.mass = body_mass(touch, floating, transform.scale);
    body.rotation = normalize_or_identity(transform.rotation);
    body.velocity = motion.velocity;
    body.spin = motion.spin;
    const Vec3 inertia = body.mass.inertia;
    if (!is_finite(transform.position) || !is_finite(body.velocity) || !is_finite(body.spin)
        || !(body.mass.mass > 1e-6f) || !std::isfinite(body.mass.mass)
        || !(std::min({inertia.x, inertia.y, inertia.z}) > 1e-9f) || !(step > 0)) {
        return;
    }
    const Vec3 air = is_finite(wind) ? wind : Vec3(0);
    state.rudder = std::isfinite(state.rudder) ? std::clamp(state.rudder, -1.0f, 1.0f) : 0.0f;
    state.sheet = std::isfinite(state.sheet) ? std::clamp(state.sheet, 0.0f, 1.0f) : 0.0f;
    state.boom = std::isfinite(state.boom) ? wrap(state.boom) : 0.0f;
    const auto arm_of = [&](const Vec3& own) {
        return body.rotation * (own * transform.scale - body.mass.center);
    };
    const Vec3 center = transform.position + body.rotation * body.mass.center;

    const float limit = glm::mix(kMinBoomAngle, kMaxBoomAngle, state.sheet);
    const float blows =
        apparent_wind_angle(boat, floating, motion, body.rotation, transform.scale, air);
    const float swing = std::clamp(blows, -limit, limit) - state.boom;
    state.boom += std::clamp(swing, -kBoomRate * step, kBoomRate * step);

    const Vec3 sail = arm_of(boat.sail_center);
    const Vec3 keel = arm_of(boat.keel_center);
    const Vec3 rudder = arm_of(boat.rudder_center);
    const Wet wet_sail = wet_at(surfaces, center + sail);
    const Wet wet_keel = wet_at(surfaces, center + keel);
    const Wet wet_rudder = wet_at(surfaces, center + rudder);
    const float sail_area = positive(boat.sail_area) * (1 - wet_sail.fraction);
    push_foil({sail, sail_area, state.boom, kAirDensity}, air, step, body);
    push_foil(
        {keel, positive(boat.keel_area) * wet_keel.fraction, 0, kWaterDensity}, wet_keel.flow, step,
        body);
    push_foil(
        {rudder, positive(boat.rudder_area) * wet_rudder.fraction, -state.rudder * kMaxRudder,
         kWaterDensity},
        wet_rudder.flow, step, body);
    const float length = 2 * std::abs(touch.half.z * transform.scale.z);
    const float hull_speed = std::sqrt(static_cast<float>(kGravity) * length / (2 * kPi));
    if (motion.submerged > 0) {
        resist_waves(hull_speed, positive(boat.wave_drag), step, wet_keel.flow, body);
    }
    if (is_finite(body.velocity) && is_finite(body.spin)) {
        motion.velocity = body.velocity;
        motion.spin = body.spin;
    }
}

void trim_sail(
    const Sailboat& boat, const Floating& floating, const FloatingState& motion,
    const Quat& rotation, const Vec3& scale, const Vec3& wind, float step, SailboatState& state) {
    const float blows =
        std::abs(apparent_wind_angle(boat, floating, motion, rotation, scale, wind));
    const float wanted = (blows - kBest - kMinBoomAngle) / (kMaxBoomAngle - kMinBoomAngle);
    const float change = std::clamp(wanted, 0.0f, 1.0f) - state.sheet;
    state.sheet += std::clamp(change, -kSailSheetRate * step, kSailSheetRate * step);
}

void follow_course(
    const PathData& course, const WaterTouch& touch, const FloatingState& motion,
    const Transform& transform, const Vec3& wind, SailboatState& state) {
    const Vec2 here = {transform.position.x, transform.position.z};
    const float look_ahead = kSailLookAhead * 2 * std::abs(touch.half.z * transform.scale.z);
    const auto goal = [&] {
        const Vec3 at = path_frame_at(course, state.distance).position;
        return Vec2(at.x, at.z);
    };
    for (int i = 0; i < kMaxCourseSteps && glm::distance(goal(), here) < look_ahead; ++i) {
        state.distance += static_cast<double>(kCourseStep);
    }
    const auto length = static_cast<double>(course.length());
    state.distance =
        course.closed ? std::fmod(state.distance, length) : std::min(state.distance, length);

    const Vec2 to_goal = goal() - here;
    float wanted = std::atan2(to_goal.y, to_goal.x);
    if (glm::length(Vec2(wind.x, wind.z)) > 0.1f) {
        // Angles from the windward direction; to starboard of it, the wind is from port.
        const float upwind = std::atan2(-wind.z, -wind.x);
        const float off = wrap(wanted - upwind);
        if (std::abs(off) < kNoGo) {
            state.tack =
                off * static_cast<float>(state.tack) < -kLayLine ? -state.tack : state.tack;
            state.tack = state.tack < 0 ? -1 : 1;
            wanted = upwind + static_cast<float>(state.tack) * kNoGo;
        } else {
            state.tack = off < 0 ? -1 : 1;
        }
    }
    const Quat rotation = normalize_or_identity(transform.rotation);
    const Vec3 ahead = rotation * Vec3(0, 0, 1);
    const float turn = kSteer * wrap(wanted - heading_of(rotation)) + kSteady * motion.spin.y;
    // When moving astern, the effect of the rudder is reversed.
    const float astern = glm::dot(motion.velocity, ahead) < -0.05f ? -1.0f : 1.0f;
    state.rudder = std::clamp(astern * turn, -1.0f, 1.0f);
}

}  // namespace limn
