#include "render/shadow/shadow_view.h"

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

// Techniques: shadow.map-aliasing, shadow.map-omni, shadow.projective-matrix

namespace limn {
namespace {

/// Orthonormal axes of a view.
struct Axes {
    Vec3 right;
    Vec3 up;
    Vec3 forward;
};

Axes axes_along(const Vec3& forward, const Vec3& preferred_right = {0, 0, 0}) {
    const Vec3 across = preferred_right - forward * glm::dot(forward, preferred_right);
    const float size = glm::length(across);
    const Vec3 right = size > 1e-3f ? across / size : any_perpendicular(forward);
    return {right, glm::cross(right, forward), forward};
}

/// Scale factor of a view for its border.
float widening(int resolution, int guard) {
    return static_cast<float>(resolution) / static_cast<float>(resolution - 2 * guard);
}

/// `tangent`: tan(fov / 2).
ShadowView perspective_view(
    const Vec3& eye, const Axes& axes, float tangent, float near, int resolution, int guard) {
    Mat4 rows(0.0f);  // transposed: columns are rows of the result
    const auto row = [&](const Vec3& axis, float scale) {
        return Vec4(axis, -glm::dot(axis, eye)) * scale;
    };
    rows[0] = row(axes.right, 1 / tangent);
    rows[1] = row(axes.up, 1 / tangent);
    rows[2] = {0, 0, 0, near};
    rows[3] = row(axes.forward, 1);
    ShadowView view;
    view.clip_from_world = glm::transpose(rows);
    view.eye = eye;
    view.resolution = resolution;
    view.guard = guard;
    // (r - b) / b = r (1/b - 1/r) = r (depth_b - depth_r) / near; a texel is 2 tangent r / side.
    view.penumbra = static_cast<float>(resolution) / (2 * tangent * near);
    return view;
}

}  // namespace

ShadowView make_spot_view(
    const Vec3& eye, const Vec3& axis, float half_angle, float near, int resolution, int guard,
    const Vec3& right) {
    const float tangent = std::tan(std::min(half_angle, kMaxSpotViewAngle));
    return perspective_view(
        eye, axes_along(axis, right), std::max(tangent, 1e-3f) * widening(resolution, guard), near,
        resolution, guard);
}

ShadowView make_cube_view(const Vec3& eye, int face, float near, int resolution, int guard) {
    Axes axes;
    axes.forward = Vec3(0);
    axes.forward[face / 2] = (face & 1) != 0 ? -1.0f : 1.0f;
    axes.right = Vec3(0);
    axes.right[(face / 2 + 1) % 3] = 1.0f;
    axes.up = glm::cross(axes.right, axes.forward);
    return perspective_view(eye, axes, widening(resolution, guard), near, resolution, guard);
}

std::array<float, kMaxCascades> split_cascades(float near, float far, int count) {
    std::array<float, kMaxCascades> ends;
    ends.fill(INFINITY);
    for (int i = 0; i < count; ++i) {
        const float fraction = static_cast<float>(i + 1) / static_cast<float>(count);
        const float ratios = near * std::pow(far / near, fraction);
        const float steps = near + (far - near) * fraction;
        ends[static_cast<std::size_t>(i)] = 0.75f * ratios + 0.25f * steps;
    }
    return ends;
}

ShadowView make_cascade_view(
    const RenderView& camera, const Vec3& to_sun, float slice_near, float slice_far, int resolution,
    int guard) {
    // The smallest sphere around the slice of the frustum: its center lies on the axis.
    const Vec2 tangent = widest_tangent(camera);
    const double t2 = glm::dot(tangent, tangent);
    const double along =
        std::min<double>(slice_far, 0.5 * (1 + t2) * (double(slice_near) + double(slice_far)));
    const double radius =
        std::sqrt((slice_far - along) * (slice_far - along) + t2 * slice_far * slice_far);
    const double half = radius * widening(resolution, guard);
    const double texel = 2 * half / resolution;

    const auto& pose = camera.world_from_camera.row;
    const Axes axes = axes_along(-to_sun);
    glm::dvec3 center;
    for (int i = 0; i < 3; ++i) {
        center[i] = pose[i].w - along * pose[i].z;
    }
    // Snapped to whole texels along all three axes, so that depths repeat, too.
    const auto snapped = [&](const Vec3& axis) {
        return std::floor(glm::dot(glm::dvec3(axis), center) / texel) * texel;
    };
    const double right = snapped(axes.right);
    const double up = snapped(axes.up);
    const double forward = snapped(axes.forward);

    // From well in front of the sphere, to include casters toward the sun, to its far side: enough
    // for the search of blockers to be as wide as the filter allows, however large the scene is.
    constexpr double kMinBefore = 200;  // [m]
    constexpr double kBefore = 4;       // of the sphere's radius
    const double far = forward + half;
    const double range = 2 * half + std::max(kMinBefore, kBefore * half);
    Mat4 rows(0.0f);
    rows[0] = Vec4(axes.right, -right) * static_cast<float>(1 / half);
    rows[1] = Vec4(axes.up, -up) * static_cast<float>(1 / half);
    rows[2] = Vec4(-axes.forward, far) * static_cast<float>(1 / range);
    rows[3] = {0, 0, 0, 1};
    ShadowView view;
    view.clip_from_world = glm::transpose(rows);
    view.eye = Vec3(
        right * glm::dvec3(axes.right) + up * glm::dvec3(axes.up)
        + forward * glm::dvec3(axes.forward));
    view.resolution = resolution;
    view.guard = guard;
    view.clamp_depth = true;
    view.penumbra = static_cast<float>(range / texel);
    // Filters sample within the guard, at positions offset along normals.
    view.shading = shading_planes(camera, to_sun, slice_near, slice_far, (guard + 8) * texel);
    return view;
}

Frustum shading_planes(
    const RenderView& camera, const Vec3& to_sun, double slice_near, double slice_far,
    double margin) {
    const auto& pose = camera.world_from_camera.row;
    const auto column = [&](int i) { return glm::dvec3(pose[0][i], pose[1][i], pose[2][i]); };
    const glm::dvec2 tangent = widest_tangent(camera);
    const glm::dvec3 right = column(0);
    const glm::dvec3 up = column(1);
    const glm::dvec3 forward = -column(2);
    const glm::dvec3 eye = column(3);
    const glm::dvec3 sun = to_sun;

    enum Side { kLeft, kRight, kBottom, kTop, kNear, kFar };
    const glm::dvec3 inward[] = {
        right + tangent.x * forward,
        -right + tangent.x * forward,
        up + tangent.y * forward,
        -up + tangent.y * forward,
        forward,
        -forward};
    const glm::dvec3 to_left = forward - tangent.x * right;
    const glm::dvec3 to_right = forward + tangent.x * right;
    const glm::dvec3 to_bottom = forward - tangent.y * up;
    const glm::dvec3 to_top = forward + tangent.y * up;
    struct Edge {
        Side a, b;
        glm::dvec3 point;
        glm::dvec3 along;
    };
    // A silhouette has at most six edges; those of the near plane come last, as they bound least.
    const Edge edges[] = {
        {kLeft, kBottom, eye, to_left + to_bottom - forward},
        {kLeft, kTop, eye, to_left + to_top - forward},
        {kRight, kBottom, eye, to_right + to_bottom - forward},
        {kRight, kTop, eye, to_right + to_top - forward},
        {kLeft, kFar, eye + slice_far * to_left, up},
        {kRight, kFar, eye + slice_far * to_right, up},
        {kBottom, kFar, eye + slice_far * to_bottom, right},
        {kTop, kFar, eye + slice_far * to_top, right},
        {kLeft, kNear, eye + slice_near * to_left, up},
        {kRight, kNear, eye + slice_near * to_right, up},
        {kBottom, kNear, eye + slice_near * to_bottom, right},
        {kTop, kNear, eye + slice_near * to_top, right}};
    const glm::dvec3 center = eye + 0.5 * (slice_near + slice_far) * forward;

    Frustum planes = kEverywhere;
    int count = 0;
    for (const Edge& edge : edges) {
        const bool outline =
            (glm::dot(inward[edge.a], sun) < 0) != (glm::dot(inward[edge.b], sun) < 0);
        glm::dvec3 normal = glm::cross(edge.along, sun);
        const double length = glm::length(normal);
        if (!outline || count == kFrustumPlanes || length < 1e-6 * glm::length(edge.along)) {
            continue;
        }
        normal /= glm::dot(normal, center - edge.point) < 0 ? -length : length;
        planes.planes[count] = Vec4(Vec3(normal), margin - glm::dot(normal, edge.point));
        ++count;
    }
    return planes;
}

double texels_per_pixel(
    const ShadowView& view, const RenderView& camera, const Vec3& point, const Vec3& normal) {
    const auto& pose = camera.world_from_camera.row;
    const auto axis = [&](int i) { return glm::dvec3(pose[0][i], pose[1][i], pose[2][i]); };
    const glm::dvec3 ray = glm::dvec3(point) - glm::dvec3(pose[0].w, pose[1].w, pose[2].w);
    const glm::dvec3 n = normal;
    const double distance = -glm::dot(ray, axis(2));
    const glm::dmat4 rows = glm::transpose(glm::dmat4(view.clip_from_world));
    const glm::dvec4 position(glm::dvec3(point), 1);
    const double q = glm::dot(rows[3], position);

    // Motion in the map when the ray through the pixel's center moves on to the next pixel.
    const auto texels = [&](const glm::dvec3& step) {
        const glm::dvec3 along = step - ray * (glm::dot(n, step) / glm::dot(n, ray));
        glm::dvec2 moved(0);
        for (int i = 0; i < 2; ++i) {
            const double here = glm::dot(rows[i], position) / q;
            moved[i] = glm::dot(glm::dvec3(rows[i]) - here * glm::dvec3(rows[3]), along) / q;
        }
        return moved * (0.5 * view.resolution);
    };
    const glm::dvec2 right =
        texels(axis(0) * (2.0 * double(camera.tangent.x) * distance / camera.width));
    const glm::dvec2 up =
        texels(axis(1) * (2.0 * double(camera.tangent.y) * distance / camera.height));
    return std::abs(right.x * up.y - right.y * up.x);
}

layout::ShadowViewRecord make_shadow_record(
    const ShadowView& view, const AtlasRect& rect, float filter, float source_size, float bias) {
    // From clip space to texels of the atlas: the bias matrix; depths are 0 .. 1 already.
    const double half = 0.5 * rect.size;
    glm::dmat4 texels_from_clip(1.0);
    texels_from_clip[0][0] = half;
    texels_from_clip[1][1] = half;
    texels_from_clip[3][0] = rect.x + half;
    texels_from_clip[3][1] = rect.y + half;
    const glm::dmat4 shadow_from_world = texels_from_clip * glm::dmat4(view.clip_from_world);
    const glm::dmat4 world_from_shadow = glm::inverse(shadow_from_world);
    const glm::dmat4 rows = glm::transpose(shadow_from_world);

    const auto scale = static_cast<float>(rect.size) / static_cast<float>(view.resolution);
    layout::ShadowViewRecord record{};
    record.row_s = Vec4(rows[0]);
    record.row_t = Vec4(rows[1]);
    record.row_r = Vec4(rows[2]);
    record.row_q = Vec4(rows[3]);
    record.plane_s = Vec4(world_from_shadow[0]);
    record.plane_t = Vec4(world_from_shadow[1]);
    record.plane_r = Vec4(world_from_shadow[2]);
    record.rect = {rect.x, rect.y, rect.x + rect.size, rect.y + rect.size};
    record.settings = {
        filter, bias, view.penumbra * scale * source_size,
        static_cast<float>(std::max(view.guard - 2, 0))};
    record.splits = Vec4(INFINITY);
    return record;
}

}  // namespace limn
