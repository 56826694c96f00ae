#pragma once

#include "bench/oracles/glow_oracle.h"

#include <vector>

namespace limn::oracle {

// The star about a point of light, in double precision: where diffraction at an aperture of
// straight blades has its streaks, how a streak is to fade, and a picture with the stars of all
// its pixels.

/// Angles [rad], 0 .. 2 pi, at which a regular polygon of `blades` sides sends most light, one of
/// them about perpendicular to a side at `rotation`: the largest values of its squared Fourier
/// transform, meaned over an octave of spatial frequencies, as white light of a spread source.
[[nodiscard]] std::vector<double> diffraction_angles(int blades, double rotation);

struct Star {
    double strength = 0;   ///< light of the star, of its source's
    double threshold = 0;  ///< luminance that makes none
    int lines = 0;         ///< through each pixel, at equal angles
    double rotation = 0;   ///< of the first line, from the right to the top [rad]
    double length = 0;     ///< of a line to either side [px]
};

/// Light of a line per pixel of its way, `distance` [px] from its middle: a sum of tents of which
/// each is half as long as the one before and holds twice its light, down to 2 .. 4 px. Between its
/// shortest and longest tent it falls with the square of the distance. Both sides sum to 1.
[[nodiscard]] double line_density(double distance, double length);

/// `picture` with a star about each pixel in which red goes farther than blue, as wavelengths of
/// 610, 550 and 465 nm. A line is as wide as a Gaussian of deviation `width` [px].
[[nodiscard]] LightPicture add_stars(const LightPicture& picture, const Star& star, double width);

}  // namespace limn::oracle
