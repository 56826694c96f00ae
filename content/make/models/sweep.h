#pragma once

#include "ecs/components/path.h"
#include "ecs/components/surface.h"

#include <vector>

namespace limn {

/// A profile swept along a path: roads, rails, curbs, cables, neon tubes. Looking along the path,
/// profile points are (right, up); from left to right they make a surface that faces up. Texture
/// coordinates are meters: u along the profile, v backwards along the path.
struct SweepShape {
    PathId path;
    std::vector<Vec2> profile = {{-1.0f, 0.0f}, {1.0f, 0.0f}};
    float radius = 0.0f;
    int segments = 12;
    bool closed = false;
    float crease = 0.6f;
    float begin = 0.0f;
    float end = 0.0f;
    float step = 2.0f;
    float dash = 0.0f;
    float gap = 0.0f;
    bool upright = true;
    bool caps = true;
};

LIMN_FIELDS(SweepShape) {
    LIMN_FIELD(path, "a path of the level, by name; none: 10 m along +z");
    LIMN_FIELD(profile, "points (right, up) of the path", "m");
    LIMN_FIELD(radius, "of a tube, instead of the profile", "m", 0, 1e4);
    LIMN_FIELD(segments, "around a tube", "", 3, 512);
    LIMN_FIELD(closed, "the profile's last point is joined to its first");
    LIMN_FIELD(crease, "a sharp edge where the profile turns by more", "rad", 0, 3.2);
    LIMN_FIELD(begin, "along the path", "m", 0, 1e6);
    LIMN_FIELD(end, "along the path; <= begin: its end", "m", 0, 1e6);
    LIMN_FIELD(step, "distance between rows", "m", 0.001, 1e4);
    LIMN_FIELD(dash, "length of a dash; 0 = continuous", "m", 0);
    LIMN_FIELD(gap, "between dashes", "m", 0);
    LIMN_FIELD(upright, "level except for the path's roll; else rotation-minimizing");
    LIMN_FIELD(caps, "closed profiles get end caps");
}

[[nodiscard]] MeshData make_sweep(const SweepShape& shape, const Assets& assets);

}  // namespace limn
