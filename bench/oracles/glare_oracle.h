#pragma once

#include "bench/oracles/glow_oracle.h"

#include <vector>

namespace limn::oracle {

// The glare star about a point light, in double precision: the angles of the diffraction streaks of
// an aperture with straight blades, the fall-off of a streak, and an image with the stars of all
// its pixels.

/// Angles [rad], 0 .. 2 pi, of the strongest diffraction by a regular polygon of `blades` sides,
/// one side at the angle `rotation`: the maxima of its squared Fourier transform, averaged over an
/// octave of spatial frequencies, as for white light of an extended source.
[[nodiscard]] std::vector<double> diffraction_angles(int blades, double rotation);

struct Star {
    double strength = 0;   ///< energy of the star, relative to its source
    double threshold = 0;  ///< luminance below which there is no star
    int lines = 0;         ///< through each pixel, at equal angles
    double rotation = 0;   ///< angle of the first line, counter-clockwise from the right [rad]
    double length = 0;     ///< of a line, to either side [px]
};

/// Light of a line per pixel of its length, at `distance` [px] from its center: a sum of tents,
/// each half as long as the previous one with twice its light, down to 2 .. 4 px. Between the
/// shortest and the longest tent it falls with the square of the distance. Both sides sum to 1.
[[nodiscard]] double line_density(double distance, double length);

/// `image` with a star about each pixel; red streaks are longer than blue ones, in the ratio of the
/// wavelengths 610, 550 and 465 nm. A line's cross-section is a Gaussian of standard deviation
/// `width` [px].
[[nodiscard]] LightImage add_stars(const LightImage& image, const Star& star, double width);

}  // namespace limn::oracle
