#pragma once

#include "ecs/components/furrows.h"

namespace limn::test {

/// A rectangle of pixels with constant fields, in two triangles.
inline FurrowMap make_flat_furrow_map(IVec2 size, const Vec2& first, const Vec2& second = {1, 0}) {
    FurrowMap map;
    map.size = size;
    FurrowTriangle triangle = {};
    triangle.field[0] = first;
    triangle.field[1] = second;
    triangle.normal = {0, 0, 1};
    const Vec2 s(size);
    for (const bool lower : {false, true}) {
        triangle.corner[0] = {0, 0};
        triangle.corner[1] = lower ? s : Vec2(s.x, 0);
        triangle.corner[2] = lower ? Vec2(0, s.y) : s;
        map.triangles.push_back(triangle);
    }
    return map;
}

}  // namespace limn::test
