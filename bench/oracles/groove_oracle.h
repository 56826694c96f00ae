#pragma once

namespace limn::oracle {

// Light in a long groove between two walls of the same slope, by radiosity in double precision:
// the walls are cut into strips, whose form factors are those of Hottel's crossed strings, and
// light bounces until no more is left. An independent check of fold_light.glsl.

/// Means over both walls.
struct GrooveWalls {
    double left = 0;
    double right = 0;
};

/// Cosines at the walls of light from (x, y) in the section of the groove, y > 0 out of it: 0 where
/// a strip stands in the shadow of the other wall. The left wall faces +x. `slope` of the walls
/// [rad], 0 to pi/2; (x, y) may be shorter than 1, of light that also runs along the groove.
[[nodiscard]] GrooveWalls groove_cosines(double slope, double x, double y);

/// Radiosity by that of white skin without a groove that faces the light, for walls of `albedo` 0
/// to 1 that are lit from there.
[[nodiscard]] GrooveWalls groove_radiosity(double slope, double albedo, double x, double y);

/// The same of light from all around, by that of white skin without a groove.
[[nodiscard]] double groove_radiosity_around(double slope, double albedo);

}  // namespace limn::oracle
