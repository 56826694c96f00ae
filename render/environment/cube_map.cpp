#include "render/environment/cube_map.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

// Techniques: env.cube-addressing

namespace limn {
namespace {

/// Direction = forward + (2 s - 1) right + (2 t - 1) down.
struct FaceAxes {
    Vec3 forward;
    Vec3 right;
    Vec3 down;
};
constexpr FaceAxes kFaces[kCubeFaces] = {
    {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};

/// Solid angle of the rectangle from the center of a face to (x, y), both -1 .. 1.
double corner_solid_angle(double x, double y) {
    return std::atan2(x * y, std::sqrt(x * x + y * y + 1));
}

}  // namespace

CubePoint cube_point(const Vec3& direction) {
    const Vec3 size = glm::abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const float major = size[axis];
    if (!(major > 0)) {
        return {};
    }
    const int face = 2 * axis + (direction[axis] < 0 ? 1 : 0);
    const FaceAxes& axes = kFaces[face];
    return {
        face,
        {0.5f * (glm::dot(direction, axes.right) / major + 1),
         0.5f * (glm::dot(direction, axes.down) / major + 1)}};
}

Vec3 cube_direction(const CubePoint& point) {
    LIMN_CHECK(point.face >= 0 && point.face < kCubeFaces);
    const FaceAxes& axes = kFaces[point.face];
    return axes.forward + (2 * point.st.x - 1) * axes.right + (2 * point.st.y - 1) * axes.down;
}

double cube_texel_solid_angle(int size, int x, int y) {
    const double step = 2.0 / size;
    const double left = x * step - 1;
    const double top = y * step - 1;
    return corner_solid_angle(left, top) - corner_solid_angle(left, top + step)
           - corner_solid_angle(left + step, top) + corner_solid_angle(left + step, top + step);
}

Affine cube_face_pose(int face, const Vec3& center) {
    LIMN_CHECK(face >= 0 && face < kCubeFaces);
    // Framebuffer rows run upward in OpenGL, and t with them: a face's down is up here.
    const FaceAxes& axes = kFaces[face];
    Affine pose;
    for (int i = 0; i < 3; ++i) {
        pose.row[i] = {axes.right[i], axes.down[i], -axes.forward[i], center[i]};
    }
    return pose;
}

}  // namespace limn
