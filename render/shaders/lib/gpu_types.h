#pragma once

#include "ecs/base/math.h"

namespace limn::layout {

// GLSL's type names, for the layouts shared through *_gpu.h.
using vec2 = Vec2;
using vec3 = Vec3;
using vec4 = Vec4;
using mat4 = Mat4;
using uint = std::uint32_t;
struct uvec2 {
    uint x = 0, y = 0;
    bool operator==(const uvec2&) const = default;
};
struct ivec4 {
    int x = 0, y = 0, z = 0, w = 0;
};
struct uvec4 {
    uint x = 0, y = 0, z = 0, w = 0;
};

}  // namespace limn::layout
