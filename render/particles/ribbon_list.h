#pragma once

#include "ecs/base/math.h"
#include "ecs/components/beam.h"
#include "ecs/components/particles.h"
#include "ecs/components/trail.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Lines that are drawn as ribbons: trails and particles in a row. Each becomes a strip of points;
// shaders/lib/ribbon.glsl gives it its width in each view.

/// Layout of two texels in particle_gpu.h.
struct RibbonPoint {
    Vec3 position;
    float u = 0;            ///< texture coordinate along the ribbon
    Vec3 span = {0, 0, 0};  ///< from edge to edge; 0: faces the camera
    float curve_at = 0;     ///< position on the look's curves, 0 .. 1
};

/// Points of all ribbons. A sharp turn is there twice: the segment between is its join, while those
/// around it end squarely. So is each end, beyond which the ribbon seems to turn back: its cap.
struct RibbonList {
    std::vector<RibbonPoint> points = {};
    std::vector<std::uint32_t> segments = {};  ///< index of the point before each
    std::vector<RibbonPoint> strip = {};       ///< the one that is being made
    std::vector<Vec3> bolt = {};
    std::vector<Vec3> branch = {};
    float width = 0;  ///< of the next ribbons at most [m]

    void clear();
    /// Appends the strip without points that coincide, if two are left; clears it.
    void add_strip();
};

/// Appends the strands as they were `back` seconds before the end of a step of `step`. They end
/// exactly where length or life do.
void append_trail(
    const Trail& trail, const TrailState& state, float back, float step, RibbonList& list);

/// Appends a ribbon through the particles, from the youngest to the oldest; `head`: where births
/// are now, null if there are none.
void append_births(
    const Trail& trail, const ParticlePool& pool, float back, const Vec3* head, RibbonList& list);

/// Appends a beam as it is at `alpha` between the steps and at `time`, with its branches, whose
/// positions on the look's curves go on from where they leave it to 1 at their ends.
void append_beam(
    const Beam& beam, const BeamState& state, Entity entity, float alpha, double time,
    RibbonList& list);

}  // namespace limn
