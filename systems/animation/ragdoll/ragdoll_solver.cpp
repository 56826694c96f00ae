#include "systems/animation/ragdoll/ragdoll_solver.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.dynamics

namespace limn {
namespace {

constexpr double kRigidPi = 3.14159265358979323846;
constexpr int kRagdollSweeps = 30;  // over all joints and contacts in a substep
constexpr int kRagdollSubsteps = 64;
constexpr double kAnchorTolerance = 1e-4;  // [m]
constexpr double kAngleTolerance = 1e-3;   // [rad]
constexpr double kMinImpact = 0.3;         // slower impacts do not bounce [m/s]
constexpr double kSlackRate = 2;           // at which slack becomes less [rad/s]

double squared(double x) {
    return x * x;
}

/// What a body was before the substep.
struct BodyBefore {
    RigidVec position;
    RigidQuat rotation;
    RigidVec velocity;
    RigidVec spin;
};

/// Inverse inertia times a vector; 0 for a fixed body.
RigidVec inverse_inertia(const RigidCapsule& body, const RigidVec& v) {
    const RigidVec& axis = body.axis_now;
    const RigidVec along = glm::dot(axis, v) * axis;
    return body.inverse_along * along + body.inverse_across * (v - along);
}

RigidVec inertia_times(const RigidCapsule& body, const RigidVec& v) {
    const RigidVec& axis = body.axis_now;
    const RigidVec along = glm::dot(axis, v) * axis;
    return along / body.inverse_along + (v - along) / body.inverse_across;
}

/// Turns by atan(|turn| / 2) * 2 about `turn`: exactly undone by turn_between.
RigidQuat turned(const RigidQuat& rotation, const RigidVec& turn) {
    return glm::normalize(rotation + 0.5 * (RigidQuat(0, turn.x, turn.y, turn.z) * rotation));
}

void set_rotation(RigidCapsule& body, const RigidQuat& rotation) {
    body.rotation = rotation;
    body.axis_now = rotation * body.axis;
}

RigidVec turn_between(const RigidQuat& from, const RigidQuat& to) {
    const RigidQuat d = to * glm::conjugate(from);
    const double w = std::abs(d.w) > 1e-6 ? d.w : std::copysign(1e-6, d.w);
    return RigidVec(d.x, d.y, d.z) * (2 / w);
}

/// Adds [r]^T I^-1 [r] for I^-1 = across + (along - across) axis axis^T.
void add_response(const RigidCapsule& body, const RigidVec& r, glm::dmat3& k) {
    const RigidVec s = glm::cross(body.axis_now, r);
    const double across = body.inverse_across;
    const double more = body.inverse_along - across;
    const double r2 = glm::dot(r, r);
    for (int i = 0; i < 3; ++i) {
        k[i] += more * s[i] * s - across * r[i] * r;
        k[i][i] += across * r2;
    }
}

/// A pair of bodies and points at which they act on each other.
struct JointLink {
    RigidCapsule* a;
    RigidCapsule* b;
    RigidVec ra;  ///< from the centers of mass, in the world
    RigidVec rb;

    /// Matrix K: an impulse p on a, -p on b moves the points apart by -K p.
    [[nodiscard]] glm::dmat3 response() const {
        glm::dmat3 k(a->inverse_mass + b->inverse_mass);
        add_response(*a, ra, k);
        add_response(*b, rb, k);
        return k;
    }
};

/// Turns at a joint: angular impulses n on a and -n on b, with the impulse at the anchors that
/// keeps them together.
struct JointTurn {
    RigidVec impulse;  ///< at the anchors, on a
    RigidVec turn_a;   ///< rotation vectors, or changes of spins
    RigidVec turn_b;
    double response;  ///< by which b turns back relative to a about n

    JointTurn(const JointLink& link, const glm::dmat3& inverse, const RigidVec& n)
        : impulse(
            -(inverse
              * (glm::cross(inverse_inertia(*link.a, n), link.ra)
                 + glm::cross(inverse_inertia(*link.b, n), link.rb)))),
          turn_a(inverse_inertia(*link.a, n + glm::cross(link.ra, impulse))),
          turn_b(-inverse_inertia(*link.b, n + glm::cross(link.rb, impulse))),
          response(glm::dot(n, turn_a - turn_b)) {}
};

/// Angles at a joint.
struct JointAngles {
    RigidVec axis;  ///< in the world, unit
    double excess;  ///< > 0: the child is too far about `axis` by this
};

/// From `angle` to the range, the shorter way round.
double range_excess(double angle, double min, double max) {
    const double above = angle - max;
    const double below = min - angle;
    if (above <= 0 && below <= 0) {
        return 0;
    }
    const double around_up = angle + 2 * kRigidPi - max;      // angle < min: across pi
    const double around_down = min - (angle - 2 * kRigidPi);  // angle > max: likewise
    if (below > 0) {
        return around_up < below ? around_up : -below;
    }
    return around_down < above ? -around_down : above;
}

/// How far a hinge has left its plane.
JointAngles hinge_tilt(const RagdollLimit& limit, const RigidQuat& base, const RigidQuat& child) {
    const RigidVec axis(limit.axis);
    const RigidVec from = base * axis;
    const RigidVec to = child * axis;
    const RigidVec across = glm::cross(from, to);
    const double sine = glm::length(across);
    return {
        sine > 1e-12 ? across / sine : base * RigidVec(any_perpendicular(limit.axis)),
        std::atan2(sine, glm::dot(from, to))};
}

/// How far a hinge has turned beyond its range.
JointAngles hinge_excess(const RagdollLimit& limit, const RigidQuat& base, const RigidQuat& child) {
    const RigidVec axis = base * RigidVec(limit.axis);
    const RigidVec mark(any_perpendicular(limit.axis));
    const RigidVec from = base * mark;
    const RigidVec to = child * mark;
    const double angle = std::atan2(glm::dot(glm::cross(from, to), axis), glm::dot(from, to));
    return {
        axis, range_excess(angle, static_cast<double>(limit.min), static_cast<double>(limit.max))};
}

/// How far a bone has swung out of its cone.
JointAngles cone_excess(const RagdollLimit& limit, const RigidQuat& base, const RigidQuat& child) {
    const RigidVec center = base * RigidVec(limit.center);
    const RigidVec bone = child * RigidVec(limit.bone);
    const RigidVec across = glm::cross(center, bone);
    const double sine = glm::length(across);
    const double cosine = glm::dot(center, bone);
    const double narrow = static_cast<double>(std::min(limit.swing, limit.sway));
    const RigidVec axis = base * RigidVec(limit.axis);
    if (cosine > 0 && sine < narrow * cosine * 0.5) {  // surely inside: tan x < 2 x there
        return {axis, 0};
    }
    const double swing = std::atan2(sine, cosine);
    const RigidVec n = sine > 1e-12 ? across / sine : axis;
    const double u = glm::dot(n, axis) / static_cast<double>(limit.swing);
    const double v = glm::dot(n, glm::cross(center, axis)) / static_cast<double>(limit.sway);
    const double bound = 1 / std::sqrt(squared(u) + squared(v) + 1e-12);
    return {n, std::max(swing - bound, 0.0)};
}

/// How far a bone is twisted about itself beyond its range.
JointAngles twist_excess(const RagdollLimit& limit, const RigidQuat& base, const RigidQuat& child) {
    const RigidVec bone(limit.bone);
    const RigidQuat d = glm::conjugate(base) * child;
    const double sine = glm::dot(RigidVec(d.x, d.y, d.z), bone);
    const double narrow = static_cast<double>(std::min(-limit.min, limit.max));
    if (2 * std::abs(sine) < narrow * std::abs(d.w)) {  // surely inside: x < tan x
        return {child * bone, 0};
    }
    double twist = 2 * std::atan2(sine, d.w);
    if (twist > kRigidPi) {
        twist -= 2 * kRigidPi;
    } else if (twist < -kRigidPi) {
        twist += 2 * kRigidPi;
    }
    return {
        child * bone,
        range_excess(twist, static_cast<double>(limit.min), static_cast<double>(limit.max))};
}

/// One of the two limits of a joint in these rotations.
JointAngles
find_excess(const RagdollJoint& joint, const RigidQuat& parent, const RigidQuat& child, int which) {
    const RigidQuat base = parent * joint.rest;  // of the child at rest
    const bool is_hinge = joint.limit.kind == RagdollJointKind::Hinge;
    JointAngles angles;
    if (which == 0) {
        angles =
            is_hinge ? hinge_tilt(joint.limit, base, child) : cone_excess(joint.limit, base, child);
    } else {
        angles = is_hinge ? hinge_excess(joint.limit, base, child)
                          : twist_excess(joint.limit, base, child);
    }
    return angles.excess < 0 ? JointAngles{-angles.axis, -angles.excess} : angles;
}

class RagdollSubstep {
  public:
    RagdollSubstep(RagdollScene& scene, double h, const RagdollOptions& options)
        : bodies_(scene.bodies), joints_(scene.joints), scene_(scene), h_(h), options_(options) {}

    void run(double left, const FindContacts& find, std::vector<RagdollContact>& contacts) {
        predict();
        contacts.clear();
        if (find) {
            find(bodies_, left, contacts);
        }
        for (RagdollContact& contact : contacts) {
            contact.approach = glm::dot(contact.normal, relative_velocity(contact, true));
        }
        if (options_.muscles > 0) {
            for (RagdollJoint& joint : joints_) {
                pull_muscle(joint);
            }
        }
        for (int sweep = 0; sweep < kRagdollSweeps; ++sweep) {
            for (RagdollContact& contact : contacts) {
                solve_contact(contact);
            }
            anchor_ = 0;
            angle_ = 0;
            for (std::size_t i = 0; i < joints_.size(); ++i) {
                solve_joint(joints_[sweep % 2 == 0 ? i : joints_.size() - 1 - i]);
            }
            if (anchor_ < kAnchorTolerance && angle_ < kAngleTolerance) {
                break;
            }
        }
        close_anchors();
        derive_velocities();
        for (RagdollContact& contact : contacts) {
            settle_contact(contact);
        }
        if (options_.damping > 0) {
            for (RagdollJoint& joint : joints_) {
                damp_joint(joint);
            }
        }
    }

  private:
    void predict() {
        before_.clear();
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            RigidCapsule& body = bodies_[i];
            before_.push_back({body.position, body.rotation, body.velocity, body.spin});
            if (!(body.inverse_mass > 0)) {
                continue;
            }
            body.velocity += h_ * options_.gravity;
            if (i < scene_.forces.size()) {
                body.velocity += h_ * scene_.forces[i];
            }
            body.position += h_ * body.velocity;
            // Free motion keeps the angular momentum: the spin halfway of the substep turns it.
            // Free motion keeps angular momentum and energy: the implicit midpoint rule.
            const RigidVec momentum = inertia_times(body, body.spin);
            RigidCapsule half = body;
            RigidVec spin = body.spin;
            for (int k = 0; k < 3; ++k) {
                set_rotation(half, turned(body.rotation, 0.5 * h_ * spin));
                spin = inverse_inertia(half, momentum);
            }
            set_rotation(body, turned(body.rotation, h_ * spin));
        }
    }

    void derive_velocities() {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            RigidCapsule& body = bodies_[i];
            if (!(body.inverse_mass > 0)) {
                continue;
            }
            const BodyBefore& before = before_[i];
            body.velocity = (body.position - before.position) / h_;
            const RigidVec turn = turn_between(before.rotation, body.rotation);
            RigidCapsule half = body;
            set_rotation(half, turned(before.rotation, 0.5 * turn));
            body.spin = inverse_inertia(body, inertia_times(half, turn / h_));
        }
    }

    [[nodiscard]] JointLink link(const RagdollJoint& joint) {
        RigidCapsule& a = bodies_[joint.parent];
        RigidCapsule& b = bodies_[joint.child];
        return {&a, &b, a.rotation * joint.anchor_parent, b.rotation * joint.anchor_child};
    }

    static void push(RigidCapsule& body, const RigidVec& r, const RigidVec& impulse) {
        body.position += body.inverse_mass * impulse;
        const RigidVec way = inverse_inertia(body, glm::cross(r, impulse));
        set_rotation(body, turned(body.rotation, way));
    }

    /// Turns b relative to a by -angle about n.
    static void
    turn(const JointLink& link, const glm::dmat3& inverse, const RigidVec& n, double angle) {
        const JointTurn unit(link, inverse, n);
        if (!(unit.response > 1e-12)) {
            return;
        }
        const double share = angle / unit.response;
        link.a->position += share * link.a->inverse_mass * unit.impulse;
        link.b->position -= share * link.b->inverse_mass * unit.impulse;
        set_rotation(*link.a, turned(link.a->rotation, share * unit.turn_a));
        set_rotation(*link.b, turned(link.b->rotation, share * unit.turn_b));
    }

    void solve_joint(const RagdollJoint& joint) {
        JointLink points = link(joint);
        const glm::dmat3 inverse = glm::inverse(points.response());
        for (int i = 0; i < 2; ++i) {
            const JointAngles angles =
                find_excess(joint, points.a->rotation, points.b->rotation, i);
            const double excess = angles.excess - joint.slack;
            if (excess > 0) {
                angle_ = std::max(angle_, excess);
                turn(points, inverse, angles.axis, excess);
                points = link(joint);
            }
        }
        close_anchor(points, inverse);
    }

    /// Where contacts and limits contradict each other, bones still stay together.
    void close_anchors() {
        for (int sweep = 0; sweep < kRagdollSweeps && anchor_ >= kAnchorTolerance; ++sweep) {
            anchor_ = 0;
            for (std::size_t i = 0; i < joints_.size(); ++i) {
                const JointLink points = link(joints_[sweep % 2 == 0 ? i : joints_.size() - 1 - i]);
                close_anchor(points, glm::inverse(points.response()));
            }
        }
    }

    void close_anchor(const JointLink& points, const glm::dmat3& inverse) {
        const RigidVec error = points.b->position + points.rb - points.a->position - points.ra;
        anchor_ = std::max(anchor_, glm::length(error));
        const RigidVec impulse = inverse * error;
        push(*points.a, points.ra, impulse);
        push(*points.b, points.rb, -impulse);
    }

    void pull_muscle(const RagdollJoint& joint) {
        const JointLink points = link(joint);
        RigidQuat d = points.b->rotation * glm::conjugate(points.a->rotation * joint.target);
        if (d.w < 0) {
            d = -d;
        }
        const RigidVec v(d.x, d.y, d.z);
        const double sine = glm::length(v);
        if (sine > 1e-9) {
            const double share = squared(options_.muscles * h_);
            turn(
                points, glm::inverse(points.response()), v / sine,
                2 * std::atan2(sine, d.w) * share / (1 + share));
        }
    }

    void damp_joint(const RagdollJoint& joint) {
        const JointLink points = link(joint);
        const RigidVec relative = points.b->spin - points.a->spin;
        const double speed = glm::length(relative);
        if (!(speed > 1e-9)) {
            return;
        }
        const JointTurn unit(points, glm::inverse(points.response()), relative / speed);
        if (!(unit.response > 1e-12)) {
            return;
        }
        const double rate = options_.damping * h_;
        const double share = speed * rate / (1 + rate) / unit.response;
        points.a->velocity += share * points.a->inverse_mass * unit.impulse;
        points.b->velocity -= share * points.b->inverse_mass * unit.impulse;
        points.a->spin += share * unit.turn_a;
        points.b->spin += share * unit.turn_b;
    }

    [[nodiscard]] RigidVec
    relative_velocity(const RagdollContact& contact, bool is_before = false) const {
        const auto at = [&](std::size_t i, const RigidVec& point) {
            const RigidCapsule& body = bodies_[i];
            const RigidVec r = body.rotation * point;
            return is_before ? before_[i].velocity + glm::cross(before_[i].spin, r)
                             : body.velocity + glm::cross(body.spin, r);
        };
        const RigidVec own = at(contact.body, contact.point);
        return own
               - (contact.other == RagdollContact::kNoBody ? contact.moves
                                                           : at(contact.other, contact.under));
    }

    /// Points of both surfaces now and before the substep, relative to each other.
    struct Offset {
        RigidVec ra;
        RigidVec rb;
        RigidVec now;
        RigidVec moved;  ///< in this substep
    };
    [[nodiscard]] Offset offset(const RagdollContact& contact) const {
        const RigidCapsule& body = bodies_[contact.body];
        const BodyBefore& before = before_[contact.body];
        Offset o;
        o.ra = body.rotation * contact.point;
        const RigidVec at = body.position + o.ra;
        RigidVec moved = at - (before.position + before.rotation * contact.point);
        if (contact.other == RagdollContact::kNoBody) {
            o.rb = RigidVec(0);
            o.now = at - contact.under;
            moved -= h_ * contact.moves;
        } else {
            const RigidCapsule& other = bodies_[contact.other];
            const BodyBefore& last = before_[contact.other];
            o.rb = other.rotation * contact.under;
            const RigidVec under = other.position + o.rb;
            o.now = at - under;
            moved -= under - (last.position + last.rotation * contact.under);
        }
        o.moved = moved;
        return o;
    }

    /// How far an impulse of 1 along n parts the two surfaces.
    [[nodiscard]] double
    contact_response(const RagdollContact& contact, const Offset& o, const RigidVec& n) const {
        const auto of = [&](const RigidCapsule& body, const RigidVec& r) {
            const RigidVec arm = glm::cross(r, n);
            return body.inverse_mass + glm::dot(arm, inverse_inertia(body, arm));
        };
        const double own = of(bodies_[contact.body], o.ra);
        return contact.other == RagdollContact::kNoBody ? own
                                                        : own + of(bodies_[contact.other], o.rb);
    }

    void push_contact(const RagdollContact& contact, const Offset& o, const RigidVec& impulse) {
        push(bodies_[contact.body], o.ra, impulse);
        if (contact.other != RagdollContact::kNoBody) {
            push(bodies_[contact.other], o.rb, -impulse);
        }
    }

    void solve_contact(RagdollContact& contact) {
        Offset o = offset(contact);
        const double depth = -glm::dot(o.now, contact.normal);
        if (!(depth > 0)) {
            return;
        }
        // What overlapped before the substep parts at a limited speed.
        const double parted = glm::dot(o.moved, contact.normal);
        const double way = std::min(depth, h_ * options_.max_depenetration - parted);
        if (!(way > 0)) {
            return;
        }
        const double response = contact_response(contact, o, contact.normal);
        const double impulse = way / response;
        contact.pressed += impulse;
        push_contact(contact, o, impulse * contact.normal);
        // Friction takes back what the surfaces slid in this substep, within Coulomb's cone.
        o = offset(contact);
        const RigidVec slid = o.moved - glm::dot(o.moved, contact.normal) * contact.normal;
        const double length = glm::length(slid);
        const double room = options_.friction * contact.pressed - contact.rubbed;
        if (length > 1e-12 && room > 0) {
            const RigidVec n = slid / length;
            const double rub = std::min(length / contact_response(contact, o, n), room);
            contact.rubbed += rub;
            push_contact(contact, o, -rub * n);
        }
    }

    /// After the velocities are known: the speed that parting surfaces gained is lost again, but
    /// for what bounces.
    void settle_contact(const RagdollContact& contact) {
        if (!(contact.pressed > 0)) {
            return;
        }
        const double wanted =
            contact.approach < -kMinImpact ? -options_.bounce * contact.approach : 0.0;
        const double change = wanted - glm::dot(contact.normal, relative_velocity(contact));
        const Offset o = offset(contact);
        const RigidVec impulse =
            change / contact_response(contact, o, contact.normal) * contact.normal;
        const auto kick = [&](RigidCapsule& body, const RigidVec& r, const RigidVec& p) {
            body.velocity += body.inverse_mass * p;
            body.spin += inverse_inertia(body, glm::cross(r, p));
        };
        kick(bodies_[contact.body], o.ra, impulse);
        if (contact.other != RagdollContact::kNoBody) {
            kick(bodies_[contact.other], o.rb, -impulse);
        }
    }

    std::vector<RigidCapsule>& bodies_;
    std::vector<RagdollJoint>& joints_;
    RagdollScene& scene_;
    double h_;
    const RagdollOptions& options_;
    std::vector<BodyBefore> before_;
    double anchor_ = 0;  ///< largest errors found in a sweep
    double angle_ = 0;
};

}  // namespace

RigidCapsule make_capsule(
    const RigidVec& from, const RigidVec& to, double radius, double mass, const RigidVec& origin,
    const RigidQuat& rotation) {
    const double length = glm::distance(from, to);
    const CapsuleMass shape = find_capsule_mass(length, radius);
    const RigidVec center = 0.5 * (from + to);
    RigidCapsule body;
    body.position = origin + rotation * center;
    body.rotation = rotation;
    body.inverse_mass = 1 / mass;
    body.inverse_along = 1 / (mass * shape.along);
    body.inverse_across = 1 / (mass * shape.across);
    body.segment = {from - center, to - center};
    body.axis = length > 1e-12 ? (to - from) / length : RigidVec(0, 1, 0);
    body.radius = radius;
    return body;
}

void step_ragdoll(
    RagdollScene& scene, double dt, const RagdollOptions& options, const FindContacts& find) {
    if (!(dt > 0)) {
        return;
    }
    const double wanted = std::ceil(dt / kRagdollSubstep - 1e-6);
    const int count = static_cast<int>(std::clamp(wanted, 1.0, double{kRagdollSubsteps}));
    const double h = dt / count;
    std::vector<RagdollContact> contacts;
    for (RigidCapsule& body : scene.bodies) {
        set_rotation(body, body.rotation);
    }
    RagdollSubstep substep(scene, h, options);
    for (int i = 0; i < count; ++i) {
        for (RagdollJoint& joint : scene.joints) {
            joint.slack = std::max(joint.slack - kSlackRate * h, 0.0);
        }
        substep.run(dt - (i + 1) * h, find, contacts);
    }
}

double anchor_error(const RagdollScene& scene, const RagdollJoint& joint) {
    const RigidCapsule& a = scene.bodies[joint.parent];
    const RigidCapsule& b = scene.bodies[joint.child];
    return glm::distance(
        a.position + a.rotation * joint.anchor_parent,
        b.position + b.rotation * joint.anchor_child);
}

double limit_excess(const RagdollScene& scene, const RagdollJoint& joint) {
    const RigidQuat& parent = scene.bodies[joint.parent].rotation;
    const RigidQuat& child = scene.bodies[joint.child].rotation;
    return std::max(
        find_excess(joint, parent, child, 0).excess, find_excess(joint, parent, child, 1).excess);
}

}  // namespace limn
