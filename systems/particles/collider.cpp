#include "systems/particles/collider.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

// Techniques: particle.collision-loop, particle.constraints, particle.heightfield-collision

namespace limn {

namespace {

using Dvec3 = glm::dvec3;

/// The path to test, in double precision, so that fractions are as exact as rounded positions.
struct Sweep {
    Dvec3 from;
    Dvec3 delta;
    double radius;

    [[nodiscard]] Dvec3 at(double fraction) const { return from + fraction * delta; }
};

struct Touch {
    double fraction;
    Dvec3 point;
    Dvec3 normal;
};

Vec3 unit_normal(const PlaneCollider& plane) {
    return normalize_or(plane.normal, Vec3(0, 1, 0));
}

// ---- first contact
// -------------------------------------------------------------------------------

std::optional<Touch> touch(const PlaneCollider& plane, const Sweep& sweep) {
    const Dvec3 normal(unit_normal(plane));
    const double before = glm::dot(normal, sweep.from) - double{plane.offset} - sweep.radius;
    const double change = glm::dot(normal, sweep.delta);
    if (!(before >= 0 && before + change < 0)) {
        return {};
    }
    const double fraction = before / -change;
    return Touch{fraction, sweep.at(fraction), normal};
}

/// Solves |from + t delta - center| = radius in the forms that do not cancel.
std::optional<Touch> touch(const SphereCollider& sphere, const Sweep& sweep) {
    const double side = sphere.inverted ? -1 : 1;
    const double radius = double{sphere.radius} + side * sweep.radius;
    const Dvec3 from = sweep.from - Dvec3(sphere.center);
    const double a = glm::dot(sweep.delta, sweep.delta);
    const double b = glm::dot(from, sweep.delta);
    const double c = glm::dot(from, from) - radius * radius;
    const double root = b * b - a * c;
    const bool outside = c * side >= 0;
    if (!(radius > 0 && outside) || (!sphere.inverted && !(root > 0 && b < 0))) {
        return {};
    }
    const double fraction = sphere.inverted && b <= 0 ? (std::sqrt(root) - b) / a
                                                      : side * c / (std::sqrt(root) - side * b);
    if (!(fraction <= 1)) {
        return {};
    }
    return Touch{
        fraction, sweep.at(fraction), side * glm::normalize(from + fraction * sweep.delta)};
}

struct BoxFrame {
    glm::dmat3 axes;  ///< of the box, in world space
    Dvec3 center;
};

BoxFrame box_frame(const BoxCollider& box) {
    const Mat4 m = to_mat4(box.world_from_box);
    return {glm::dmat3(Mat3(m)), Dvec3(m[3])};
}

std::optional<Touch> touch(const BoxCollider& box, const Sweep& sweep) {
    const BoxFrame frame = box_frame(box);
    const Dvec3 from = (sweep.from - frame.center) * frame.axes;  // by the transpose
    const Dvec3 delta = sweep.delta * frame.axes;
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    int entered = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = double{box.half[axis]} + sweep.radius;
        if (delta[axis] == 0) {
            if (std::abs(from[axis]) >= half) {
                return {};
            }
            continue;
        }
        const double toward = std::copysign(half, delta[axis]);
        const double in = (-toward - from[axis]) / delta[axis];
        if (in > enter) {
            enter = in;
            entered = axis;
        }
        leave = std::min(leave, (toward - from[axis]) / delta[axis]);
    }
    if (!(enter >= 0 && enter <= 1 && enter <= leave)) {
        return {};
    }
    return Touch{enter, sweep.at(enter), -std::copysign(1.0, delta[entered]) * frame.axes[entered]};
}

/// The bilinear surface of a cell, as a function of the grid coordinates within it, 0 .. 1.
struct Patch {
    double height, along_x, along_z, twist;
    double raise;  ///< of the surface for a particle with a radius
    Dvec3 cell;    ///< x and z: size

    [[nodiscard]] double at(double x, double z) const {
        return height + along_x * x + along_z * z + twist * x * z + raise;
    }
    [[nodiscard]] Dvec3 normal(double x, double z) const {
        return glm::normalize(
            Dvec3(-(along_x + twist * z) / cell.x, 1, -(along_z + twist * x) / cell.z));
    }
};

Patch patch_at(const HeightCollider& field, int i, int j, double radius) {
    const auto height = [&](int x, int z) {
        return double{field.heights[static_cast<std::size_t>((j + z) * field.width + i + x)]};
    };
    const double h = height(0, 0);
    Patch patch = {
        .height = double{field.origin.y} + h,
        .along_x = height(1, 0) - h,
        .along_z = height(0, 1) - h,
        .twist = height(1, 1) - height(1, 0) - height(0, 1) + h,
        .raise = 0,
        .cell = {field.cell.x, 0, field.cell.y}};
    patch.raise = radius / patch.normal(0.5, 0.5).y;
    return patch;
}

/// The smallest s >= 0 at which a s^2 + b s + c, c >= 0, becomes negative; NaN if it never does.
double falls_below_zero(double a, double b, double c) {
    const double root = std::sqrt(b * b - 4 * a * c);
    if (b < 0) {
        return 2 * c / (root - b);
    }
    return a < 0 ? -(b + root) / (2 * a) : std::numeric_limits<double>::quiet_NaN();
}

/// Walks the cells below the sweep; in each, the height above the surface is quadratic in the
/// fraction of the path.
std::optional<Touch> touch(const HeightCollider& field, const Sweep& sweep) {
    LIMN_CHECK(field.heights.size() >= static_cast<std::size_t>(field.width * field.depth));
    if (field.width < 2 || field.depth < 2) {
        return {};
    }
    const double cells[2] = {field.width - 1.0, field.depth - 1.0};
    double from[2];
    double delta[2];
    double fraction = 0;
    double end = 1;
    for (int k = 0; k < 2; ++k) {
        from[k] = (sweep.from[2 * k] - double{field.origin[2 * k]}) / double{field.cell[k]};
        delta[k] = sweep.delta[2 * k] / double{field.cell[k]};
        if (delta[k] != 0) {
            const double a = -from[k] / delta[k];
            const double b = (cells[k] - from[k]) / delta[k];
            fraction = std::max(fraction, std::min(a, b));
            end = std::min(end, std::max(a, b));
        } else if (!(from[k] >= 0 && from[k] <= cells[k])) {
            return {};
        }
    }
    if (!(fraction <= end)) {
        return {};
    }
    int cell[2];
    for (int k = 0; k < 2; ++k) {
        cell[k] = static_cast<int>(std::clamp(from[k] + fraction * delta[k], 0.0, cells[k] - 1));
    }
    for (bool first = true;; first = false) {
        double next = end;
        int crossed = -1;
        for (int k = 0; k < 2; ++k) {
            if (delta[k] != 0) {
                const double border = (cell[k] + (delta[k] > 0 ? 1 : 0) - from[k]) / delta[k];
                if (border < next) {
                    next = std::max(border, fraction);
                    crossed = k;
                }
            }
        }
        const Patch patch = patch_at(field, cell[0], cell[1], sweep.radius);
        const double x = from[0] + fraction * delta[0] - cell[0];
        const double z = from[1] + fraction * delta[1] - cell[1];
        const double above = sweep.at(fraction).y - patch.at(x, z);
        if (first && above < 0) {
            return {};  // starts below
        }
        // May be below the surface where this cell begins, though not where the previous one ended:
        // by rounding, or because the radius raises each cell differently.
        const double fall = above < 0
                                ? 0.0
                                : falls_below_zero(
                                    -patch.twist * delta[0] * delta[1],
                                    sweep.delta.y - (patch.along_x + patch.twist * z) * delta[0]
                                        - (patch.along_z + patch.twist * x) * delta[1],
                                    above);
        if (fraction + fall <= next) {
            return Touch{
                fraction + fall, sweep.at(fraction + fall),
                patch.normal(x + fall * delta[0], z + fall * delta[1])};
        }
        if (crossed < 0) {
            return {};
        }
        fraction = next;
        cell[crossed] += delta[crossed] > 0 ? 1 : -1;
        if (cell[crossed] < 0 || cell[crossed] >= static_cast<int>(cells[crossed])) {
            return {};
        }
    }
}

/// Extends the segment by 4 radii, which finds every triangle that the ball touches up to 75
/// degrees from the normal.
std::optional<Touch> touch(const MeshCollider& mesh, const Sweep& sweep) {
    const double length = glm::length(sweep.delta);
    if (mesh.bvh == nullptr || length == 0) {
        return {};
    }
    const double beyond = 1 + 4 * sweep.radius / length;
    const MeshHit hit = first_hit(*mesh.bvh, {Vec3(sweep.from), Vec3(sweep.at(beyond))});
    if (hit.triangle == kNoTriangle) {
        return {};
    }
    Dvec3 normal(hit.normal);
    double speed = glm::dot(normal, sweep.delta);
    if (speed > 0) {
        normal = -normal;
        speed = -speed;
    }
    const double before = double{hit.fraction} * beyond * -speed;  // distance from the plane
    if (before < sweep.radius) {
        return Touch{0, sweep.from + (sweep.radius - before) * normal, normal};
    }
    const double fraction =
        sweep.radius > 0 ? (before - sweep.radius) / -speed : double{hit.fraction};
    if (!(fraction <= 1)) {
        return {};
    }
    return Touch{fraction, sweep.at(fraction), normal};
}

// ---- pushing out
// ---------------------------------------------------------------------------------

struct Exit {
    Dvec3 point;
    Dvec3 normal;
    double depth;  ///< < 0 outside
};

std::optional<Exit> find_exit(const PlaneCollider& plane, const Dvec3& p, double radius) {
    const Dvec3 normal(unit_normal(plane));
    const double depth = double{plane.offset} + radius - glm::dot(normal, p);
    return Exit{p + depth * normal, normal, depth};
}

std::optional<Exit> find_exit(const SphereCollider& sphere, const Dvec3& p, double radius) {
    const Dvec3 center(sphere.center);
    const Dvec3 delta = p - center;
    const double distance = glm::length(delta);
    const Dvec3 outward = distance > 0 ? delta / distance : Dvec3(0, 1, 0);
    if (sphere.inverted) {
        const double inner = std::max(double{sphere.radius} - radius, 0.0);
        return Exit{center + inner * outward, -outward, distance - inner};
    }
    const double outer = double{sphere.radius} + radius;
    return Exit{center + outer * outward, outward, outer - distance};
}

std::optional<Exit> find_exit(const BoxCollider& box, const Dvec3& p, double radius) {
    const BoxFrame frame = box_frame(box);
    const Dvec3 local = (p - frame.center) * frame.axes;
    double depth = std::numeric_limits<double>::infinity();
    int nearest = 1;
    for (const int axis : {1, 0, 2}) {  // from the center, up
        const double inside = double{box.half[axis]} + radius - std::abs(local[axis]);
        if (inside < depth) {
            depth = inside;
            nearest = axis;
        }
    }
    const Dvec3 normal = std::copysign(1.0, local[nearest]) * frame.axes[nearest];
    return Exit{p + depth * normal, normal, depth};
}

std::optional<Exit> find_exit(const HeightCollider& field, const Dvec3& p, double radius) {
    const double x = (p.x - double{field.origin.x}) / double{field.cell.x};
    const double z = (p.z - double{field.origin.z}) / double{field.cell.y};
    if (!(x >= 0 && x <= field.width - 1 && z >= 0 && z <= field.depth - 1) || field.width < 2
        || field.depth < 2) {
        return {};
    }
    const int i = std::min(static_cast<int>(x), field.width - 2);
    const int j = std::min(static_cast<int>(z), field.depth - 2);
    const Patch patch = patch_at(field, i, j, radius);
    const double surface = patch.at(x - i, z - j);
    return Exit{{p.x, surface, p.z}, patch.normal(x - i, z - j), surface - p.y};
}

std::optional<Exit> find_exit(const MeshCollider&, const Dvec3&, double) {
    return {};
}

}  // namespace

std::optional<Contact>
first_contact(const Collider& collider, const Vec3& from, const Vec3& to, float radius) {
    const Sweep sweep = {Dvec3(from), Dvec3(to) - Dvec3(from), std::max(double{radius}, 0.0)};
    if (!is_finite(from) || !is_finite(to) || from == to) {
        return {};
    }
    const auto found =
        std::visit([&sweep](const auto& shape) { return touch(shape, sweep); }, collider);
    if (!found) {
        return {};
    }
    return Contact{static_cast<float>(found->fraction), Vec3(found->point), Vec3(found->normal)};
}

std::optional<Escape>
find_escape(const Collider& collider, const Vec3& position, float radius, float tolerance) {
    const auto found = std::visit(
        [&](const auto& shape) { return find_exit(shape, Dvec3(position), double{radius}); },
        collider);
    if (!found || !(found->depth > double{tolerance})) {
        return {};
    }
    return Escape{Vec3(found->point), Vec3(found->normal), static_cast<float>(found->depth)};
}

Vec3 push_out(const Collider& collider, const Vec3& position, float radius) {
    const Vec3 size = glm::abs(position);
    const float rounding = 5e-7f * std::max({1.0f, size.x, size.y, size.z});
    const auto found = find_escape(collider, position, radius, rounding);
    return found ? found->point : position;
}

}  // namespace limn
