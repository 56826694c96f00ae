#pragma once

#include "ecs/base/math.h"

namespace limn {

// How OpenGL addresses a cube map: faces 0 .. 5 are +x -x +y -y +z -z, each viewed from inside with
// s to the right and t down from the face's first row. The coordinates (sc, tc) on the face
// selected by a direction's component of largest magnitude, ma:
//
//     +x (-z, -y)   -x (z, -y)   +y (x, z)   -y (x, -z)   +z (x, -y)   -z (-x, -y)
//
// and s = (sc / |ma| + 1) / 2, t likewise. Captures are rendered with these faces; tests sample
// with them where the hardware itself is under test.

inline constexpr int kCubeFaces = 6;

/// A point on a cube map.
struct CubePoint {
    int face = 4;            ///< 0 .. 5
    Vec2 st = {0.5f, 0.5f};  ///< 0 .. 1
};

/// Where `direction`, of any length, hits the cube. Ties between components go to x, then y, then
/// z; the zero vector maps to the center of face 4.
[[nodiscard]] CubePoint cube_point(const Vec3& direction);

/// Direction toward a point: on the cube of half side 1, not normalized.
[[nodiscard]] Vec3 cube_direction(const CubePoint& point);

/// Solid angle [sr] of texel (x, y) of a face of `size` x `size`; the texels of a face sum to 4 pi
/// / 6.
[[nodiscard]] double cube_texel_solid_angle(int size, int x, int y);

/// Pose of the camera that renders `face` with a 90 degree field of view; it looks along -z.
[[nodiscard]] Affine cube_face_pose(int face, const Vec3& center);

}  // namespace limn
