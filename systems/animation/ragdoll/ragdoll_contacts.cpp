#include "systems/animation/ragdoll/ragdoll_contacts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

// Techniques: char.dynamics

namespace limn {
namespace {

constexpr std::size_t kMaxTriangles = 96;  // near one capsule
constexpr double kContactMargin = 0.02;    // beyond what a capsule moves in a step [m]
constexpr double kReachGravity = 10;       // by which it may speed up meanwhile [m/s^2]

RigidVec transform_precisely(const Affine& a, const RigidVec& p) {
    RigidVec result;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec4 row(a.row[i]);
        result[i] = row.x * p.x + row.y * p.y + row.z * p.z + row.w;
    }
    return result;
}

/// A point of a surface that a point of the segment is close to or behind.
struct SurfaceTouch {
    RigidVec center;  ///< point of the segment
    RigidVec surface;
    RigidVec normal;
};

/// The touches of one capsule and one surface; at most three.
struct Touches {
    SurfaceTouch list[3];
    std::size_t count = 0;

    void add(const RigidVec& center, const RigidVec& surface, const RigidVec& normal) {
        list[count++] = {center, surface, normal};
    }
};

/// Both ends, and a point between if it is neither.
struct SegmentPoints {
    double fractions[3];
    int count;
};
SegmentPoints ends_and(double u) {
    return {{0, 1, u}, u > 0.05 && u < 0.95 ? 3 : 2};
}

void touch_surface(
    const PlaneCollider& plane, const LineSegment& segment, double reach, Touches& found) {
    const RigidVec normal = glm::normalize(RigidVec(plane.normal));
    for (const RigidVec& end : {segment.from, segment.to}) {
        const double height = glm::dot(normal, end) - static_cast<double>(plane.offset);
        if (height < reach) {
            found.add(end, end - height * normal, normal);
        }
    }
}

void touch_surface(
    const SphereCollider& sphere, const LineSegment& segment, double reach, Touches& found) {
    const RigidVec center(sphere.center);
    const double radius = static_cast<double>(sphere.radius);
    const auto touch_at = [&](const RigidVec& at) {
        const RigidVec out = at - center;
        const double distance = glm::length(out);
        const RigidVec normal = distance > 1e-9 ? out / distance : RigidVec(0, 1, 0);
        const RigidVec surface = center + radius * normal;
        if (sphere.inverted && radius - distance < reach) {
            found.add(at, surface, -normal);
        } else if (!sphere.inverted && distance - radius < reach) {
            found.add(at, surface, normal);
        }
    };
    if (sphere.inverted) {
        touch_at(segment.from);
        touch_at(segment.to);
    } else {
        touch_at(segment.at(closest_fraction(segment, center)));
    }
}

void touch_surface(
    const BoxCollider& box, const LineSegment& segment, double reach, Touches& found) {
    const Mat4 m = to_mat4(box.world_from_box);
    const glm::dmat3 axes{Mat3(m)};
    const RigidVec center{Vec3(m[3])};
    const RigidVec half(box.half);
    const LineSegment local = {(segment.from - center) * axes, (segment.to - center) * axes};
    const SegmentPoints points = ends_and(closest_fraction_to_box(local, half));
    for (int i = 0; i < points.count; ++i) {
        const RigidVec p = local.at(points.fractions[i]);
        const RigidVec nearest = glm::clamp(p, -half, half);
        const double distance = glm::distance(p, nearest);
        if (distance >= reach) {
            continue;
        }
        RigidVec normal(0);
        RigidVec surface = nearest;
        if (distance > 1e-9) {
            normal = (p - nearest) / distance;
        } else {  // inside: through the nearest side, from the middle up
            int side = 1;
            for (const int axis : {0, 2}) {
                if (half[axis] - std::abs(p[axis]) < half[side] - std::abs(p[side])) {
                    side = axis;
                }
            }
            normal[side] = std::copysign(1.0, p[side]);
            surface[side] = std::copysign(half[side], p[side]);
        }
        found.add(segment.at(points.fractions[i]), center + axes * surface, axes * normal);
    }
}

void touch_surface(
    const HeightCollider& field, const LineSegment& segment, double reach, Touches& found) {
    const Collider collider = field;
    for (const double u : {0.0, 1.0, 0.5}) {
        const RigidVec p = segment.at(u);
        const auto escape = find_escape(collider, Vec3(p), static_cast<float>(reach));
        if (escape) {
            // Up to the raised surface; its plane is `reach` below, along the normal.
            const RigidVec normal(escape->normal);
            const double depth = static_cast<double>(escape->depth) * normal.y;
            found.add(p, p - (reach - depth) * normal, normal);
        }
    }
}

void touch_surface(
    const MeshCollider& /*its triangles are tested instead*/, const LineSegment& /*segment*/,
    double /*reach*/, Touches& /*found*/) {}

void touch_triangle(
    const Triangle3& triangle, double side, const LineSegment& segment, double reach,
    Touches& found) {
    const RigidVec across = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const double area = glm::length(across);
    if (!(area > 0)) {
        return;
    }
    const RigidVec normal = side / area * across;
    const ClosestPair pair = closest_points(segment, triangle);
    const SegmentPoints points = ends_and(closest_fraction(segment, pair.on_a));
    for (int i = 0; i < points.count; ++i) {
        const RigidVec p = segment.at(points.fractions[i]);
        const RigidVec nearest = closest_point(triangle, p);
        const RigidVec out = p - nearest;
        const double distance = glm::length(out);
        if (distance >= reach) {
            continue;
        }
        const double above = glm::dot(out, normal);
        // Behind the face; behind an edge it is in front of a neighbor.
        const bool is_behind = above <= 0 && distance - std::abs(above) < 1e-6 * (1 + distance);
        if (is_behind) {
            found.add(p, nearest, normal);
        } else if (distance > 1e-9) {
            found.add(p, nearest, out / distance);
        }
    }
}

RagdollContact
make_contact(std::size_t index, const RigidCapsule& body, const SurfaceTouch& touch) {
    RagdollContact contact;
    contact.body = index;
    contact.normal = touch.normal;
    const RigidVec lowest = touch.center - body.radius * touch.normal;
    contact.point = glm::conjugate(body.rotation) * (lowest - body.position);
    contact.under = touch.surface;
    return contact;
}

}  // namespace

RigidVec RagdollObstacle::velocity(const RigidVec& point, double dt) const {
    if (!moves || !(dt > 0)) {
        return RigidVec(0);
    }
    return (point - transform_precisely(earlier_from_now, point)) / dt;
}

RagdollContacts::RagdollContacts(
    std::span<const RagdollObstacle> obstacles, std::span<const std::uint64_t> apart,
    const std::vector<RigidCapsule>& bodies, double dt, std::vector<PartingPlane> planes)
    : obstacles_(obstacles), dt_(dt), planes_(std::move(planes)) {
    std::vector<double> reaches;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const RigidCapsule& body = bodies[i];
        const double way = dt * (glm::length(body.velocity) + kReachGravity * dt);
        const double reach = body.radius + 0.5 * glm::distance(body.segment.from, body.segment.to)
                             + way + kContactMargin;
        reaches.push_back(reach);
        const LineSegment segment = body.placed();
        for (std::size_t k = 0; k < obstacles.size(); ++k) {
            const RagdollObstacle& obstacle = obstacles[k];
            const double own = dt * glm::length(obstacle.velocity(body.position, dt));
            if (std::holds_alternative<MeshCollider>(obstacle.shape)) {
                collect_triangles(
                    obstacle, k, i, segment, body.radius + way + kContactMargin + own);
            } else if (may_touch(
                           obstacle.bounds, Vec3(body.position), Vec3(body.position),
                           static_cast<float>(reach + own), 0)) {
                near_.push_back({i, k, {}, 1});
            }
        }
    }
    for (std::size_t i = 0; i < std::min(apart.size(), bodies.size()); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if ((apart[i] >> j & 1) != 0
                && glm::distance(bodies[i].position, bodies[j].position)
                       < reaches[i] + reaches[j]) {
                pairs_.push_back({i, j});
            }
        }
    }
}

void RagdollContacts::collect_triangles(
    const RagdollObstacle& obstacle, std::size_t index, std::size_t body,
    const LineSegment& segment, double reach) {
    const MeshBvh* const bvh = std::get<MeshCollider>(obstacle.shape).bvh;
    if (bvh == nullptr) {
        return;
    }
    Bounds box;  // in the mesh's space
    for (const RigidVec& end : {segment.from, segment.to}) {
        for (int corner = 0; corner < 8; ++corner) {
            const RigidVec offset(
                corner & 1 ? reach : -reach, corner & 2 ? reach : -reach,
                corner & 4 ? reach : -reach);
            grow(box, Vec3(transform_precisely(obstacle.local, end + offset)));
        }
    }
    const RigidVec middle = segment.at(0.5);
    struct Numbered {
        std::uint32_t number;
        Near near;
    };
    std::vector<Numbered> found;
    visit_triangles(
        *bvh, box, [&](std::uint32_t number, const Vec3& a, const Vec3& b, const Vec3& c) {
            const Triangle3 placed = {
                transform_precisely(obstacle.world, RigidVec(a)),
                transform_precisely(obstacle.world, RigidVec(b)),
                transform_precisely(obstacle.world, RigidVec(c))};
            const RigidVec normal = glm::cross(placed.b - placed.a, placed.c - placed.a);
            const double side = glm::dot(normal, middle - placed.a) < 0 ? -1 : 1;
            found.push_back({number, {body, index, placed, side}});
        });
    // In the same order whatever the tree: one that was refitted, or built anew.
    std::ranges::sort(found, {}, &Numbered::number);
    for (std::size_t i = 0; i < std::min(found.size(), kMaxTriangles); ++i) {
        near_.push_back(found[i].near);
    }
}

void RagdollContacts::find(
    const std::vector<RigidCapsule>& bodies, double left, std::vector<RagdollContact>& contacts,
    double margin) const {
    for (const Near& near : near_) {
        const RigidCapsule& body = bodies[near.body];
        const RagdollObstacle& obstacle = obstacles_[near.obstacle];
        LineSegment segment = body.placed();
        // Obstacles are where they are at the end of the step.
        const RigidVec moves = obstacle.velocity(segment.at(0.5), dt_);
        segment = {segment.from + left * moves, segment.to + left * moves};
        Touches found;
        const double reach = body.radius + margin;
        if (std::holds_alternative<MeshCollider>(obstacle.shape)) {
            touch_triangle(near.triangle, near.side, segment, reach, found);
        } else {
            std::visit(
                [&](const auto& shape) { touch_surface(shape, segment, reach, found); },
                obstacle.shape);
        }
        for (std::size_t i = 0; i < found.count; ++i) {
            SurfaceTouch touch = found.list[i];
            touch.center -= left * moves;
            touch.surface -= left * moves;
            RagdollContact contact = make_contact(near.body, body, touch);
            contact.moves = obstacle.velocity(found.list[i].surface, dt_);
            contacts.push_back(contact);
        }
    }
    for (const PartingPlane& plane : planes_) {
        const RigidCapsule& body = bodies[plane.body];
        const LineSegment segment = body.placed();
        const RigidVec point = plane.point + (dt_ - left) * plane.velocity;
        for (const RigidVec& end : {segment.from, segment.to}) {
            const double height = glm::dot(plane.normal, end - point);
            if (height < body.radius + margin) {
                RagdollContact contact = make_contact(
                    plane.body, body, {end, end - height * plane.normal, plane.normal});
                contact.moves = plane.velocity;
                contact.parts = true;
                contacts.push_back(contact);
            }
        }
    }
    for (const NearBodies& pair : pairs_) {
        const RigidCapsule& a = bodies[pair.first];
        const RigidCapsule& b = bodies[pair.second];
        const ClosestPair points = closest_points(a.placed(), b.placed());
        const RigidVec out = points.on_a - points.on_b;
        const double distance = glm::length(out);
        if (distance >= a.radius + b.radius + margin || !(distance > 1e-9)) {
            continue;
        }
        const RigidVec normal = out / distance;
        const RigidVec surface = points.on_b + b.radius * normal;
        RagdollContact contact = make_contact(pair.first, a, {points.on_a, surface, normal});
        contact.other = pair.second;
        contact.under = glm::conjugate(b.rotation) * (surface - b.position);
        contacts.push_back(contact);
    }
}

}  // namespace limn
