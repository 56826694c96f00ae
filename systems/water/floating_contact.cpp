#include "systems/water/floating_contact.h"

#include "ecs/base/rotation.h"
#include "systems/water/floating_body.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr int kContactRounds = 3;             // over all pairs
constexpr float kContactRestitution = 0.25f;  // of approaching speeds above kRestSpeed
constexpr float kRestSpeed = 0.3f;            // [m/s]
constexpr float kContactFriction = 0.35f;     // Coulomb
constexpr float kContactSlop = 0.004f;        // overlap that is left [m]
constexpr float kCorrection = 0.35f;          // of the rest, that a round moves apart
constexpr float kFlat = 0.08f;      // cosine below which an edge lies in the plane of contact
constexpr float kFaceBias = 0.95f;  // edges must be less deep than this part of faces
constexpr float kParallel = 1e-4f;  // squared sine below which edges have no cross product

/// A rigid body during a step.
struct Solid {
    ContactShape shape;
    Vec3 center;  ///< of mass [m]
    Vec3 moved = {0, 0, 0};
    Vec3 velocity;
    Vec3 spin;
    float inverse_mass = 0;
    Mat3 inverse_inertia = Mat3(0);
    float reach = 0;  ///< radius of a ball about the shape's center that holds it [m]
    std::uint32_t body = 0;
    bool touched = false;
};

float extent_along(const ContactShape& box, const Vec3& axis) {
    float extent = 0;
    for (int i = 0; i < 3; ++i) {
        extent += std::abs(glm::dot(box.axes[i], axis)) * box.half[i];
    }
    return extent;
}

/// The middle of the corner, edge or face of `box` that is farthest along `direction`, and the
/// number of its dimensions.
std::pair<Vec3, int> farthest_feature(const ContactShape& box, const Vec3& direction) {
    Vec3 point = box.center;
    int dimensions = 0;
    for (int i = 0; i < 3; ++i) {
        const float cosine = glm::dot(box.axes[i], direction);
        if (std::abs(cosine) < kFlat) {
            ++dimensions;
        } else {
            point += (cosine > 0 ? box.half[i] : -box.half[i]) * box.axes[i];
        }
    }
    return {point, dimensions};
}

std::optional<BodyContact> ball_on_ball(const ContactShape& a, const ContactShape& b) {
    const Vec3 apart = a.center - b.center;
    const float distance = glm::length(apart);
    const float depth = a.half.x + b.half.x - distance;
    if (!(depth > 0)) {
        return std::nullopt;
    }
    const Vec3 normal = distance > 1e-6f ? apart / distance : Vec3(0, 1, 0);
    return BodyContact{b.center + (b.half.x - 0.5f * depth) * normal, normal, depth};
}

/// The ball is the first.
std::optional<BodyContact> ball_on_box(const ContactShape& ball, const ContactShape& box) {
    const Vec3 apart = glm::transpose(box.axes) * (ball.center - box.center);
    const Vec3 nearest = glm::clamp(apart, -box.half, box.half);
    const float distance = glm::length(apart - nearest);
    if (!(distance < ball.half.x)) {
        return std::nullopt;
    }
    if (distance > 1e-6f) {
        const Vec3 normal = box.axes * ((apart - nearest) / distance);
        return BodyContact{box.center + box.axes * nearest, normal, ball.half.x - distance};
    }
    int face = 0;  // the center is inside: out through the nearest face
    for (int i = 1; i < 3; ++i) {
        face = box.half[i] - std::abs(apart[i]) < box.half[face] - std::abs(apart[face]) ? i : face;
    }
    const float side = apart[face] < 0 ? -1.0f : 1.0f;
    return BodyContact{
        ball.center, side * box.axes[face], ball.half.x + box.half[face] - std::abs(apart[face])};
}

std::optional<BodyContact> box_on_box(const ContactShape& a, const ContactShape& b) {
    const Vec3 apart = a.center - b.center;
    BodyContact best{.depth = INFINITY};
    const auto test = [&](const Vec3& axis, float bias) {
        const float along = glm::dot(apart, axis);
        const float depth = extent_along(a, axis) + extent_along(b, axis) - std::abs(along);
        if (depth < bias * best.depth) {
            best.depth = depth;
            best.normal = along < 0 ? -axis : axis;
        }
        return depth > 0;
    };
    for (int i = 0; i < 3; ++i) {
        if (!test(a.axes[i], 1) || !test(b.axes[i], 1)) {
            return std::nullopt;
        }
    }
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            const Vec3 edge = glm::cross(a.axes[i], b.axes[k]);
            const float squared = glm::dot(edge, edge);
            if (squared > kParallel && !test(edge / std::sqrt(squared), kFaceBias)) {
                return std::nullopt;
            }
        }
    }
    const auto [on_a, dimensions_a] = farthest_feature(a, -best.normal);
    const auto [on_b, dimensions_b] = farthest_feature(b, best.normal);
    best.point = dimensions_a < dimensions_b   ? on_a
                 : dimensions_b < dimensions_a ? on_b
                                               : 0.5f * (on_a + on_b);
    return best;
}

Mat3 inverse_inertia_of(const Mat3& axes, const Vec3& inertia) {
    Mat3 scaled = axes;
    for (int i = 0; i < 3; ++i) {
        scaled[i] *= inertia[i] > 0 ? 1 / inertia[i] : 0.0f;
    }
    return scaled * glm::transpose(axes);
}

std::optional<Solid> make_solid(const ContactBody& body, std::uint32_t index) {
    const Transform& pose = *body.transform;
    const BodyMass mass = body_mass(*body.touch, *body.floating, pose.scale);
    const Vec3 sum = pose.position + body.state->velocity + body.state->spin;
    if (body.touch->shape == TouchShape::Mesh || !(mass.mass > 0) || !std::isfinite(mass.mass)
        || !std::isfinite(sum.x + sum.y + sum.z)) {
        return std::nullopt;
    }
    Solid solid;
    const Quat rotation = normalize_or_identity(pose.rotation);
    solid.shape.axes = glm::mat3_cast(rotation);
    solid.shape.half = mass.half;
    solid.shape.ball = body.touch->shape == TouchShape::Ball;
    solid.reach = solid.shape.ball ? solid.shape.half.x : glm::length(solid.shape.half);
    solid.shape.center = pose.position + rotation * (body.touch->offset * pose.scale);
    solid.center = pose.position + rotation * mass.center;
    solid.velocity = body.state->velocity;
    solid.spin = body.state->spin;
    solid.inverse_mass = 1 / mass.mass;
    solid.inverse_inertia = inverse_inertia_of(solid.shape.axes, mass.inertia);
    solid.body = index;
    return solid;
}

struct Pair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

/// Of solids whose bounding balls overlap; sorts `solids` along x.
void find_pairs(std::vector<Solid>& solids, std::vector<Pair>& pairs) {
    std::sort(solids.begin(), solids.end(), [](const Solid& a, const Solid& b) {
        const float left_a = a.shape.center.x - a.reach;
        const float left_b = b.shape.center.x - b.reach;
        return left_a != left_b ? left_a < left_b : a.body < b.body;
    });
    pairs.clear();
    for (std::uint32_t i = 0; i < solids.size(); ++i) {
        const Solid& a = solids[i];
        for (std::uint32_t k = i + 1; k < solids.size(); ++k) {
            const Solid& b = solids[k];
            if (b.shape.center.x - b.reach > a.shape.center.x + a.reach) {
                break;
            }
            const Vec3 apart = b.shape.center - a.shape.center;
            if (glm::dot(apart, apart) < (a.reach + b.reach) * (a.reach + b.reach)) {
                pairs.push_back({i, k});
            }
        }
    }
}

/// Mass that an impulse along `direction` at arms `ra` and `rb` moves.
float effective_mass(
    const Solid& a, const Solid& b, const Vec3& ra, const Vec3& rb, const Vec3& direction) {
    const Vec3 turn_a = glm::cross(a.inverse_inertia * glm::cross(ra, direction), ra);
    const Vec3 turn_b = glm::cross(b.inverse_inertia * glm::cross(rb, direction), rb);
    return 1 / (a.inverse_mass + b.inverse_mass + glm::dot(turn_a + turn_b, direction));
}

void push(Solid& solid, const Vec3& arm, const Vec3& impulse) {
    solid.velocity += solid.inverse_mass * impulse;
    solid.spin += solid.inverse_inertia * glm::cross(arm, impulse);
}

void move_by(Solid& solid, const Vec3& offset) {
    solid.center += offset;
    solid.moved += offset;
    solid.shape.center += offset;
}

void solve(Solid& a, Solid& b, const BodyContact& contact, bool first_round) {
    const Vec3 ra = contact.point - a.center;
    const Vec3 rb = contact.point - b.center;
    const auto closing = [&] {
        return a.velocity + glm::cross(a.spin, ra) - b.velocity - glm::cross(b.spin, rb);
    };
    const Vec3 before = closing();
    const float approach = -glm::dot(before, contact.normal);
    if (approach > 0) {
        const float bounce = first_round && approach > kRestSpeed ? kContactRestitution : 0.0f;
        const float impulse =
            (1 + bounce) * approach * effective_mass(a, b, ra, rb, contact.normal);
        push(a, ra, impulse * contact.normal);
        push(b, rb, -impulse * contact.normal);
        const Vec3 after = closing();
        const Vec3 sliding = after - glm::dot(after, contact.normal) * contact.normal;
        const float speed = glm::length(sliding);
        if (speed > 1e-5f) {
            const Vec3 along = sliding / speed;
            const float stop = speed * effective_mass(a, b, ra, rb, along);
            const Vec3 rub = -std::min(stop, kContactFriction * impulse) * along;
            push(a, ra, rub);
            push(b, rb, -rub);
        }
    }
    const float apart = kCorrection * std::max(contact.depth - kContactSlop, 0.0f)
                        / (a.inverse_mass + b.inverse_mass);
    move_by(a, apart * a.inverse_mass * contact.normal);
    move_by(b, -apart * b.inverse_mass * contact.normal);
    a.touched = b.touched = true;
}

}  // namespace

std::optional<BodyContact> find_contact(const ContactShape& a, const ContactShape& b) {
    if (a.ball) {
        return b.ball ? ball_on_ball(a, b) : ball_on_box(a, b);
    }
    if (!b.ball) {
        return box_on_box(a, b);
    }
    std::optional<BodyContact> contact = ball_on_box(b, a);
    if (contact) {
        contact->normal = -contact->normal;
    }
    return contact;
}

int separate_floating_bodies(std::span<const ContactBody> bodies) {
    thread_local std::vector<Solid> solids;  // scratch, kept for its memory
    thread_local std::vector<Pair> pairs;
    solids.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (std::optional<Solid> solid = make_solid(bodies[i], i)) {
            solids.push_back(*solid);
        }
    }
    find_pairs(solids, pairs);
    int contacts = 0;
    for (int round = 0; round < kContactRounds; ++round) {
        for (const Pair& pair : pairs) {
            Solid& a = solids[pair.a];
            Solid& b = solids[pair.b];
            if (const std::optional<BodyContact> contact = find_contact(a.shape, b.shape)) {
                solve(a, b, *contact, round == 0);
                contacts += round == 0 ? 1 : 0;
            }
        }
    }
    for (const Solid& solid : solids) {
        if (solid.touched) {
            const ContactBody& body = bodies[solid.body];
            body.state->velocity = solid.velocity;
            body.state->spin = solid.spin;
            body.transform->position += solid.moved;
        }
    }
    return contacts;
}

}  // namespace limn
