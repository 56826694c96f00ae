#include "render/shadow/perspective_view.h"

#include "render/render_view.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

// Techniques: shadow.map-aliasing, shadow.perspective-map

namespace limn {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

constexpr double kParallel = 1e-7;      ///< w of a light below which it is directional
constexpr double kMinViewCosine = 0.5;  ///< between the light's axis and a receiver
constexpr double kSpare = 0.01;         ///< spare fraction of the depth range, at the far end
constexpr int kShifts = 8;              ///< of the virtual camera to try, each 4 times the previous

/// Axes of a view along `forward`, with the camera's depth axis vertical in the map.
struct ViewAxes {
    dvec3 right;
    dvec3 up;
    dvec3 forward;
};

ViewAxes view_axes(const dvec3& forward) {
    const dvec3 along = std::abs(forward.z) < 0.99 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(forward, along));
    return {right, glm::cross(right, forward), forward};
}

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void grow(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    [[nodiscard]] double center() const { return 0.5 * (low + high); }
    [[nodiscard]] double half() const { return std::max(0.5 * (high - low), 1e-9); }
};

/// A linear function of distorted space.
dvec4 plane(const dvec3& axis, double offset) {
    return {axis, offset};
}

/// Clip matrix from four linear functions: s and t are centered and scaled so that s / q and t / q
/// span -1 .. 1.
dmat4 clip_from_rows(
    const dvec4& s, const Range& range_s, const dvec4& t, const Range& range_t, const dvec4& depth,
    const dvec4& q, double widening) {
    dmat4 rows;
    rows[0] = (s - range_s.center() * q) / (range_s.half() * widening);
    rows[1] = (t - range_t.center() * q) / (range_t.half() * widening);
    rows[2] = depth;
    rows[3] = q;
    return glm::transpose(rows);
}

/// For a light at infinity in distorted space.
dmat4 fit_parallel(const dvec3& to_light, std::span<const dvec3> points, double widening) {
    const ViewAxes axes = view_axes(-to_light);
    Range s;
    Range t;
    Range near;
    for (const dvec3& p : points) {
        s.grow(glm::dot(axes.right, p));
        t.grow(glm::dot(axes.up, p));
        near.grow(glm::dot(to_light, p));
    }
    const double scale = 1 / ((2 + 2 * kSpare) * near.half());
    const double far = near.low - 2 * kSpare * near.half();
    const dvec4 depth = plane(to_light * scale, -far * scale);
    return clip_from_rows(
        plane(axes.right, 0), s, plane(axes.up, 0), t, depth, plane({0, 0, 0}, 1), widening);
}

/// For a light at a finite position; `inverted`: farther in distorted space is nearer to the light.
std::optional<dmat4>
fit_position(const dvec3& position, bool inverted, std::span<const dvec3> points, double widening) {
    dvec3 center(0);
    for (const dvec3& p : points) {
        center += p / static_cast<double>(points.size());
    }
    const double distance = glm::length(center - position);
    if (!(distance > 1e-9)) {
        return std::nullopt;
    }
    const ViewAxes axes = view_axes((center - position) / distance);
    Range s;
    Range t;
    Range inverse;  // of the distance along the axis
    for (const dvec3& p : points) {
        const dvec3 from = p - position;
        const double along = glm::dot(axes.forward, from);
        if (!(along > kMinViewCosine * glm::length(from))) {
            return std::nullopt;
        }
        s.grow(glm::dot(axes.right, from) / along);
        t.grow(glm::dot(axes.up, from) / along);
        inverse.grow(1 / along);
    }
    const auto row = [&](const dvec3& axis) { return plane(axis, -glm::dot(axis, position)); };
    const dvec4 q = row(axes.forward);
    const double scale = 1 / ((2 + 2 * kSpare) * inverse.half());
    const dvec4 one = plane({0, 0, 0}, 1);
    const dvec4 depth = inverted ? scale * ((inverse.high + 2 * kSpare * inverse.half()) * q - one)
                                 : scale * (one - (inverse.low - 2 * kSpare * inverse.half()) * q);
    return clip_from_rows(row(axes.right), s, row(axes.up), t, depth, q, widening) * (1 / distance);
}

}  // namespace

std::array<dvec3, 8> slice_corners(const RenderView& camera, const ViewSlice& slice) {
    std::array<dvec3, 8> corners;
    const auto& row = camera.world_from_camera.row;
    for (unsigned i = 0; i < 8; ++i) {
        const double along = (i & 4) != 0 ? slice.far : slice.near;
        const double x = (i & 1) != 0 ? slice.high.x : slice.low.x;
        const double y = (i & 2) != 0 ? slice.high.y : slice.low.y;
        const dvec4 in_view = {x * along, y * along, -along, 1};
        corners[i] = {
            glm::dot(dvec4(row[0]), in_view), glm::dot(dvec4(row[1]), in_view),
            glm::dot(dvec4(row[2]), in_view)};
    }
    return corners;
}

dmat4 virtual_camera(const RenderView& camera, double near, double far, double shift) {
    const auto& pose = camera.world_from_camera.row;
    const auto axis = [&](int i) { return dvec3(pose[0][i], pose[1][i], pose[2][i]); };
    const dvec3 right = axis(0);
    const dvec3 up = axis(1);
    const dvec3 back = axis(2);
    const dvec3 eye = dvec3(pose[0].w, pose[1].w, pose[2].w) + shift * back;
    const auto row = [&](const dvec3& a) { return dvec4(a, -glm::dot(a, eye)); };
    const double n = near + shift;
    const double f = far + shift;
    dmat4 rows;
    rows[0] = row(right) / double(camera.tangent.x);
    rows[1] = row(up) / double(camera.tangent.y);
    rows[2] = -(f + n) / (f - n) * row(back) - dvec4(0, 0, 0, 2 * f * n / (f - n));
    rows[3] = -row(back);
    return glm::transpose(rows);
}

std::optional<dmat4> fit_light_view(
    const dmat4& distorted_from_world, const dvec4& light, std::span<const dvec3> receivers,
    double widening) {
    std::vector<dvec3> points;
    for (const dvec3& p : receivers) {
        const dvec4 distorted = distorted_from_world * dvec4(p, 1);
        points.push_back(dvec3(distorted) / distorted.w);
    }
    const dvec4 l = distorted_from_world * light;
    const double size = glm::length(dvec3(l));
    std::optional<dmat4> view;
    if (std::abs(l.w) <= kParallel * size) {
        view = fit_parallel(dvec3(l) / size, points, widening);
    } else {
        view = fit_position(dvec3(l) / l.w, l.w < 0, points, widening);
    }
    return view ? std::optional(*view * distorted_from_world) : std::nullopt;
}

std::optional<ShadowView> make_perspective_view(
    const RenderView& camera, const Vec4& light, const ViewSlice& slice, int resolution,
    int guard) {
    if (!(slice.near > 0 && slice.near < slice.far)) {
        return std::nullopt;
    }
    const auto corners = slice_corners(camera, slice);
    const double widening =
        static_cast<double>(resolution) / static_cast<double>(resolution - 2 * guard);
    double shift = std::sqrt(slice.near * slice.far);
    for (int i = 0; i < kShifts; ++i, shift *= 4) {
        const dmat4 distorted = virtual_camera(camera, slice.near, slice.far, shift);
        const auto clip_from_world = fit_light_view(distorted, dvec4(light), corners, widening);
        if (clip_from_world) {
            // Normalized at the receivers, for float precision.
            const dvec4 row_q = glm::transpose(*clip_from_world)[3];
            ShadowView view;
            view.clip_from_world =
                Mat4(*clip_from_world * (1 / glm::dot(row_q, dvec4(corners[0], 1))));
            view.eye = Vec3(light);
            view.resolution = resolution;
            view.guard = guard;
            view.clamp_depth = true;
            return view;
        }
    }
    return std::nullopt;
}

}  // namespace limn
