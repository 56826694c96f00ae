#pragma once

#include "ecs/base/math.h"
#include "ecs/components/beam.h"
#include "ecs/components/particles.h"
#include "ecs/components/trail.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Lines that are drawn as ribbons: trails, beams, and lines through particles. Each becomes a strip
// of points, which shaders/lib/ribbon.glsl widens for each view.

/// Layout of two texels in particle_gpu.h.
struct RibbonPoint {
    Vec3 position;
    float u = 0;            ///< texture coordinate along the ribbon
    Vec3 span = {0, 0, 0};  ///< from edge to edge; 0: faces the camera
    float curve_at = 0;     ///< position on the look's curves, 0 .. 1
};

/// Points of all ribbons. The point of a sharp turn is duplicated: the segment between the two
/// copies is a join, while the segments around it have square ends. Each end is duplicated, too,
/// as if the ribbon turned back there: that join is its cap.
struct RibbonList {
    std::vector<RibbonPoint> points = {};
    std::vector<std::uint32_t> segments = {};  ///< index of the point before each
    std::vector<RibbonPoint> strip = {};       ///< the strip being built
    std::vector<Vec3> bolt = {};
    std::vector<Vec3> branch = {};
    float width = 0;  ///< maximum width of the next ribbons [m]

    void clear();
    /// Appends the strip without coincident points, if at least two are left; clears it.
    void add_strip();
};

/// Appends the strands as they are `back` seconds before the end of a step of `step` seconds. They
/// end exactly at the trail's length or life.
void append_trail(
    const Trail& trail, const TrailState& state, float back, float step, RibbonList& list);

/// Appends a ribbon through the particles, from the youngest to the oldest; `head`: the current
/// position of births, null if there are none.
void append_births(
    const Trail& trail, const ParticlePool& pool, float back, const Vec3* head, RibbonList& list);

/// Appends a beam at `alpha` between the steps and at `time`, with its branches, whose positions on
/// the look's curves continue from that of the fork to 1 at their ends.
void append_beam(
    const Beam& beam, const BeamState& state, Entity entity, float alpha, double time,
    RibbonList& list);

}  // namespace limn
