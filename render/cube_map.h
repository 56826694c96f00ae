#pragma once

#include "ecs/base/math.h"

namespace limn {

// How OpenGL addresses a cube map: faces 0 .. 5 are +x -x +y -y +z -z, each seen from the inside
// with s to the right and t down from the face's first row. What a direction (sc, tc, ma) names on
// its face, by the largest component ma:
//
//     +x (-z, -y)   -x (z, -y)   +y (x, z)   -y (x, -z)   +z (x, -y)   -z (-x, -y)
//
// and s = (sc / |ma| + 1) / 2, t likewise. Captures are drawn with these faces; tests sample with
// them where the hardware is the one to be judged.

inline constexpr int kCubeFaces = 6;

/// A point of a cube map.
struct CubePoint {
    int face = 4;            ///< 0 .. 5
    Vec2 st = {0.5f, 0.5f};  ///< 0 .. 1
};

/// Where `direction`, of any length, meets the cube. Where components are equal, x goes before y
/// before z; zero is the middle of face 4.
[[nodiscard]] CubePoint cube_point(const Vec3& direction);

/// Toward a point: on the cube of half side 1, not unit.
[[nodiscard]] Vec3 cube_direction(const CubePoint& point);

/// Solid angle [sr] of texel (x, y) of a face of `size` x `size`; all of a face sum up to 4 pi / 6.
[[nodiscard]] double cube_texel_solid_angle(int size, int x, int y);

/// The camera that draws `face` when it sees 90 degrees both ways: it looks along -z of this pose.
[[nodiscard]] Affine cube_face_pose(int face, const Vec3& center);

}  // namespace limn
