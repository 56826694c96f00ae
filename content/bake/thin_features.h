#pragma once

#include "content/bake/relief_map.h"

namespace limn {

// How many steps a linear search through a relief needs (relief.thin-features). A search in steps
// of 1 / n of the depth jumps over what is thinner than a step along the ray, which shows as ragged
// outlines and shadows at grazing angles. The analysis follows rays from texels all over the map in
// several directions, and finds the shortest stretch of each inside the relief. Rays cut across
// edges and peaks as close to them as one likes, so that the very shortest says little: of the
// rays, a fraction may miss.

struct ThinFeatures {
    float shortest = 1;  ///< stretch inside, in units of the depth; 1: no ray leaves the relief
    float typical = 1;   ///< that which all but the fraction of rays exceed or equal
    int steps = 8;       ///< recommended: 1 / typical, rounded up, 8 .. 256
};

struct ThinFeatureRays {
    int azimuths = 16;
    int elevations = 4;          ///< evenly between those two
    float lowest = 0.1745329f;   ///< above the polygon [rad]
    float highest = 1.0471976f;  ///< [rad]
    float missed = 0.01f;        ///< fraction of the rays
    int max_texels = 64;         ///< along either side: of larger maps, every n-th starts a ray
};

/// `depth`: of the relief, in widths of the map. Samples rays at 1/256 of the depth.
[[nodiscard]] ThinFeatures find_thin_features(
    const BakedMap& relief, bool repeats, float depth, const ThinFeatureRays& rays = {});

inline constexpr int kStretchSamples = 256;

/// The same for one ray: `inside(t)` for t in 0 .. 1. A stretch from 0 on does not count.
template <typename Inside>
[[nodiscard]] float shortest_stretch(Inside&& inside) {
    float shortest = 1;
    int begin = -1;
    for (int i = 0; i <= kStretchSamples; ++i) {
        const bool is_inside = inside(static_cast<float>(i) / static_cast<float>(kStretchSamples));
        if (is_inside && begin < 0) {
            begin = i;
        } else if (!is_inside && begin == 0) {
            begin = -1;  // found by any search, which starts there
        } else if (!is_inside && begin > 0) {
            const float stretch =
                static_cast<float>(i - begin) / static_cast<float>(kStretchSamples);
            shortest = stretch < shortest ? stretch : shortest;
            begin = -1;
        }
    }
    return shortest;
}

/// Steps for a shortest stretch.
[[nodiscard]] int steps_for(float shortest);

}  // namespace limn
